"""DH Grader: evaluates what a robotics student submits against a reference robot."""
