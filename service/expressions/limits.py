"""The limits on the size of one expression."""

from dataclasses import dataclass


@dataclass(frozen=True, slots=True)
class Limits:
    """Bounds on one expression."""

    # ``characters`` bounds the typed text, ``nodes`` the size of its tree, and ``depth`` its
    # nesting: consecutive sums or products count as one level. ``tree_depth`` bounds the depth of
    # the tree, where each term of a sum is a level: recursive functions on trees use up to three
    # calls for each level, and Python allows 1,000. A text longer than ``repaired`` characters gets
    # no suggestion and is not searched for typical mistakes. ``notes`` bounds the number of notes
    # on a text.
    # The longest entry of a seven-joint arm's pose, expanded and not simplified, has 2,500
    # characters in LaTeX and 270 nodes.

    characters: int = 8_000
    nodes: int = 2_000
    depth: int = 40
    tree_depth: int = 200
    repaired: int = 1_000
    notes: int = 12


LIMITS = Limits()
