"""Answer kind ``frames``: the frames that the student places on the joint axes."""

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field, replace
from functools import lru_cache
from typing import Final

import numpy as np

from service.catalogue.parts.frames import FRAME_CELLS, FramesSpec, frame_labels
from service.expressions.printing.spelling import PLAIN, Spelling
from service.grading.diagnosis.placements.frame_slips import (
    WrongFrameOrigin,
    WrongFrameX,
    WrongFrameZ,
    WrongJointAxis,
    WrongPlacement,
)
from service.grading.feedback import ROUNDED, Finding
from service.grading.formula_text import number_formula, sum_formula, value_formula
from service.grading.judging.content import of_rows
from service.grading.judging.marking.marks import steps_lost
from service.grading.judging.placements import (
    AXIS,
    FramesAtHome,
    JudgedFrames,
    PlacedFrame,
    X,
    Z,
    home_robot,
    home_samples,
    known_frames,
    placed_frame,
    table_of_frames,
    ways_to_judge,
)
from service.grading.judging.report_rows import cell_report
from service.grading.misconception import diagnosed
from service.grading.numerics.comparison import Match
from service.grading.numerics.samples import Samples
from service.grading.numerics.tolerances import EXACT_VALUE, PRINTED_NUMBER
from service.grading.part import Content, Grading, Judged, StudentChain
from service.grading.reading.entry import Entry
from service.grading.reading.lists.frame_list import (
    Direction,
    StudentFrame,
    read_frames,
    unread_verdict,
)
from service.grading.report import CellReport, Correction, RowReport, Severity, Verdict, row_report
from service.kinematics.chain import ALPHA, COLUMNS, THETA, Table, frames, links
from service.kinematics.dh import Convention
from service.kinematics.transforms import Matrices, Numbers
from service.translations import say

# The share of the points that frames of the other convention cost, regardless of their number.
COST: Final = 0.5


def read_frames_answer(
    part: FramesSpec, answer: object, grading: Grading
) -> tuple[StudentFrame, ...] | None:
    """Read the frames in JSON rows or a pasted table; return None if there are none."""
    if answer in ([], ""):
        return None
    return read_frames(
        answer, frame_labels(grading.exercise.robot, part.convention), grading.reader
    )


def judge_frames_answer(
    part: FramesSpec, answer: tuple[StudentFrame, ...], grading: Grading
) -> Judged:
    """Judge the frames by the rules of the convention; the report has one row for each frame."""
    exercise, samples = grading.exercise, grading.samples
    home = home_samples(exercise, samples)
    robot = home_robot(exercise, part.convention, samples)
    placed = [placed_frame(frame, home) for frame in answer]
    content = _content(_Asked(exercise.version, part.convention, robot, home))
    judged = min(
        ways_to_judge(robot, placed, answer, home),
        key=lambda way: steps_lost(part, _without_messages(way, answer, content)),
    )
    labels = frame_labels(exercise.robot, part.convention)
    spelling = grading.spelling(entry for frame in answer for entry in frame.entries)
    rows = tuple(
        row_report(label, _cells(i, answer[i], placed[i], robot, judged, spelling, home, grading))
        for i, label in enumerate(labels)
    )
    result = Judged(rows, content)
    if result.is_right:
        messages = grading.messages(_table_told(part, robot, placed, grading))
        chain = _chain(part, answer, grading)
        return replace(result, feedback=messages, chain=lambda: chain)
    if judged.wrong > 1 and _is_other_convention(part, answer, placed, judged, grading):
        told = grading.messages((_OTHER_CONVENTION,))
        silent = tuple(_without_slips(row) for row in rows)
        return replace(result, rows=silent, feedback=told, whole_cost=COST)
    return result


@dataclass(frozen=True)
class _Asked:
    # A cache key that does not depend on the samples.
    version: str
    convention: Convention
    robot: FramesAtHome = field(compare=False)
    home: Samples = field(compare=False)


@lru_cache(maxsize=256)
def _content(asked: _Asked) -> Content:
    # An empty cell costs as much as a wrong one.
    return of_rows(known_frames(asked.robot, asked.home))


def _without_messages(
    judged: JudgedFrames, answer: Sequence[StudentFrame], content: Content
) -> Judged:
    rows = []
    for matches, frame in zip(judged.found.tolist(), answer, strict=True):
        written = ((frame.axis.entry,), frame.z.entries, *((e,) for e in frame.origin))
        cells = zip(FRAME_CELLS, (*written, frame.x.entries), matches, strict=True)
        rows.append(row_report("", tuple(CellReport(n, _verdict(e, m)) for n, e, m in cells)))
    return Judged(tuple(rows), content)


def _verdict(entries: Sequence[Entry], match: int) -> Verdict:
    if match == Match.UNDEFINED:
        return unread_verdict(entries) or Verdict.INCORRECT
    return Verdict.INCORRECT if match == Match.DIFFERENT else Verdict.CORRECT


def _cells(
    i: int,
    frame: StudentFrame,
    placed: PlacedFrame,
    robot: FramesAtHome,
    judged: JudgedFrames,
    spelling: Spelling,
    home: Samples,
    grading: Grading,
) -> tuple[CellReport, ...]:
    found, place = judged.found[i].tolist(), judged.places[i]
    slack = EXACT_VALUE * robot.length_scale + placed.origin_slack
    at = (robot.convention, place)
    cases: dict[int, WrongPlacement] = {}
    if placed.axis is not None:
        cases[AXIS] = WrongJointAxis(*at, 0.0, placed.axis, robot.joints[i])
    if placed.z is not None:
        cases[Z] = WrongFrameZ(*at, placed.z_slack, placed.z)
    if placed.x is not None and np.isfinite(placed.x).all():
        cases[X] = WrongFrameX(*at, EXACT_VALUE + placed.x_slack, placed.x)
    point = placed.point
    origin = None
    if point is not None and Match.DIFFERENT in found[2:5]:
        origin = diagnosed(WrongFrameOrigin(*at, slack, point))
    slips = {
        cell: finding
        for cell, case in cases.items()
        if found[cell] == Match.DIFFERENT and (finding := diagnosed(case)) is not None
    }
    if grading.corrects:
        for cell, right in ((Z, place.own.direction), (X, place.x)):
            if cell in slips:
                slips[cell] = replace(slips[cell], correction=_direction_text(right) or "")
    reports = [
        _plain_cell(FRAME_CELLS[AXIS], (frame.axis.entry,), found[AXIS], slips.get(AXIS), grading)
    ]
    reports.append(_direction_cell(Z, frame.z, found, slips, grading))
    for k, entry in enumerate(frame.origin):
        told = origin
        if origin is not None and grading.corrects and found[2 + k] == Match.DIFFERENT:
            length = _length_text(place.origin[:, k], spelling, home, grading)
            told = replace(origin, correction=length or "")
        reports.append(cell_report(entry, FRAME_CELLS[2 + k], found[2 + k], told, grading))
    reports.append(_direction_cell(X, frame.x, found, slips, grading))
    return tuple(reports)


def _direction_cell(
    cell: int,
    direction: Direction,
    found: Sequence[int],
    slips: Mapping[int, Finding],
    grading: Grading,
) -> CellReport:
    return _plain_cell(FRAME_CELLS[cell], direction.entries, found[cell], slips.get(cell), grading)


def _plain_cell(
    label: str, entries: Sequence[Entry], match: int, slip: Finding | None, grading: Grading
) -> CellReport:
    findings = tuple(finding for entry in entries for finding in entry.findings)
    if match == Match.DIFFERENT and slip:
        findings = (*findings, slip)
    if match == Match.ROUNDED:
        findings = (*findings, ROUNDED)
    return CellReport(label, _verdict(entries, match), grading.messages(findings))


def _length_text(
    values: Numbers, spelling: Spelling, home: Samples, grading: Grading
) -> Correction | None:
    exercise = grading.exercise
    none = (0,) * len(exercise.joints)
    found = sum_formula(values, none, False, exercise, home, spelling)
    return found or number_formula(values)


def _direction_text(direction: Numbers | None) -> str | None:
    # A base direction such as +y, or a vector; None if it varies.
    if direction is None or np.ptp(direction, axis=0).max() > EXACT_VALUE:
        return None
    # Either sense is right.
    largest = int(np.abs(direction[0]).argmax())
    vector = direction[0] * np.sign(direction[0, largest])
    if vector[largest] > 1 - PRINTED_NUMBER:
        return f"+{'xyz'[largest]}"
    numbers = ", ".join(f"{number:.4g}" for number in (vector + 0.0).tolist())
    return f"[{numbers}]"


def _without_slips(row: RowReport) -> RowReport:
    cells = tuple(
        replace(cell, feedback=()) if cell.verdict is Verdict.INCORRECT else cell
        for cell in row.cells
    )
    return replace(row, cells=cells)


def _is_other_convention(
    part: FramesSpec,
    answer: Sequence[StudentFrame],
    placed: Sequence[PlacedFrame],
    judged: JudgedFrames,
    grading: Grading,
) -> bool:
    # At least two frames, all correct in the other convention.
    other = part.convention.other
    exercise = grading.exercise
    if other not in exercise.robot.tables or (judged.found == Match.UNDEFINED).any():
        return False
    labels = frame_labels(exercise.robot, part.convention)
    places = [
        labels.index(label) for label in frame_labels(exercise.robot, other) if label in labels
    ]
    robot = home_robot(exercise, other, grading.samples)
    if len(places) < 2 or len(places) < len(labels) or len(robot.asked) != len(places):
        return False
    home = home_samples(exercise, grading.samples)
    chosen = [placed[i] for i in places]
    [first, *_] = ways_to_judge(robot, chosen, [answer[i] for i in places], home)
    return not first.wrong


def _table_at(
    part: FramesSpec, answer: Sequence[StudentFrame], grading: Grading, at: Samples
) -> Table:
    exercise = grading.exercise
    home = home_samples(exercise, at)
    robot = home_robot(exercise, part.convention, at)
    placed = [placed_frame(frame, home) for frame in answer]
    return table_of_frames(robot, placed, exercise, at)


def _chain(part: FramesSpec, answer: Sequence[StudentFrame], grading: Grading) -> StudentChain:
    table = _table_at(part, answer, grading, grading.samples)

    def frames_at(samples: Samples) -> Matrices:
        return frames(_table_at(part, answer, grading, samples), part.convention)

    return StudentChain(frames(table, part.convention), frames_at, links(table, part.convention))


def _table_told(
    part: FramesSpec, robot: FramesAtHome, placed: Sequence[PlacedFrame], grading: Grading
) -> tuple[Finding, ...]:
    # No message if a later part asks for this table.
    exercise = grading.exercise
    if not grading.corrects or any(each.follows == part.id for each in exercise.parts):
        return ()
    rows = frames_table(robot, placed, grading)
    if rows is None:
        return ()
    text = "; ".join(", ".join(row) for row in rows)
    return (replace(_TABLE, correction=text),)


def frames_table(
    robot: FramesAtHome, placed: Sequence[PlacedFrame], grading: Grading
) -> list[list[str]] | None:
    """Return the cells of the DH table of correct frames; None if a cell has no formula."""
    exercise, samples = grading.exercise, grading.samples
    table = table_of_frames(robot, placed, exercise, samples)
    at_home = table_of_frames(robot, placed, exercise, home_samples(exercise, samples))
    rows = []
    for values, constants in zip(table, at_home, strict=True):
        cells = [
            _cell_text(cell, constant, column in (ALPHA, THETA), grading)
            for column, (cell, constant) in enumerate(zip(values, constants, strict=True))
        ]
        rows.append([cell for cell in cells if cell is not None])
    return rows if all(len(row) == len(COLUMNS) for row in rows) else None


def _cell_text(values: Numbers, constant: Numbers, angle: bool, grading: Grading) -> str | None:
    # ``constant`` is the value of the cell with all joint variables 0. Numbers have enough figures
    # not to count as rounded.
    exercise, samples = grading.exercise, grading.samples
    value = float(np.degrees(constant[0]) if angle else constant[0])
    if np.ptp(constant) > EXACT_VALUE or abs(float(f"{value:.6g}") - value) < EXACT_VALUE:
        found = value_formula(values, angle, exercise, samples, PLAIN)
        return None if found is None else found.text
    motion = value_formula(values - constant, angle, exercise, samples, PLAIN)
    number = f"{abs(value):.13g}{'deg' if angle else ''}"
    if motion is None:
        return None
    return f"{motion.text} {'-' if value < 0 else '+'} {number}"


_TABLE: Final = Finding(
    "table_of_frames",
    say("These frames lead to one DH table."),
    severity=Severity.INFO,
)
_OTHER_CONVENTION: Final = Finding(
    "frames_of_other_convention",
    say("These are right frames of the other convention."),
    say("Put z of each frame along the axis that this convention takes."),
)
