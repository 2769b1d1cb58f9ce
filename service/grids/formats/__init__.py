"""The formats of pasted tables, one file each."""
