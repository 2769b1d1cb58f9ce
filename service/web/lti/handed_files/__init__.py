"""Files that students hand in at the platform: the notices about them, and the reports on them."""
