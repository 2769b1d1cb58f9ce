"""What an answer must look like, in words: what the API gives as a part's shape."""

from collections.abc import Iterable
from typing import assert_never

from service.api.exercises import (
    DhRowShape,
    DhTableShape,
    LinkTransformsShape,
    ListShape,
    MatrixShape,
    ScrewAxesShape,
    Shape,
)


def in_words(shape: Shape) -> str:
    """The shape of an answer in one sentence: "a matrix of 4 rows and 4 columns"."""
    match shape:
        case DhTableShape():
            freedoms = {name: getattr(shape, name) for name in _CHOICES}
            return _clauses(
                f"a table with the rows {_listed(shape.rows)} and the columns "
                f"{_listed(shape.columns)}",
                f"{shape.convention} convention",
                *_freedoms(freedoms),
            )
        case LinkTransformsShape():
            return _clauses(
                f"a list of the matrices {_listed(shape.matrices)}, each of "
                f"{len(shape.rows)} rows and {len(shape.columns)} columns",
                f"{shape.convention} convention",
                *_freedoms({"frames": shape.frames}),
            )
        case ScrewAxesShape():
            return _clauses(
                f"a list of screw axes, {len(shape.columns)} numbers (ω; v) for each of "
                f"{_listed(shape.rows)}",
                f"{shape.frame} frame",
                *_freedoms({"directions": shape.directions}),
            )
        case DhRowShape():
            return _clauses(
                f"one row with {_listed(shape.columns)}, or none",
                f"{shape.convention} convention",
            )
        case ListShape():
            values = _listed(f"{each.name} ({each.quantity})" for each in shape.components)
            turns = f"{shape.sequence} about {shape.axes} axes" if shape.sequence else ""
            return _clauses(f"a list: {values}", turns)
        case MatrixShape():
            return f"a matrix of {len(shape.rows)} rows and {len(shape.columns)} columns"
        case _:
            assert_never(shape)


# What may be the student's own choice, as it is called in an exercise file.
_CHOICES = ("frames", "base", "tool", "directions")
_NAMES = {"base": "base frame", "tool": "tool frame"}


def _freedoms(freedoms: dict[str, str]) -> Iterable[str]:
    """What is the student's own choice, and what is given."""
    for freedom in ("free", "given"):
        names = [_NAMES.get(name, name) for name, stated in freedoms.items() if stated == freedom]
        if names:
            yield f"{_listed(names)} {freedom}"


def _clauses(*clauses: str) -> str:
    return "; ".join(filter(None, clauses))


def _listed(names: Iterable[str]) -> str:
    return ", ".join(names)
