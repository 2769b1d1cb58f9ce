"""A student's table as frames and formulas."""
