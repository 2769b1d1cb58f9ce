"""Slips in a product of transforms or motions."""
