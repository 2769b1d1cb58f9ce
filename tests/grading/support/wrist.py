"""The spherical wrist with its joints 4 to 6: link transforms and screw axes."""

# Spong, Hutchinson, Vidyasagar, Robot Modeling and Control, spherical wrist of Figure 3.8.
A4 = "[c4, 0, -s4, 0; s4, 0, c4, 0; 0, -1, 0, 0; 0, 0, 0, 1]"
A5 = "[c5, 0, s5, 0; s5, 0, -c5, 0; 0, 1, 0, 0; 0, 0, 0, 1]"
A6 = "[c6, -s6, 0, 0; s6, c6, 0, 0; 0, 0, 1, d6; 0, 0, 0, 1]"

WRIST = """
title = "Wrist"
source = "a test"
statement = "A wrist."
feedback = "full"
[robot]
structure = "RRR"
convention = "standard"
joints = ["theta4", "theta5", "theta6"]
table = [["0", "-90deg", "0", "theta4"], ["0", "90deg", "0", "theta5"], ["0", "0", "d6", "theta6"]]
[symbols]
d6 = { kind = "length", range = [0.1, 0.4], description = "length" }
[[parts]]
id = "links"
kind = "link_transforms"
title = "Links"
prompt = "Give them."
points = 6
convention = "standard"
[[parts]]
id = "screws"
kind = "screw_axes"
title = "Screws"
prompt = "Give them."
points = 6
frame = "space"
"""
