"""The commands of `dh-grader`."""
