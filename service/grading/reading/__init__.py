"""JSON or pasted text -> entries."""
