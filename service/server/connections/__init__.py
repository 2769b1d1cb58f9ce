"""HTTP connections with limits."""
