"""Imports of robots in the editor."""
