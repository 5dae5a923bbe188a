"""Pictures that skies and surfaces show: arrays, and the files that hold them."""
