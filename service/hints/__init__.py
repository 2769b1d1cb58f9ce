"""Hints on demand: what to look at, the rule with its picture, and the rule on this row."""
