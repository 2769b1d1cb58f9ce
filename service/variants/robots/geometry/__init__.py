"""The geometry of generated robots, and the reasons to refuse a robot."""
