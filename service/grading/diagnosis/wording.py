"""Words that several messages share."""

from collections.abc import Sequence

# The symbol of each table column, and the axis along or about which it is measured.
SYMBOLS = ("a", "α", "d", "θ")
MEASURED = ("along x", "about x", "along z", "about z")
POSITIVE = ("in the direction of the axis", "by the right-hand rule") * 2


def listed(words: Sequence[str]) -> str:
    """The words with commas between them and "and" before the last."""
    return " and ".join([", ".join(words[:-1]), words[-1]] if len(words) > 1 else words)
