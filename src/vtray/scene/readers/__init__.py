"""Files of data: a module for each library that reads them, and the table of all."""
