"""Find which tables describe a given robot if students choose the frames."""
