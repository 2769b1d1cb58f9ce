"""Read submitted lists of values and of frames as entries."""
