"""Decide what is right or wrong, by numbers; messages are made elsewhere."""
