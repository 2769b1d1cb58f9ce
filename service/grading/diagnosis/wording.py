"""Words that several messages share."""

from collections.abc import Sequence

# The symbol of each table column, and the axis along or about which it is measured.
SYMBOLS = ("a", "α", "d", "θ")
MEASURED = ("along x", "about x", "along z", "about z")
POSITIVE = ("in the direction of the axis", "by the right-hand rule") * 2


def listed(words: Sequence[str]) -> str:
    """Return the words with commas between them and "and" before the last."""
    return " and ".join([", ".join(words[:-1]), words[-1]] if len(words) > 1 else words)


def axes_of_row(axis: str, label: str, last: int) -> str:
    """Return the names of the two axes ``x`` or ``z`` that a row leads between.

    ``label`` is the label of the row; ``last`` is the number of the last joint. A row without a
    label, and the second row after the last joint, have axes without names.
    """
    if label.isdecimal():
        return f"{axis}{int(label) - 1} and {axis}{label}"
    return f"{axis}{last} and the last {axis} axis" if label == "e" else f"the two {axis} axes"
