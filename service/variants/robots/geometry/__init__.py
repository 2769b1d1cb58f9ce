"""The geometry of generated robots: directions, links at home, and what is refused."""
