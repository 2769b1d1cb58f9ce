"""The geometry of generated robots: directions, links at home, and reasons to refuse a robot."""
