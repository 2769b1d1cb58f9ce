"""Indices as programs write them: q[0] in Python and q(1) or q{1} in MATLAB are both joint 1."""

from typing import Final, Literal, NamedTuple

from service.expressions.characters import greek
from service.expressions.parsing.lexing.letter_case import split_in_other_case
from service.expressions.parsing.lexing.words import Piece, split
from service.expressions.vocabulary.symbols import Vocabulary
from service.regex import regex

Style = Literal["[", "("]

INDEX: Final = regex(r"\s?(?:\[\s*([0-9]{1,3})\s*\]|\(\s*([0-9]{1,3})\s*\)|"
                          r"\{\s*([0-9]{1,3})\s*\})")  # fmt: skip
_STEM: Final = regex(rf"[A-Za-z{greek.CLASS}]+$")


class Indexed(NamedTuple):
    """A name and its index in brackets, such as q[0].

    ``pieces`` are the names that the text means, here q1, or None. ``style`` is the kind of
    brackets. ``digits`` is the index as the exercise counts it, here "1". ``end`` is the position
    after the brackets.
    """

    pieces: tuple[Piece, ...] | None
    style: Style
    digits: str
    end: int


def indexed(
    run: str, text: str, end: int, vocabulary: Vocabulary, *, from_one: bool = False
) -> Indexed | None:
    """Read the index in brackets after the letters ``run``, which end at ``text[end]``.

    Return None if no index follows. With ``from_one``, indices in square brackets count from 1.
    """
    match = INDEX.match(text, end)
    if match is None or _STEM.search(run) is None:
        return None
    style: Style = "[" if match[1] is not None and not from_one else "("
    number = int(match[1] or match[2] or match[3])
    if style == "[":
        number += _first(run, vocabulary)
    name = f"{run}{number}"
    pieces = split(name, vocabulary) or split_in_other_case(name, vocabulary)
    if pieces is not None and pieces[-1].kind not in {"symbol", "invalid_shorthand", "shorthand"}:
        pieces = None
    return Indexed(pieces, style, str(number), match.end())


def is_family(run: str, vocabulary: Vocabulary) -> bool:
    """True if the letters ``run`` are a known name without its index: q, if q1 is known."""
    return any(split(f"{run}{index}", vocabulary) for index in {1, 2, *vocabulary.joints})


def _first(run: str, vocabulary: Vocabulary) -> int:
    for joint in vocabulary.joints:
        pieces = split(f"{run}{joint}", vocabulary)
        if pieces and pieces[-1].kind == "symbol" and pieces[-1].symbols[0].joint is not None:
            return vocabulary.joints[0]
    return 1
