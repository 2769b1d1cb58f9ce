"""Evaluate a syntax tree."""
