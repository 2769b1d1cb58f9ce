"""Slips in the robot's table or in its joints that lead to a wrong later answer."""
