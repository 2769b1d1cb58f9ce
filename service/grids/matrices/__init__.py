"""The formats of pasted matrices, one file each."""
