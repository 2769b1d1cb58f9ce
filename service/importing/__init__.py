"""Robots from other programs: a URDF file -> joint axes -> a DH table -> an exercise file."""
