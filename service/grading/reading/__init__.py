"""Read answers: JSON or pasted text -> entries."""
