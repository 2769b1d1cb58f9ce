"""Slips behind the poses of random arms, worked out without any of the program's own kinematics."""
