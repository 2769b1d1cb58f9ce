"""The routes that need no database."""
