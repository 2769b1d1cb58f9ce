"""Ask two checkouts the same, and compare what they answer, byte for byte."""
