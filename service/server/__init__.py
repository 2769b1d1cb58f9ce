"""The server around the application: limits for clients, and fair turns between them."""
