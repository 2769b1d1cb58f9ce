"""Exercises in which a student must find the one mistake in a table.

A seed determines the mistake. This package does not import the grader: its callers pass a function
that grades a table.
"""
