"""Bounds on the cost of one expression, checked before the work that they bound."""

from dataclasses import dataclass


@dataclass(frozen=True, slots=True)
class Limits:
    """Bounds on one expression.

    ``characters`` as typed, ``nodes`` of its tree, and ``depth`` of its nesting, for which a run of
    sums or products is one level. ``tree_depth`` is that of the tree itself, where each term of a
    sum is a level: whatever works on a tree by recursion takes up to three calls a level, far from
    Python's 1,000. A longer text than ``repaired`` is not repaired, and not searched for slips;
    ``notes`` are told of one text.

    The longest entry of a seven-joint arm's pose, expanded and not simplified, has 2,500 characters
    in LaTeX and 270 nodes.
    """

    characters: int = 8_000
    nodes: int = 2_000
    depth: int = 40
    tree_depth: int = 200
    repaired: int = 1_000
    notes: int = 12


LIMITS = Limits()
