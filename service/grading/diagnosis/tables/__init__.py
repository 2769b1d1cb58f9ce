"""Slips in a DH table."""
