"""Check that reports name the slips in tables of random arms."""
