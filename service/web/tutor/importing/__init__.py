"""Import robots into the exercise editor."""
