"""Reports for grading platforms, one format in each file."""
