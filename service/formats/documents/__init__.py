"""Reports for people and programs, one format in each file."""
