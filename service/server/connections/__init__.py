"""HTTP connections under limits."""
