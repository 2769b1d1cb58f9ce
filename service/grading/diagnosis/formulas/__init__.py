"""The search for the formula that a student intended."""
