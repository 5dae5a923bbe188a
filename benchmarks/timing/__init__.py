"""How processes are run, timed and compared."""
