"""Let a server grade instead of this program."""
