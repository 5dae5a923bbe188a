"""Many pictures: movies, turntables, numbered pictures."""
