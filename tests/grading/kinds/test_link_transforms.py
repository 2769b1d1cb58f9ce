"""Link transforms under free frames, and marks that follow from an earlier answer."""

from collections.abc import Callable, Sequence
from typing import Any

import pytest

from service.catalogue import Exercise
from service.grading import PartReport, Submission, Verdict, grade

SCARA = """
title = "SCARA"
source = "SHV, pp. 91-93"
statement = "As in the book."

[robot]
structure = "RRPR"
convention = "standard"
joints = ["theta1", "theta2", "d3", "theta4"]
table = [
    ["a1", "0", "0", "theta1"],
    ["a2", "180deg", "0", "theta2"],
    ["0", "0", "d3", "0"],
    ["0", "0", "d4", "theta4"],
]

[symbols]
a1 = { kind = "length", description = "link 1" }
a2 = { kind = "length", description = "link 2" }
d4 = { kind = "length", description = "tool" }

[[parts]]
id = "table"
kind = "dh_table"
title = "Table"
points = 8
convention = "standard"
frames = "free"

[[parts]]
id = "links"
kind = "link_transforms"
title = "Link transforms"
points = 8
convention = "standard"
frames = "free"
follows = "table"

[[parts]]
id = "pose"
kind = "transform"
title = "Pose"
points = 8
follows = "links"

[[parts]]
id = "position"
kind = "position"
title = "Position"
points = 3
follows = "pose"
"""

Row = tuple[str, str, str, str]
TABLE: list[Row] = [
    ("a1", "0", "0", "q1"),
    ("a2", "pi", "0", "q2"),
    ("0", "0", "d3", "0"),
    ("0", "0", "d4", "q4"),
]
# The printed form of A_i (SHV, eq. 3.10), filled in by hand.
A1 = [["c1", "-s1", "0", "a1*c1"], ["s1", "c1", "0", "a1*s1"], ["0", "0", "1", "0"], list("0001")]
A2 = [["c2", "s2", "0", "a2*c2"], ["s2", "-c2", "0", "a2*s2"], ["0", "0", "-1", "0"], list("0001")]
A3 = [list("1000"), list("0100"), ["0", "0", "1", "d3"], list("0001")]
A4 = [["c4", "-s4", "0", "0"], ["s4", "c4", "0", "0"], ["0", "0", "1", "d4"], list("0001")]
LINKS = [A1, A2, A3, A4]
IDENTITY = [list("1000"), list("0100"), list("0010"), list("0001")]


def a2_with(length: str) -> list[list[str]]:
    return [[cell.replace("a2", length) for cell in row] for row in A2]


def pose_with(length: str) -> list[list[str]]:
    turn = "q1 + q2 - q4"
    return [
        [f"cos({turn})", f"sin({turn})", "0", f"a1*c1 + {length}*c12"],
        [f"sin({turn})", f"-cos({turn})", "0", f"a1*s1 + {length}*s12"],
        ["0", "0", "-1", "-d3 - d4"],
        list("0001"),
    ]


def table(rows: Sequence[Row]) -> dict[str, Any]:
    return {"rows": [dict(zip(("a", "alpha", "d", "theta"), row, strict=True)) for row in rows]}


@pytest.fixture
def scara(make_exercise: Callable[[str], Exercise]) -> Exercise:
    return make_exercise(SCARA)


def graded(exercise: Exercise, **answers: object) -> dict[str, PartReport]:
    return {part.part: part for part in grade(exercise, Submission(answers)).parts}


def wrong_cells(part: PartReport) -> set[tuple[str, str]]:
    return {
        (row.label, cell.label)
        for row in part.rows
        for cell in row.cells
        if cell.verdict is not Verdict.CORRECT
    }


def test_the_printed_link_transforms_are_right(scara: Exercise) -> None:
    parts = graded(scara, table=table(TABLE), links=LINKS)
    assert parts["links"].verdict is Verdict.CORRECT
    assert parts["links"].points == 8
    assert not parts["links"].follow_through
    assert [row.label for row in parts["links"].rows][:5] == [
        "A1.1",
        "A1.2",
        "A1.3",
        "A1.4",
        "A2.1",
    ]


def test_they_are_graded_in_the_frames_that_the_student_s_table_chose(scara: Exercise) -> None:
    """z2 is left pointing up and turned over one row later: α2 = 0, α3 = π, d3 reversed."""
    own = [TABLE[0], ("a2", "0", "0", "q2"), ("0", "pi", "-d3", "0"), TABLE[3]]
    own_links = [
        A1,
        [["c2", "-s2", "0", "a2*c2"], ["s2", "c2", "0", "a2*s2"], *A1[2:]],
        [list("1000"), ["0", "-1", "0", "0"], ["0", "0", "-1", "-d3"], list("0001")],
        A4,
    ]
    assert graded(scara, table=table(own), links=own_links)["links"].points == 8
    assert graded(scara, links=own_links)["links"].points == 8
    in_other_frames = graded(scara, table=table(own), links=LINKS)["links"]
    assert in_other_frames.points < 8
    assert {row.split(".")[0] for row, _ in wrong_cells(in_other_frames)} == {"A2", "A3"}


def test_without_a_table_a_wrong_matrix_is_named(scara: Exercise) -> None:
    part = graded(scara, links=[A1, a2_with("a1"), A3, A4])["links"]
    assert wrong_cells(part) == {("A2.1", "4"), ("A2.2", "4")}


def test_a_matrix_left_off_is_missing_and_the_others_are_graded(scara: Exercise) -> None:
    part = graded(scara, table=table(TABLE), links=LINKS[:3])["links"]
    assert {row for row, _ in wrong_cells(part)} == {"A4.1", "A4.2", "A4.3", "A4.4"}
    assert part.points == 6


@pytest.mark.parametrize("answer", [5, "x", {}, [5], [[["1"]] * 9], [IDENTITY] * 5, [[]]])
def test_what_is_no_list_of_matrices_is_unreadable(scara: Exercise, answer: object) -> None:
    part = graded(scara, links=answer)["links"]
    assert part.verdict is Verdict.UNREADABLE
    assert part.points == 0


def test_matrices_that_follow_from_a_wrong_table_earn_their_points(scara: Exercise) -> None:
    wrong = table([TABLE[0], ("a1", "pi", "0", "q2"), *TABLE[2:]])
    links = [A1, a2_with("a1"), A3, A4]
    position = ["a1*c1 + a1*c12", "a1*s1 + a1*s12", "-d3 - d4"]
    parts = graded(scara, table=wrong, links=links, pose=pose_with("a1"), position=position)
    assert parts["table"].points == 7.5
    for name in ("links", "pose", "position"):
        assert parts[name].points == parts[name].max_points, name
        assert parts[name].follow_through, name
        assert "follow_through" in [message.code for message in parts[name].feedback]


def test_what_follows_may_skip_a_part_without_answer(scara: Exercise) -> None:
    wrong = table([TABLE[0], ("a1", "pi", "0", "q2"), *TABLE[2:]])
    parts = graded(scara, table=wrong, pose=pose_with("a1"))
    assert parts["pose"].points == 8
    assert parts["pose"].follow_through


def test_what_is_right_does_not_follow(scara: Exercise) -> None:
    wrong = table([TABLE[0], ("a1", "pi", "0", "q2"), *TABLE[2:]])
    parts = graded(scara, table=wrong, links=LINKS, pose=pose_with("a2"))
    assert [parts[name].points for name in ("links", "pose")] == [8, 8]
    assert not any(part.follow_through for part in parts.values())


def test_a_right_table_does_not_make_a_wrong_pose_right(scara: Exercise) -> None:
    parts = graded(scara, table=table(TABLE), pose=pose_with("a1"))
    assert parts["pose"].points == 7
    assert not parts["pose"].follow_through


def test_a_trivial_table_buys_nothing(scara: Exercise) -> None:
    zero = table([("0", "0", "0", "0")] * 4)
    parts = graded(scara, table=zero, links=[IDENTITY] * 4, pose=IDENTITY)
    assert [parts[name].points for name in ("table", "links", "pose")] == [0, 0, 0]
    assert not any(part.follow_through for part in parts.values())


def test_a_poor_table_does_not_carry(scara: Exercise) -> None:
    """Only the joint variables are right; with all else 0 the matrices are too easy."""
    poor = table(
        [("0", "1", "1", "q1"), ("0", "1", "1", "q2"), ("1", "1", "d3", "1"), ("1", "1", "1", "q4")]
    )
    parts = graded(scara, table=poor, pose=IDENTITY)
    assert parts["table"].points < 4
    assert not parts["pose"].follow_through


def test_a_variable_without_effect_buys_nothing(scara: Exercise) -> None:
    """0·q is no motion, whatever letters it holds."""
    idle = "0*(q1 + q2 + d3 + q4)"
    still = [[f"1 + {idle}", "0", "0", "0"], *IDENTITY[1:]]
    parts = graded(scara, table=table([("0", "0", "0", idle)] * 4), links=[still] * 4, pose=still)
    assert [parts[name].points for name in ("table", "links", "pose")] == [0, 0, 0]


def test_a_chain_that_has_lost_a_freedom_does_not_carry(scara: Exercise) -> None:
    """All twists and lengths ignored: one line, four joints, and a pose that anybody can write."""
    bare = table(
        [("0", "0", "0", "q1"), ("0", "0", "0", "q2"), ("0", "0", "d3", "0"), ("0", "0", "0", "q4")]
    )
    turn = "q1 + q2 + q4"
    pose = [
        [f"cos({turn})", f"-sin({turn})", "0", "0"],
        [f"sin({turn})", f"cos({turn})", "0", "0"],
        ["0", "0", "1", "d3"],
        list("0001"),
    ]
    parts = graded(scara, table=bare, pose=pose)
    assert parts["table"].points >= 4
    assert not parts["pose"].follow_through
    assert parts["pose"].points <= 4
