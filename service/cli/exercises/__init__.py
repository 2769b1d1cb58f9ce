"""The parts of `dh-grader exercises`: check, import and export."""
