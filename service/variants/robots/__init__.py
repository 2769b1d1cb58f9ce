"""Exercises about generated robots. A level and a seed determine the robot."""
