"""Variants of exercises with other numbers, and exercises about generated robots.

A short text, the seed, determines a variant.
"""
