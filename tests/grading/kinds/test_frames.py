"""Grade frames that a student places on joint axes."""

from collections import Counter
from collections.abc import Callable, Mapping
from typing import Any

import numpy as np
import pytest
from dh_grader.catalogue import Exercise, FeedbackLevel
from dh_grader.grading import PartReport, Verdict

from tests.grading.support.placing import broken, drawn_arm, drawn_frames, home_of, is_valid
from tests.grading.support.submitting import (
    Make,
    all_codes,
    full_marks,
    handed_in,
    not_correct,
    part,
)

# The campaign: 200 robots with 100 valid and 100 broken placements each.
ROBOTS, PLACEMENTS, TABLES, SAMPLE = 200, 100, 20, 4
# The share of broken placements of one robot of which another frame, or several, may be blamed.
BLAMED = 0.2
EMPTIED = 3

PLANAR = [
    {"axis": 1, "z": "+z", "origin": [0, 0, 0], "x": "+x"},
    {"axis": 2, "z": "+z", "origin": ["l1", 0, 0], "x": "+x"},
    {"axis": 3, "z": "+z", "origin": ["l1 + l2", 0, 0], "x": "+x"},
]
STANFORD = [
    {"axis": 2, "z": "+y", "origin": [0, 0, 0], "x": "+x"},
    {"axis": 3, "z": "+z", "origin": [0, "d2", 0], "x": "+x"},
    {"axis": 4, "z": "+z", "origin": [0, "d2", 0], "x": "+x"},
    {"axis": 5, "z": "+y", "origin": [0, "d2", 0], "x": "+x"},
    {"axis": 6, "z": "+z", "origin": [0, "d2", 0], "x": "+x"},
]
Rows = list[dict[str, Any]]


def placed(
    exercise: Exercise, answer: object, feedback: FeedbackLevel = FeedbackLevel.FULL
) -> PartReport:
    return part(handed_in(exercise, {"frames": answer}, feedback=feedback), "frames")


def changed(rows: Rows, i: int, **cells: object) -> Rows:
    return [*rows[:i], {**rows[i], **cells}, *rows[i + 1 :]]


@pytest.fixture
def planar(catalogue: Mapping[str, Exercise]) -> Exercise:
    return catalogue["planar-rrr-frames"]


@pytest.fixture
def stanford(catalogue: Mapping[str, Exercise]) -> Exercise:
    return catalogue["stanford-arm-frames"]


@pytest.mark.parametrize(
    "rows",
    [
        PLANAR,
        changed(PLANAR, 1, origin=["l1", 0, "0.3"], z="-z", x="-x0"),
        changed(PLANAR, 0, axis="joint 1", z=[0, 0, 2], origin="0, 0, l2", x="(-1, 0, 0)"),
        {"rows": [{"frame": i, **PLANAR[i - 1]} for i in (3, 1, 2)]},
    ],
)
def test_every_choice_by_the_rules_is_right(rows: object, planar: Exercise) -> None:
    assert full_marks(placed(planar, rows))


@pytest.mark.parametrize(
    ("i", "cells", "places", "code"),
    [
        (1, {"axis": 2}, {("2", "axis")}, "axis_of_other_convention"),
        (1, {"axis": 6}, {("2", "axis")}, "wrong_joint_axis"),
        (0, {"z": "+z"}, {("1", "z")}, "z_not_along_axis"),
        (0, {"z": [0, 1, "0.1"]}, {("1", "z")}, "z_not_along_axis"),
        (4, {"origin": ["d2", "d2", 0]}, {("5", "origin_x")}, "origin_off_axis"),
        (4, {"origin": [0, "d2", "d6"]}, {("5", "origin_z")}, "origin_not_at_intersection"),
        (1, {"x": "+z"}, {("2", "x")}, "x_not_perpendicular"),
        (1, {"x": "+y"}, {("2", "x")}, "x_not_perpendicular_to_neighbour"),
        (2, {"x": [0, 0, 0]}, {("3", "x")}, None),
    ],
)
def test_a_broken_rule_is_named_and_other_frames_stay_right(
    i: int,
    cells: dict[str, object],
    places: set[tuple[str, str]],
    code: str | None,
    stanford: Exercise,
) -> None:
    report = placed(stanford, changed(STANFORD, i, **cells))
    assert not_correct(report) == dict.fromkeys(places, Verdict.INCORRECT)
    assert all_codes(report) == ({code} if code else set())
    assert 0 < report.points < report.max_points


def test_the_whole_other_convention_costs_half(make_exercise: Make) -> None:
    text = """
title = "Made"
source = "none"
statement = "None."
[robot]
structure = "RRRR"
convention = "modified"
joints = ["q1", "q2", "q3", "q4"]
table = [["0", "0", "0", "q1"], ["0.3", "90deg", "0", "q2"], ["0.5", "90deg", "0", "q3"],
    ["0.2", "90deg", "0", "q4"]]
[[parts]]
id = "frames"
kind = "frames"
title = "Frames"
points = 12
convention = "modified"
"""
    exercise = make_exercise(text)
    right = [
        {"axis": 1, "z": "+z", "origin": [0, 0, 0], "x": "+x"},
        {"axis": 2, "z": "-y", "origin": ["0.3", 0, 0], "x": "+x"},
        {"axis": 3, "z": "-z", "origin": ["0.8", 0, 0], "x": "+x"},
    ]
    assert full_marks(placed(exercise, right))
    following = [
        {"axis": 2, "z": "-y", "origin": ["0.3", 0, 0], "x": "+x"},
        {"axis": 3, "z": "-z", "origin": ["0.8", 0, 0], "x": "+x"},
        {"axis": 4, "z": "+y", "origin": ["1", 0, 0], "x": "+x"},
    ]
    report = placed(exercise, following)
    assert all_codes(report) == {"frames_of_other_convention"}
    assert report.points == report.max_points / 2


def test_a_wrong_origin_on_a_moved_sliding_axis_makes_no_later_frame_wrong(
    make_exercise: Make,
) -> None:
    # Joint 2 slides along y; its axis may lie at any height. Joint 3 is vertical, at (0.3, 0).
    text = """
title = "Made"
source = "none"
statement = "None."
[robot]
structure = "RPR"
convention = "standard"
joints = ["q1", "d2", "q3"]
table = [["0", "90deg", "0.4", "q1"], ["0.3", "90deg", "d2", "0"], ["0.2", "0", "0", "q3"]]
[[parts]]
id = "frames"
kind = "frames"
title = "Frames"
convention = "standard"
"""
    exercise = make_exercise(text)
    rows = [
        {"axis": 2, "z": "-y", "origin": [0, 0, 0.9], "x": "+x"},
        {"axis": 3, "z": "-z", "origin": [0.3, 0, 0.9], "x": "+x"},
    ]
    assert full_marks(placed(exercise, rows))
    report = placed(exercise, changed(rows, 0, origin=[0, 0.2, 0.9]))
    assert not_correct(report) == {("1", "origin_y"): Verdict.INCORRECT}


@pytest.mark.parametrize(
    ("cells", "cell", "verdict"),
    [
        ({"axis": None}, "axis", Verdict.MISSING),
        ({"axis": "two"}, "axis", Verdict.UNREADABLE),
        ({"axis": True}, "axis", Verdict.UNREADABLE),
        ({"axis": 2.5}, "axis", Verdict.UNREADABLE),
        ({"z": "up"}, "z", Verdict.UNREADABLE),
        ({"z": ""}, "z", Verdict.MISSING),
        ({"x": [1, 0]}, "x", Verdict.UNREADABLE),
        ({"x": "[1, 0, ?]"}, "x", Verdict.UNREADABLE),
        ({"origin": [0, 0, "l9"]}, "origin_z", Verdict.UNREADABLE),
        ({"origin": None}, "origin_x", Verdict.MISSING),
    ],
)
def test_an_unreadable_cell_is_not_a_wrong_one(
    cells: dict[str, object], cell: str, verdict: Verdict, planar: Exercise
) -> None:
    found = not_correct(placed(planar, changed(PLANAR, 0, **cells)))
    assert found["1", cell] is verdict
    assert Verdict.INCORRECT not in found.values()


@pytest.mark.parametrize(
    "answer",
    [
        7,
        [1, 2, 3],
        [*PLANAR, PLANAR[0]],
        [{"frame": 1, **PLANAR[0]}, {"frame": 1, **PLANAR[1]}],
        [{"frame": 9, **PLANAR[0]}],
        [{**PLANAR[0], "why": 1}],
        "z is up",
        [{**PLANAR[0], "origin": {"x": 1}}],
    ],
)
def test_another_shape_is_refused(answer: object, planar: Exercise) -> None:
    report = placed(planar, answer)
    assert report.verdict is Verdict.UNREADABLE
    assert [message.code for message in report.feedback] == ["wrong_shape"]


def test_rounded_numbers_are_right(make_exercise: Make) -> None:
    text = """
title = "Made"
source = "none"
statement = "None."
[robot]
structure = "RR"
convention = "standard"
joints = ["q1", "q2"]
table = [["0.5", "45deg", "0", "q1 + 30deg"], ["0.3", "0", "0", "q2"]]
[[parts]]
id = "frames"
kind = "frames"
title = "Frames"
convention = "standard"
"""
    row = {"axis": 2, "z": [0.354, -0.612, 0.707], "origin": [0.433, 0.25, 0], "x": [0.866, 0.5, 0]}
    report = placed(make_exercise(text), [row])
    assert full_marks(report)
    assert "rounded" in all_codes(report)
    assert not full_marks(placed(make_exercise(text), [{**row, "origin": [0.43, 0.26, 0]}]))


@pytest.mark.long
def test_an_empty_cell_never_earns_more(stanford: Exercise) -> None:
    rng = np.random.default_rng(5)
    choices: dict[str, list[Any]] = {
        "axis": [1, 3, 5],
        "z": ["+x", "-y", "+z"],
        "x": ["+x", "+y", "-z"],
    }
    for _ in range(EMPTIED):
        rows = [
            {
                **row,
                **{
                    name: values[int(rng.integers(3))]
                    for name, values in choices.items()
                    if rng.random() < 0.3
                },
            }
            for row in STANFORD
        ]
        if rng.random() < 0.5:
            rows = changed(rows, 1, origin=["d2", "d6", 0])
        whole = placed(stanford, rows).points
        for i in range(5):
            for name in ("axis", "z", "origin", "x"):
                assert placed(stanford, changed(rows, i, **{name: None})).points <= whole


def table_of(report: PartReport) -> list[list[str]]:
    """Return the DH table that the report shows."""
    [message] = [each for each in report.feedback if each.code == "table_of_frames"]
    assert message.correction is not None
    return [row.split(", ") for row in message.correction.text.split("; ")]


def test_the_table_is_not_shown_where_it_is_asked_next(planar: Exercise) -> None:
    assert "table_of_frames" not in all_codes(placed(planar, PLANAR))


@pytest.mark.sampled(4)
@pytest.mark.parametrize(
    ("seed", "placements"),
    [
        *((seed, SAMPLE) for seed in range(0, ROBOTS, 25)),
        *(pytest.param(seed, PLACEMENTS, marks=pytest.mark.campaign) for seed in range(ROBOTS)),
    ],
)
def test_random_placements_are_judged_as_by_the_oracle(
    seed: int, placements: int, make_exercise: Make, figure: Callable[[str], None]
) -> None:
    rng = np.random.default_rng(seed)
    arm = drawn_arm(rng)
    home = home_of(arm)
    exercise = make_exercise(arm.text)
    faults: Counter[str] = Counter()
    count = Counter[str]()
    while count["valid"] < placements:
        frames = drawn_frames(home, rng)
        assert is_valid(home, frames), "the construction of the test is wrong"
        report = placed(exercise, [frame.posted for frame in frames])
        faults["valid refused"] += not full_marks(report)
        if count["valid"] < TABLES:
            answer = [
                dict(zip(("a", "alpha", "d", "theta"), row, strict=True))
                for row in table_of(report)
            ]
            table = part(handed_in(exercise, {"table": {"rows": answer}}), "table")
            faults["table refused"] += not full_marks(table)
        count["valid"] += 1
        i, wrong = broken(home, frames, rng)
        while is_valid(home, wrong):
            count["harmless"] += 1
            i, wrong = broken(home, frames, rng)
        report = placed(exercise, [frame.posted for frame in wrong], FeedbackLevel.HINTS)
        faults["broken accepted"] += full_marks(report)
        blamed = [k for k, row in enumerate(report.rows) if row.verdict is not Verdict.CORRECT]
        faults["several frames blamed"] += len(blamed) > 1
        faults["another frame blamed"] += len(blamed) == 1 and blamed != [i]
        count["broken"] += 1
    figure(f"{arm.convention} {arm.structure}: {dict(count)}, {dict(+faults)}")
    severe = [
        name for name in ("valid refused", "table refused", "broken accepted") if faults[name]
    ]
    assert not severe, faults
    assert faults["several frames blamed"] <= BLAMED * count["broken"] + 1, faults
    assert faults["another frame blamed"] <= BLAMED * count["broken"] + 1, faults
