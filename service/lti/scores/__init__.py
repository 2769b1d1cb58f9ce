"""Scores: send the points of learners to the gradebooks of platforms (AGS)."""
