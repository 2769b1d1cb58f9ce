"""The server around the application: what a client may send, how fast, and who comes next."""
