"""Authentication, and the rights of callers."""
