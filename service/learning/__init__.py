"""Exercises about mistakes: a table with one slip, drawn from the misconceptions by seed.

This package does not know the grader. It gets the grader's judgement of a table as a function.
"""
