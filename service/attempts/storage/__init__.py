"""The database of attempts and the thread that writes to it."""
