"""Test slips that were made before the answer."""

from collections.abc import Mapping

import pytest
from dh_grader.catalogue import Exercise
from dh_grader.grading.diagnosis.slips_of_the_table import axis_direction
from dh_grader.grading.numbers import draw

from tests.pose_slips.unseen.algebra import STANDARD, Table
from tests.pose_slips.unseen.arms import NONE, Arm
from tests.pose_slips.unseen.slips import ArmSlip
from tests.pose_slips.unseen.trials import answer_to, exercise_of, loaded, said_of

# --- Say where an axis points only if no earlier joint turns the axis


@pytest.mark.parametrize(
    ("name", "joint", "words"),
    [
        ("planar-rrr", 3, "Its axis points along z0."),
        # After two turns about z0, the axes of the SCARA arm still point down.
        ("scara", 3, "Its axis points opposite to z0."),
        # Joint 3 slides along z0 at home, but the joints before it turn its axis.
        ("stanford-arm", 3, "Check which way its axis points."),
        ("spherical-wrist", 6, "Check which way its axis points."),
        ("spherical-wrist", 4, "Its axis points along z3."),
    ],
)
def test_the_direction_is_true_in_every_position(
    name: str, joint: int, words: str, catalogue: Mapping[str, Exercise]
) -> None:
    exercise = catalogue[name]
    direction = axis_direction(exercise, draw(exercise, "").subset(1))
    [found] = [each for each in exercise.joints if each.index == joint]
    assert str(direction(found)) == words


# --- Test slips that change all link transforms of an answer

UP, DOWN = {"": 1.0}, {"": -1.0}
ROWS = (
    (NONE, DOWN, {"d1": 1.0}, {"q1": 1.0}),
    ({"a2": 1.0}, UP, NONE, {"q2": 1.0}),
    ({"a3": 1.0}, NONE, {"d3": 1.0}, {"q3": 1.0}),
)
ARM = Arm(ROWS, "RRR", STANDARD)
EXERCISE = exercise_of(ARM)
NEGATED = (
    (NONE, UP, *ROWS[0][2:]),
    (*ROWS[1][:1], DOWN, *ROWS[1][2:]),
    ROWS[2],
)


def said(table: Table, convention: str = STANDARD) -> tuple[tuple[str, str], ...]:
    slip = ArmSlip("", frozenset(), table, convention, tuple(range(len(table))))
    return said_of(EXERCISE, "links", answer_to("links", slip))


@pytest.mark.parametrize(
    ("table", "convention", "code", "words"),
    [
        (NEGATED, STANDARD, "parameter_sign", "α has the wrong sign throughout: "),
        (
            (ROWS[2], ROWS[1], ROWS[0]),
            STANDARD,
            "row_order",
            "Rows 1 and 3, or their link transforms, are exchanged: ",
        ),
        (
            ROWS,
            "modified",
            "other_convention",
            (
                "The link transform of the modified convention is used with a table of the "
                "standard one: use the same convention for both."
            ),
        ),
    ],
)
def test_a_slip_in_all_links_gets_one_message(
    table: Table, convention: str, code: str, words: str
) -> None:
    [(found, message)] = said(table, convention)
    assert found == code
    assert message.startswith(words)


def test_one_wrong_link_has_the_slip_of_its_row() -> None:
    [(code, message)] = said((ROWS[0], (*ROWS[1][:1], DOWN, *ROWS[1][2:]), ROWS[2]))
    assert code == "sign"
    assert message.startswith("α, the twist between the axes of joints 2 and 3, has the wrong sign")


def test_a_slip_in_the_frames_of_the_exercise_is_named_if_frames_are_free() -> None:
    # Other frames may fit these matrices better, but the student used the exercise's frames.
    free = ARM.text.replace('id = "links"\n', 'id = "links"\nframes = "free"\n')
    slip = ArmSlip("", frozenset(), (ROWS[1], ROWS[0], ROWS[2]), STANDARD, (0, 1, 2))
    [(code, _)] = said_of(loaded(free), "links", answer_to("links", slip))
    assert code == "row_order"
    right = ArmSlip("", frozenset(), ROWS, STANDARD, (0, 1, 2))
    assert said_of(loaded(free), "links", answer_to("links", right)) == ()
