"""The reference robot of an exercise and its formulas."""
