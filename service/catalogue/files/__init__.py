"""Exercise files: their fields and schema, and the line of each fault."""
