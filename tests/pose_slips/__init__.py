"""Check that reports on wrong poses name the slip in the student's table."""
