"""Import typed tables, and compare the robots of the files with the robots of the tables."""

import re
import tomllib
from collections import Counter
from collections.abc import Iterator, Mapping, Sequence
from typing import NamedTuple

import numpy as np
from dh_grader.importing import ImportedRobot, ImportOptions, RefusedRobotError, imported_table
from dh_grader.kinematics import Convention

from tests.importing.tables.drawn import COLUMNS, Cell, Drawn, pose, terms
from tests.importing.tables.styles import Typed

POSES = 20
SAME = 1e-9
_SNAP = re.compile(r"row (\d+), column (alpha|theta): (\S+) became (\S+)\.$")
_STEP = 15.0


class Outcome(NamedTuple):
    """The outcome of an import: "same", "refused" or a fault, and the reason of a refusal."""

    result: str
    reason: str = ""
    asked: tuple[str, ...] = ()
    snaps: int = 0


def outcome(drawn: Drawn, typed: Typed) -> Outcome:
    """Return the outcome of an import whose author answers all questions truly."""
    options = ImportOptions(
        title="A robot", source="A table", convention=Convention(drawn.convention)
    )
    asked: list[str] = []
    made = ImportedRobot()
    try:
        for _ in range(3):
            made = imported_table(typed.text, options)
            if not made.questions:
                break
            asked += [question.name for question in made.questions]
            options = options.with_answers({name: typed.answers[name] for name in asked})
    except RefusedRobotError as error:
        return Outcome("refused", str(error), tuple(asked))
    if made.questions:
        return Outcome("asks without end", asked=tuple(asked))
    if missing := typed.asked - set(asked):
        return Outcome(f"did not ask: {', '.join(sorted(missing))}", asked=tuple(asked))
    try:
        rows, snaps = snapped(typed.rows, made)
    except AssertionError as error:
        return Outcome("a snap that the rule does not allow", str(error))
    difference = greatest_difference(drawn, rows, made.text)
    result = "same" if difference < SAME else f"changed by {difference:.1e}"
    return Outcome(result, asked=tuple(asked), snaps=snaps)


def snapped(
    rows: Sequence[Mapping[str, Cell]], made: ImportedRobot
) -> tuple[Sequence[Mapping[str, Cell]], int]:
    """Return the rows with the snaps that the remarks list, and the number of snaps."""
    changed = [dict(row) for row in rows]
    file = [line.removeprefix("# ") for line in made.text.splitlines() if line.startswith("# ")]
    found = list(filter(None, map(_SNAP.search, map(str, made.remarks))))
    assert found == [] or [each[0] for each in found] == [
        each[0] for each in filter(None, map(_SNAP.search, file))
    ], "the file lists other snaps"
    for each in found:
        row, column = changed[int(each[1]) - 1], each[2]
        cell, to = row[column], _degrees(each[4])
        assert abs(_degrees(each[3]) - cell.number) < 1e-6, each[0]
        assert abs(to / _STEP - round(to / _STEP)) < 1e-9, each[0]
        radians, written = np.radians(to), each[3].lstrip("-")
        decimals = len(written.partition(".")[2]) if "deg" not in written else 0
        rounded = decimals >= 2 and abs(round(abs(radians), decimals) - float(written)) < 1e-12
        assert rounded or abs(radians - np.radians(cell.number)) < 1.01e-4, each[0]
        row[column] = Cell(to, cell.letters, cell.motion)
    return changed, len(found)


def _degrees(text: str) -> float:
    if text.endswith("deg"):
        return float(text.removesuffix("deg"))
    return float(np.degrees(float(text)))


def greatest_difference(drawn: Drawn, rows: Sequence[Mapping[str, Cell]], file: str) -> float:
    """Return the greatest difference between the poses of a table and of an exercise file."""
    robot = tomllib.loads(file)["robot"]
    joints, structure = robot["joints"], robot["structure"]
    written = []
    for i, texts in enumerate(robot["table"]):
        own = joints[i] if i < len(joints) else ""
        cells = (terms(text, own) for text in texts)
        written.append(dict(zip(COLUMNS, cells, strict=True)))
    if structure != "".join(drawn.kinds):
        return np.inf
    rng = np.random.default_rng(5)
    names = {name for row in rows for cell in row.values() for name in cell.letters}
    greatest = 0.0
    for _ in range(POSES):
        lengths = {name: rng.uniform(0.1, 1.5) for name in sorted(names)}
        values = iter(rng.uniform(-np.pi, np.pi, len(structure)))
        moves = [next(values) if kind else 0.0 for kind in drawn.kinds]
        variables = [move for move, kind in zip(moves, drawn.kinds, strict=True) if kind]
        variables += [0.0] * (len(written) - len(variables))
        expected = pose(rows, drawn.convention, lengths, moves)
        try:
            reached = pose(written, robot["convention"], lengths, variables)
        except KeyError:
            # The file has another letter.
            return np.inf
        greatest = max(greatest, float(np.abs(expected - reached).max()))
    return greatest


def faults(outcomes: Iterator[tuple[str, Typed, Outcome]]) -> tuple[list[str], Counter[str]]:
    """Return the faults, each with its text, and the number of each outcome."""
    found, counts = [], Counter[str]()
    for name, typed, each in outcomes:
        counts[each.result if each.result in ("same", "refused") else "FAULT"] += 1
        counts["asked"] += bool(each.asked)
        counts["snaps"] += each.snaps
        if each.result not in ("same", "refused"):
            found.append(f"{name}: {each.result} {each.reason}\n{typed.text}")
    return found, counts
