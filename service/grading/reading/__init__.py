"""Read answers in JSON or pasted text; each cell becomes an entry."""
