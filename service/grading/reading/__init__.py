"""Read answers, as JSON or pasted text, as entries (single cells)."""
