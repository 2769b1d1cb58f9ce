"""Slips in tables of random arms, with kinematics that are independent of the program."""
