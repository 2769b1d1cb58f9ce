"""Convert typed text to plain characters, each with its position in the typed text."""
