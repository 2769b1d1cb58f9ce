"""Read submitted DH tables as rows of entries."""
