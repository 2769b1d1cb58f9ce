"""Grade files that students hand in on the learning platform."""
