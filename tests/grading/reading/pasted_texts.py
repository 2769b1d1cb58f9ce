"""Pasted texts of students in five languages, each with its meaning."""

# `pasted_texts/*.txt` and `pasted_texts/more/*.txt` have one file for each language. A text begins
# with a line such as `=== title | table elbow`. The words after the bar are the name of a meaning
# in `meanings.toml`, or `refused` (a table that must be refused), or `refused matrix`. ⇥ is a tab,
# ⍽ a no-break space, ⎵ a narrow no-break space. The meanings are plain arithmetic. The module
# `reference` evaluates them; it shares no code with the program.

import re
import tomllib
from collections.abc import Sequence
from functools import cache
from pathlib import Path
from random import Random
from typing import Any, Final, Literal, NamedTuple

import numpy as np
from dh_grader.expressions import (
    AngleUnit,
    Expression,
    ExpressionError,
    Kind,
    Symbol,
    Vocabulary,
    joint_variable,
    read,
)
from dh_grader.grading.numbers import Samples
from dh_grader.grading.reading.entries import Entry, Reader, pasted_grid
from dh_grader.grading.reading.lists import names_of_coordinates, read_list
from dh_grader.grading.reading.pasted_table import entries_of, read_pasted_table
from dh_grader.grading.report import UnreadableAnswerError
from dh_grader.pasting import GridError

from tests.expressions.reference import worth

FOLDER: Final = Path(__file__).with_name("pasted_texts")
_MEANINGS: Final = tomllib.loads((FOLDER / "meanings.toml").read_text("utf-8"))
# Programs print angles with as few as three digits.
_ROUNDED: Final = 2e-3
_LENGTHS: Final = ("l1", "l2", "l3", "a1", "a2", "a3", "d1", "d2", "d4")
_QUANTITIES: Final[Sequence[Kind]] = ("length", "angle", "length", "angle")
_TITLE: Final = re.compile(r"^=== ", re.MULTILINE)
_SHOWN: Final = str.maketrans("⇥⍽⎵", "\t\u00a0\u202f")
Outcome = Literal["read", "repaired", "advised", "refused", "misread"]


class PastedText(NamedTuple):
    """A pasted text, and the cells that it means."""

    title: str
    text: str
    kind: str
    angle_unit: AngleUnit
    rows: tuple[tuple[str, ...], ...]


class Reading(NamedTuple):
    """How the program read a text, and the messages about it."""

    outcome: Outcome
    advice: tuple[str, ...] = ()


def languages() -> list[str]:
    files = sorted(FOLDER.rglob("*.txt"))
    return [file.relative_to(FOLDER).with_suffix("").as_posix() for file in files]


def texts(language: str) -> list[PastedText]:
    found = []
    for piece in _TITLE.split((FOLDER / f"{language}.txt").read_text("utf-8"))[1:]:
        head, _, text = piece.partition("\n")
        title, _, meaning = head.rpartition(" | ")
        angle_unit: AngleUnit = "degrees" if meaning.startswith("degrees ") else "radians"
        kind, _, name = meaning.removeprefix("degrees ").partition(" ")
        is_refused = kind == "refused"
        rows = () if is_refused else _meant(kind, name)
        kind = name or "table" if is_refused else kind
        text = text.removesuffix("\n").translate(_SHOWN)
        found.append(PastedText(f"{language}: {title}", text, kind, angle_unit, rows))
    return found


def reading_of(case: PastedText) -> Reading:
    """Read a pasted text, and compare the result with its meaning."""
    reader = Reader(
        _vocabulary(case.kind, _joints(case)), Samples(_samples(case, 0)), case.angle_unit, "m"
    )
    try:
        entries = _READERS.get(case.kind, _table)(case, reader)
    except GridError as error:
        return Reading("advised", (f"{error.code}: {error.message}",))
    except UnreadableAnswerError as error:
        return Reading("advised", (f"{error.finding.code}: {error.finding.hint}",))
    advice = [
        f"{finding.code}: {finding.hint}"
        for row in entries
        for entry in row
        if entry.expression is None
        for finding in entry.findings
    ]
    if not case.rows:
        return Reading("advised" if advice else "misread", tuple(advice))
    if [len(row) for row in entries] != [len(row) for row in case.rows]:
        size = [len(row) for row in entries]
        return Reading("advised" if advice else "misread", (*advice, f"the rows have {size} cells"))
    pairs = [
        (entry, cell, kind)
        for row, meant in zip(entries, case.rows, strict=True)
        for entry, cell, kind in zip(row, meant, _kinds(case, row), strict=True)
    ]
    unread = [each for each in pairs if each[0].expression is None]
    wrong = [
        f"{entry.expression.text()} is not {cell}"
        for entry, cell, kind in pairs
        if entry.expression and not _means(entry.expression, cell, kind, case)
    ]
    if wrong:
        return Reading("misread", tuple(wrong))
    if not unread:
        return Reading("read")
    repaired = [_repaired(*each, case) for each in unread]
    if False in repaired:
        return Reading("misread", (*advice, "a repair has another meaning"))
    return Reading("repaired" if None not in repaired else "advised", tuple(advice))


def _kinds(case: PastedText, row: Sequence[Entry]) -> Sequence[Kind]:
    kinds: dict[str, Kind] = {"matrix": "number", "position": "length"}
    return [kinds[case.kind]] * len(row) if case.kind in kinds else _QUANTITIES


def _table(case: PastedText, reader: Reader) -> list[tuple[Entry, ...]]:
    return entries_of(read_pasted_table(case.text, reader), reader)


def _matrix(case: PastedText, reader: Reader) -> list[tuple[Entry, ...]]:
    grid = pasted_grid(case.text, reader)
    return [tuple(reader.read(cell.text, "number") for cell in row) for row in grid.rows]


def _position(case: PastedText, reader: Reader) -> list[tuple[Entry, ...]]:
    return [(*read_list(case.text, names_of_coordinates("xyz"), reader).entries,)]


_READERS: Final = {"matrix": _matrix, "position": _position}


def _repaired(entry: Entry, cell: str, kind: Kind, case: PastedText) -> bool | None:
    suggestion = next((each.suggestion for each in entry.findings if each.suggestion), None)
    if suggestion is None:
        return None
    vocabulary = _vocabulary(case.kind, _joints(case))
    try:
        found = read(suggestion, vocabulary, quantity=kind, angle_unit=case.angle_unit)
    except ExpressionError:
        return False
    return _means(found, cell, kind, case)


def _means(expression: Expression, cell: str, kind: Kind, case: PastedText) -> bool:
    for seed in range(3):
        values = _values(seed)
        [found] = np.ravel(expression.evaluate(_samples(case, seed)))
        gap = abs(float(found) - worth(cell, values))
        if not (gap <= _ROUNDED or (kind == "angle" and abs(gap - 2 * np.pi) <= _ROUNDED)):
            return False
    return True


def _samples(case: PastedText, seed: int) -> dict[str, np.ndarray]:
    values = _values(seed)
    return {
        symbol.name: np.array([values[symbol.aliases[0] if symbol.joint else symbol.name]])
        for symbol in _vocabulary(case.kind, _joints(case)).symbols
    }


@cache
def _values(seed: int) -> dict[str, float]:
    random = Random(seed)
    joints = {f"q{i}": random.uniform(0.2, 0.9) for i in range(1, 5)}
    return {name: random.uniform(1.2, 1.9) for name in _LENGTHS} | joints | {"d3": joints["q3"]}


def _joints(case: PastedText) -> int:
    return len(case.rows) if case.rows and case.kind.startswith("table") else 4


@cache
def _vocabulary(kind: str, count: int) -> Vocabulary:
    slides = kind == "table.scara"
    joints = [joint_variable(i, sliding=slides and i == 3) for i in range(1, count + 1)]
    lengths = _LENGTHS if slides else (*_LENGTHS, "d3")
    return Vocabulary([*joints, *(Symbol(name, "length") for name in lengths)])


def _meant(kind: str, name: str) -> tuple[tuple[str, ...], ...]:
    table: Any = _MEANINGS
    for key in kind.split("."):
        table = table[key]
    rows = " ".join(table[name].split()).split(";")
    return tuple(tuple(cell.strip() for cell in row.split(", ")) for row in rows)
