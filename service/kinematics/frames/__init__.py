"""Find which tables, in frames that the student chooses, describe the same robot."""
