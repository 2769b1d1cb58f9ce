"""Variants of exercises with changed numbers, and exercises about generated robots.

A short text, the seed, determines a variant.
"""
