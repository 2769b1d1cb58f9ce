"""The slips in a DH table."""
