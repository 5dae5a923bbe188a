"""What everything stands on: errors, files, memory, threads."""
