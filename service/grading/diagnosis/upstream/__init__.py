"""Slips in the robot's table or joints that lead to a wrong later answer."""
