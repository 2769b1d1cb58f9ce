"""Cut a text into cells. Every character keeps its place in the pasted text."""
