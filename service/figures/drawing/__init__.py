"""Draw the parts of a figure, and place its labels."""
