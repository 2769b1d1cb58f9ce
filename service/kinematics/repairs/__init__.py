"""Other values of a few cells that make a table right."""
