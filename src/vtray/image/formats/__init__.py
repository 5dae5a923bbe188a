"""Image files: a table of formats, and a module for each library that writes them."""
