"""The server around the application: limits for connections, and fair scheduling."""
