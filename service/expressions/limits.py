"""Bounds on the cost of one expression, checked before the work that they bound."""

from dataclasses import dataclass


@dataclass(frozen=True, slots=True)
class Limits:
    """Bounds on one expression: characters typed, nodes of its tree, and nesting of either."""

    characters: int = 500
    nodes: int = 200
    depth: int = 40


LIMITS = Limits()
