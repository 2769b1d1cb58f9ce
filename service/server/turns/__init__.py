"""Fair turns between clients."""
