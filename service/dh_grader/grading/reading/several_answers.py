"""Find several answers to one part in a pasted text: a first try, and what replaced it.

No program knows which of them counts. If they differ, the text is refused, and the message names
the lines of each. If all are equal, the first is read.
"""

from collections.abc import Callable, Iterator, Sequence
from dataclasses import dataclass, replace
from itertools import pairwise
from typing import Final, TypeVar

import numpy as np

from dh_grader.expressions import Kind, Note
from dh_grader.grading.reading.entries import Entry, Reader, entry_values
from dh_grader.grading.report import MAX_PASTED, MAX_SYMBOLS, PASTED_WORK, SYMBOL_WORK, WorkBudget
from dh_grader.kinematics import Numbers
from dh_grader.pasting import GRID_LIMITS, GridError, SourceText
from dh_grader.pasting.around import is_sentence
from dh_grader.regex import regex
from dh_grader.translations import listed, say

R = TypeVar("R")

_MOST: Final = 4
# A reading searches a text for names, units and comments, which costs twice as much as cutting it.
_READING: Final = 3
_FEWEST_LINES: Final = 2
_MOST_LINES: Final = 200
# Programs print numbers with as few as five digits.
_ROUNDED: Final = 1e-4
# The beginning of an answer that has a name or a command: DH = [, T = Matrix(, \begin{tabular}.
_BEGINS: Final = regex(
    r"\s*[A-Za-z]\w{0,40}\s{0,4}:?=\s{0,4}(?:[\w.]{1,40}\(\s{0,4})?[\[{(]"
    r"|.{0,80}\\begin\{(?:tabular[x*]?|longtable|array|tblr|NiceTabular|[pbBvV]?matrix)\}"
)
_ENDS: Final = regex(r".{0,200}\\end\{")
# The first row of a table whose rows have numbers.
_FIRST_ROW: Final = regex(r"[\s|│]*(?:[^\W\d_]{1,12}[ _.]?)?1(?![\w.(*/^+])")
# A line that is no cell: a comment, a rule, a fence, or the title of another try.
_NO_ROW: Final = regex(r"\s*(?:[%#`~].*|[-=_|:+*\s]*|[^\W\d_]{2,20}[\w ]{0,40}[.:]\s*)")


@dataclass(frozen=True, slots=True)
class FoundAnswer:
    """One of several answers in a text: the texts of its cells, row by row, and their entries.

    ``is_whole`` is true if no row is missing.
    """

    texts: tuple[str, ...]
    entries: tuple[Entry, ...]
    quantities: Sequence[Kind]
    is_whole: bool
    is_table: bool = False


# A function that returns the answer in a piece of a text, or None. It may raise GridError.
Find = Callable[[str, Reader], FoundAnswer | None]


def read_once(
    text: str, read: Callable[[str], R], is_one: Callable[[R], bool], find: Find, reader: Reader
) -> tuple[R, tuple[Note, ...]]:
    """Read a text, or only the first of its answers if all are equal; then there is a note.

    Raises GridError if the text cannot be read, or if its answers differ.
    """
    # ``is_one`` is False if what was read may be several answers.
    try:
        found = read(text)
    except GridError:
        if first := _first_of_equals(text, find, reader):
            return read(first[0]), (first[1],)
        raise
    if not is_one(found) and (first := _first_of_equals(text, find, reader)):
        return read(first[0]), (first[1],)
    return found, ()


def _first_of_equals(text: str, find: Find, reader: Reader) -> tuple[str, Note] | None:
    # The text up to the end of its first answer, and a note, if equal answers follow; None if the
    # text has only one answer. Raises GridError if the answers differ.
    # A text that was not cut is not read in pieces either.
    if len(text) > GRID_LIMITS.characters or not reader.budget.charge_pasted(text):
        return None
    if not _FEWEST_LINES <= len(text.splitlines()) <= _MOST_LINES:
        return None
    # The first reading cost as much as each of these, and PASTED_WORK is only a part of it.
    work = _READING * PASTED_WORK * len(text)
    if not reader.budget.affords_search(work):
        return None
    lines = SourceText.of(text).lines()
    own = replace(reader, budget=WorkBudget(MAX_SYMBOLS, repairs=0, pasted=4 * MAX_PASTED))
    try:
        for starts in _starts(lines):
            if not reader.budget.affords_search(work):
                return None
            pieces = [lines[a:b] for a, b in pairwise([*starts, len(lines)])]
            answers = _all_found(pieces, find, own)
            if answers is not None and _are_alternatives(answers, own):
                return _first(pieces, answers, own)
    finally:
        reader.budget.charge_search(SYMBOL_WORK * (MAX_SYMBOLS - max(own.budget.symbols, 0)))
    return None


def _first(
    pieces: Sequence[Sequence[SourceText]], answers: Sequence[FoundAnswer], reader: Reader
) -> tuple[str, Note]:
    content = [[line for line in piece if _is_row(line)] for piece in pieces]
    spans = [(rows[0].whole[0], rows[-1].whole[1]) for rows in content]
    places = [_lines(rows[0].line_number, rows[-1].line_number) for rows in content]
    if not all(_are_equal(answers[0], other, reader) for other in answers[1:]):
        message = say(
            "This text has {number} answers that differ, in the lines {places}. Delete all but "
            "the one that counts.",
            number=len(answers),
            places=listed(places),
        )
        raise GridError("several_answers", message, (spans[0][0], spans[-1][1]))
    message = say(
        "The same answer is in the lines {places}. It was read once.", places=listed(places)
    )
    end = pieces[0][-1].whole[1]
    return content[0][0].typed[:end], Note("answer_repeated", message, spans[1])


def _lines(first: int, last: int) -> str:
    return str(first) if first == last else f"{first}-{last}"


def _all_found(
    pieces: Sequence[Sequence[SourceText]], find: Find, reader: Reader
) -> list[FoundAnswer] | None:
    answers = []
    for piece in pieces:
        if (answer := _found(piece, find, reader)) is None:
            return None
        answers.append(answer)
    return answers


def _found(piece: Sequence[SourceText], find: Find, reader: Reader) -> FoundAnswer | None:
    text = piece[0].typed[piece[0].whole[0] : piece[-1].whole[1]]
    try:
        return find(text, reader)
    except GridError:
        return None


def _are_alternatives(answers: Sequence[FoundAnswer], reader: Reader) -> bool:
    # A part of an answer is no alternative. The rows of one table do not repeat the variable of a
    # joint; a matrix may have none.
    if not any(answer.is_whole for answer in answers):
        return False
    joints = [_joints(answer, reader) for answer in answers]
    if not any(joints):
        return not any(answer.is_table for answer in answers)
    return bool(set.intersection(*joints))


def _joints(answer: FoundAnswer, reader: Reader) -> set[str]:
    known = reader.vocabulary.by_name
    expressions = [each.expression for each in answer.entries if each.expression]
    names = set[str]().union(*(each.symbols for each in expressions))
    return {name for name in names if name in known and known[name].joint is not None}


def _are_equal(one: FoundAnswer, other: FoundAnswer, reader: Reader) -> bool:
    if one.texts == other.texts:
        return True
    if len(one.entries) != len(other.entries):
        return False
    unread = [each for each in (*one.entries, *other.entries) if not each.readable]
    return not unread and np.allclose(
        _values(one, reader), _values(other, reader), rtol=_ROUNDED, atol=_ROUNDED, equal_nan=True
    )


def _values(answer: FoundAnswer, reader: Reader) -> Numbers:
    samples = reader.samples
    if absent := samples.absent_names(each.expression for each in answer.entries):
        samples = samples.with_names(absent)
    return entry_values(answer.entries, answer.quantities, samples)


def _is_row(line: SourceText) -> bool:
    return not _is_between(line.text)


def _is_between(line: str) -> bool:
    return _NO_ROW.fullmatch(line) is not None or is_sentence(line)


def _starts(lines: Sequence[SourceText]) -> Iterator[list[int]]:
    """Yield ways to divide the lines into pieces, as the first line of each piece."""
    rows = [i for i, line in enumerate(lines) if _is_row(line)]
    if len(rows) < _FEWEST_LINES:
        return
    texts = {i: " ".join(lines[i].text.split()) for i in rows}
    named = [i for i in rows if _BEGINS.match(lines[i].text)]
    after_end = [b for a, b in pairwise(rows) if _ENDS.match(lines[a].text)]
    numbered = [i for i in rows if _FIRST_ROW.match(lines[i].text)]
    first = rows[0]
    ways = [
        named,
        after_end,
        [b for a, b in pairwise(rows) if any(lines[i].text.strip() for i in range(a + 1, b))],
        [i for i in rows if texts[i] == texts[first]],
        [b for a, b in pairwise(rows) if b > a + 1],
        numbered,
        *(rows[:: len(rows) // n] for n in range(2, _MOST + 1) if len(rows) % n == 0),
    ]
    tried = set()
    for way in ways:
        # What is before the first piece belongs to it, and so do titles above another piece.
        inner = [_above(i, rows) for i in way if i > first]
        starts = [0, *inner]
        if 2 <= len(starts) <= _MOST and (key := tuple(starts)) not in tried:
            tried.add(key)
            yield starts


def _above(start: int, rows: Sequence[int]) -> int:
    # The line after the last row above a line.
    return max(i for i in rows if i < start) + 1
