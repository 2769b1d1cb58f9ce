"""The formulas that the writer of a wrong one may have intended."""
