"""Import robots into the editor for exercise files."""
