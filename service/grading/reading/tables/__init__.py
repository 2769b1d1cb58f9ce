"""DH tables as handed in -> rows of entries."""
