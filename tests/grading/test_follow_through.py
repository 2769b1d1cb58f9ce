"""Marks for what follows from an earlier answer."""

from collections.abc import Callable

import pytest

from service.catalogue import Exercise
from tests.grading.support.scara import (
    A1,
    A3,
    A4,
    IDENTITY,
    LINKS,
    SCARA,
    TABLE,
    a2_with,
    graded,
    pose_with,
    table,
)


@pytest.fixture
def scara(make_exercise: Callable[[str], Exercise]) -> Exercise:
    return make_exercise(SCARA)


def test_matrices_that_follow_from_a_wrong_table_earn_their_points(scara: Exercise) -> None:
    wrong = table([TABLE[0], ("a1", "pi", "0", "q2"), *TABLE[2:]])
    links = [A1, a2_with("a1"), A3, A4]
    position = ["a1*c1 + a1*c12", "a1*s1 + a1*s12", "-d3 - d4"]
    parts = graded(scara, table=wrong, links=links, pose=pose_with("a1"), position=position)
    # One of the four cells that one has to know is wrong; each row is worth a fifth besides.
    assert parts["table"].points == pytest.approx(8 * 3.8 / 4.8, abs=1e-5)
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
    assert parts["pose"].points < 8
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
    assert parts["table"].points == pytest.approx(8 * 0.8 / 4.8, abs=1e-5)
    assert not parts["pose"].follow_through
    assert parts["pose"].points <= 4
