"""Scores: what platforms get to know of the points of learners (AGS)."""
