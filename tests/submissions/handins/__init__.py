"""Hand-ins in all kinds of files, as four platforms name them, graded by the command line."""
