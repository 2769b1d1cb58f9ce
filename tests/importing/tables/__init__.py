"""Import DH tables that are typed in many ways, and compare the robots."""
