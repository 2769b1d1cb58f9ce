"""Mutation testing: change the code in small ways, and see that a test notices each change."""
