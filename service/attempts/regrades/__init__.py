"""Regrading of outdated attempts."""
