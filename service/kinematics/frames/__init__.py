"""Find which tables describe the same robot if students choose the frames."""
