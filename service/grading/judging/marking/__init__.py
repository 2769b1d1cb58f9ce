"""The points of an answer, from the verdicts on its cells; all points add up."""
