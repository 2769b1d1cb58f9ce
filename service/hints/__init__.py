"""Hints on demand: what to look at, a rule with its picture, and the rule applied to a row."""
