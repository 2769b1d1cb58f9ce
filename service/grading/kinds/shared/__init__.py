"""Code that several answer kinds share."""
