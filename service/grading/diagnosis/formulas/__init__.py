"""The formulas that a student may have intended instead of a wrong one."""
