"""Exercise files: fields, schema, and the place of each fault."""
