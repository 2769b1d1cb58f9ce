"""Answer kind ``frames``: the frames that the student places on the joint axes.

This file judges where frames stand, and says which DH table follows from right ones. The rules of
placement are in ``kinematics.placement``, the slips in ``diagnosis``.
"""

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field, replace
from functools import lru_cache
from itertools import product
from typing import Final

import numpy as np
from numpy.typing import NDArray

from dh_grader.catalogue import Exercise
from dh_grader.catalogue.kinds import FRAME_CELLS, FramesSpec, frame_labels
from dh_grader.catalogue.robot import at_home
from dh_grader.expressions.printing import PLAIN, Spelling
from dh_grader.grading.diagnosis.screws_and_placements import (
    WrongFrameOrigin,
    WrongFrameX,
    WrongFrameZ,
    WrongJointAxis,
    WrongPlacement,
)
from dh_grader.grading.judging import Content, Grading, Judged, StudentChain, cell_report, of_rows
from dh_grader.grading.marks import steps_lost
from dh_grader.grading.misconception import diagnosed, number_formula, sum_formula, value_formula
from dh_grader.grading.numbers import (
    EXACT_VALUE,
    PRINTED_NUMBER,
    Match,
    Samples,
    entry_matches,
    rounding_slack,
)
from dh_grader.grading.reading.entries import Entry, entry_values
from dh_grader.grading.reading.lists import Direction, StudentFrame, read_frames, unread_verdict
from dh_grader.grading.report import (
    ROUNDED,
    CellReport,
    Correction,
    Finding,
    RowReport,
    Severity,
    Verdict,
    row_report,
)
from dh_grader.kinematics import (
    ALPHA,
    COLUMNS,
    NO_ROTATION,
    THETA,
    Convention,
    D,
    Matrices,
    Numbers,
    Table,
    cross,
    frames,
    identity,
    joint_frames,
    links,
)
from dh_grader.kinematics.placement import (
    AskedFrame,
    AxisLine,
    RightPlace,
    asked_frames,
    axis_across,
    frame_of,
    home_rows,
    largest,
    right_places,
    z_line,
)
from dh_grader.translations import say

# --- Compare placed frames with the rules, with all joint variables 0


# The most sliding joints whose axes are tried both as moved and as drawn: 16 ways.
_MOST_MOVED: Final = 4
AXIS, Z, ORIGIN, X = 0, 1, slice(2, 5), 5


@dataclass(frozen=True, slots=True)
class FramesAtHome:
    """The frames to be placed and the given frames, with all joint variables 0.

    ``joints`` are the numbers of the frames' joints. ``base`` and ``tool`` are ``(SAMPLES, 4, 4)``.
    """

    convention: Convention
    asked: tuple[AskedFrame, ...]
    joints: tuple[int, ...]
    base: Matrices
    tool: Matrices
    length_scale: float


@dataclass(frozen=True, slots=True)
class PlacedFrame:
    """A placed frame in numbers, with the rounding errors of z, origin and x.

    A value that was not read is None or NaN.
    """

    axis: int | None
    z: Numbers | None
    z_slack: float
    origin: Numbers
    origin_slack: float
    x: Numbers | None
    x_slack: float

    @property
    def point(self) -> Numbers | None:
        """The origin ``(SAMPLES, 3)``, None unless all coordinates were read."""
        return self.origin.T if np.isfinite(self.origin).all() else None


@dataclass(frozen=True, slots=True)
class JudgedFrames:
    """The correct places of the frames, and the comparison result of each cell ``(frames, 6)``."""

    places: list[RightPlace]
    found: NDArray[np.int_]

    @property
    def wrong(self) -> int:
        """The number of wrong cells."""
        return int((self.found == Match.DIFFERENT).sum())


def home_samples(exercise: Exercise, samples: Samples) -> Samples:
    """Return the samples, with the value 0 for every joint variable."""
    return samples.cached(
        "home", lambda: Samples(at_home(exercise.joints, samples.values, samples.count))
    )


def home_robot(exercise: Exercise, convention: Convention, samples: Samples) -> FramesAtHome:
    """Return the frames to be placed on the exercise's robot."""

    def compute() -> FramesAtHome:
        robot, home = exercise.robot, home_samples(exercise, samples)
        reached = robot.all_frames(home.values, samples.count)
        on_axes = joint_frames(reached, robot.convention)[: len(robot.joints)]
        has_tool_row = len(robot.tables[convention].rows) > len(robot.joints)
        base = identity((samples.count,))
        asked = asked_frames(
            [z_line(frame) for frame in on_axes],
            [joint.prismatic for joint in robot.joints],
            convention,
            base,
            reached[-1],
            has_tool_row=has_tool_row,
        )
        joints = tuple(robot.joints[frame.joint].index for frame in asked)
        scale = exercise.length_scale
        return FramesAtHome(convention, asked, joints, base, reached[-1], scale)

    return samples.cached(("home_robot", convention), compute)


def placed_frame(frame: StudentFrame, home: Samples) -> PlacedFrame:
    """Return a frame in numbers, at samples with all joint variables 0."""
    slacks = [
        rounding_slack(entry.expression, home) if entry.expression else 0.0
        for entry in frame.origin
    ]
    return PlacedFrame(
        frame.axis.number,
        *_direction(frame.z, home),
        entry_values(frame.origin, ("length",) * 3, home),
        sum(slacks),
        *_direction(frame.x, home),
    )


def _direction(direction: Direction, home: Samples) -> tuple[Numbers | None, float]:
    values = direction.values(home)
    if values is None:
        return None, 0.0
    with np.errstate(invalid="ignore", over="ignore"):
        length = np.linalg.norm(values, axis=-1, keepdims=True)
        values = np.where(length > NO_ROTATION, values, np.nan) / np.maximum(length, NO_ROTATION)
    slacks = (rounding_slack(e.expression, home) for e in direction.entries if e.expression)
    shortest = float(np.nan_to_num(length, nan=1.0, posinf=1.0).min())
    return values, sum(slacks) / max(shortest, NO_ROTATION)


def ways_to_judge(
    robot: FramesAtHome,
    placed: Sequence[PlacedFrame],
    written: Sequence[StudentFrame] | None,
    home: Samples,
) -> list[JudgedFrames]:
    """Judge placed frames in several ways, because the axis of a sliding joint has no fixed place.

    The first way puts each sliding axis through the origin that the student chose, if the rules
    allow that. If cells are then wrong, the other ways leave some sliding axes where the figure
    draws them, or put one sliding axis where the neighbouring frames need it. So one wrong origin
    need not make another frame wrong. ``written`` are the student's entries.
    """
    everywhere = (True,) * len(robot.asked)
    first = _judged(robot, placed, written, home, everywhere)
    moved = [i for i, place in enumerate(first.places) if place.own is not robot.asked[i].own]
    ways = [first]
    if not first.wrong:
        return ways
    chosen = moved[:_MOST_MOVED]
    for choice in list(product((True, False), repeat=len(chosen)))[1:]:
        may_move = list(everywhere)
        for i, each in zip(chosen, choice, strict=True):
            may_move[i] = each
        ways.append(_judged(robot, placed, written, home, may_move))
    needed = {i: _axis_by_others(i, robot, placed, place) for i, place in enumerate(first.places)}
    ways += [
        _judged(robot, placed, written, home, everywhere, {i: axis})
        for i, axis in needed.items()
        if axis is not None
    ]
    return ways


def _axis_by_others(
    i: int, robot: FramesAtHome, placed: Sequence[PlacedFrame], place: RightPlace
) -> AxisLine | None:
    # The axis is moved to where the student's x axes meet it. None if the student's origin is on
    # the axis as drawn, or if no x axis determines where the axis is.
    asked, own = robot.asked[i], placed[i]
    if not asked.slides or own.point is None:
        return None
    if asked.own.distance(own.point) <= EXACT_VALUE * robot.length_scale + own.origin_slack:
        return None
    lines = list(asked.must_meet)
    for other, frame in zip(robot.asked, placed, strict=True):
        if other.neighbour_frame == i and frame.x is not None and frame.point is not None:
            lines.append(AxisLine(frame.x, frame.point))
    if not lines:
        return None
    if own.x is not None and not place.relation.has_one_normal:
        lines.append(AxisLine(own.x, place.neighbour.point))
    if not all(np.isfinite(line.direction).all() for line in lines):
        return None
    return axis_across(asked.own, lines, own.point)


def _judged(
    robot: FramesAtHome,
    placed: Sequence[PlacedFrame],
    written: Sequence[StudentFrame] | None,
    home: Samples,
    may_move: Sequence[bool],
    axes: Mapping[int, AxisLine] | None = None,
) -> JudgedFrames:
    scale = robot.length_scale
    tolerances = [EXACT_VALUE * scale + frame.origin_slack for frame in placed]
    points = [frame.point for frame in placed]
    places = right_places(robot.asked, points, robot.convention, tolerances, scale, may_move, axes)
    found = np.full((len(placed), len(FRAME_CELLS)), int(Match.UNDEFINED))
    for i, (frame, place) in enumerate(zip(placed, places, strict=True)):
        if frame.axis is not None:
            right = frame.axis == robot.joints[i]
            found[i, AXIS] = int(Match.EXACT if right else Match.DIFFERENT)
        if frame.z is not None:
            off = largest(cross(frame.z, place.own.direction))
            found[i, Z] = _match(off, frame.z_slack)
        expressions = [None] * 3 if written is None else [e.expression for e in written[i].origin]
        at_origin = entry_matches(expressions, frame.origin, place.origin.T, scale, home)
        is_read = np.isfinite(frame.origin).all(axis=-1)
        found[i, ORIGIN] = np.where(is_read, at_origin, int(Match.UNDEFINED))
        if frame.x is not None:
            found[i, X] = _match(x_error(frame.x, place), frame.x_slack)
    return JudgedFrames(places, found)


def x_error(x: Numbers, place: RightPlace) -> float:
    """Return the sine of the angle between a unit vector x and the nearest correct x direction."""
    if place.x is None:
        return float(np.nan_to_num(np.abs((x * place.own.direction).sum(axis=-1)), nan=1).max())
    return largest(cross(x, place.x))


def _match(error: float, slack: float) -> int:
    if error <= EXACT_VALUE:
        return int(Match.EXACT)
    return int(Match.ROUNDED if error <= EXACT_VALUE + slack else Match.DIFFERENT)


def lazy_frames(robot: FramesAtHome) -> list[PlacedFrame]:
    """Return an answer that needs no geometry: base frames, with the correct joint numbers."""
    count = len(robot.base)
    z, x = (np.tile(np.eye(3)[i], (count, 1)) for i in (2, 0))
    return [PlacedFrame(joint, z, 0.0, np.zeros((3, count)), 0.0, x, 0.0) for joint in robot.joints]


def known_frames(robot: FramesAtHome, home: Samples) -> NDArray[np.bool_]:
    """Return a mask ``(frames, 6)`` of the cells in which ``lazy_frames`` are wrong."""
    everywhere = (True,) * len(robot.asked)
    judged = _judged(robot, lazy_frames(robot), None, home, everywhere)
    return np.asarray(judged.found == Match.DIFFERENT)


# --- Read and judge an answer


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


# --- The DH table that follows from right frames


def table_of_frames(
    robot: FramesAtHome, placed: Sequence[PlacedFrame], exercise: Exercise, samples: Samples
) -> Table:
    """Return the DH table ``(rows, 4, samples)`` that follows from correct frames.

    If the z axis of a frame is opposite to its joint's axis, the joint variable has a minus sign.
    """
    frames = [robot.base]
    senses = {0: np.ones(len(robot.base))} if robot.convention is Convention.STANDARD else {}
    for asked, frame in zip(robot.asked, placed, strict=True):
        assert frame.z is not None
        assert frame.x is not None
        frames.append(frame_of(frame.z, frame.origin.T, frame.x))
        senses[asked.joint] = np.sign((frame.z * asked.own.direction).sum(axis=-1))
    frames.append(robot.tool)
    table = home_rows(frames, robot.convention)
    for i, joint in enumerate(exercise.joints):
        # The last frame of a modified table without a fixed row is the tool's.
        sense = senses.get(i, np.ones(len(robot.base)))
        table[i, D if joint.prismatic else THETA] += sense * samples.values[joint.variable]
    return table


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
