"""The points of an answer, computed from the verdicts on its cells."""
