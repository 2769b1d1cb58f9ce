"""Cut a pasted text into cells."""
