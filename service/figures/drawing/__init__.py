"""The parts of a drawing and their places."""
