"""A wrong pose reveals a wrong row or column of the table it was computed from."""

import pytest

from tests.pose_slips.unseen.algebra import STANDARD, Table
from tests.pose_slips.unseen.arms import NONE, Arm
from tests.pose_slips.unseen.slips import ArmSlip
from tests.pose_slips.unseen.trials import answer_to, exercise_of, said_of

UP, DOWN = {"": 1.0}, {"": -1.0}
ROW1 = (NONE, DOWN, {"d1": 1.0}, {"q1": 1.0})
ROW2 = ({"a2": 1.0}, UP, {"d2": 1.0}, {"q2": 1.0})
ROW3 = ({"a3": 1.0}, NONE, NONE, {"q3": 1.0})
ROW4 = ({"a4": 1.0}, UP, {"d4": 1.0}, {"q4": 1.0})
ARM = Arm((ROW1, ROW2, ROW3, ROW4), "RRRR", STANDARD)
EXERCISE = exercise_of(ARM)


def said(table: Table, kind: str = "transform", arm: Arm = ARM) -> tuple[tuple[str, str], ...]:
    slip = ArmSlip("", frozenset(), table, arm.convention, tuple(range(len(table))))
    exercise = EXERCISE if arm is ARM else exercise_of(arm)
    return said_of(exercise, kind, answer_to(kind, slip))


@pytest.mark.parametrize(
    ("table", "code", "words"),
    [
        (
            ((ROW1[2], DOWN, NONE, ROW1[3]), ROW2, ROW3, ROW4),
            "columns_swapped",
            (
                "The length a and the offset d are exchanged in row 1: a is measured along x, d "
                "along z."
            ),
        ),
        (
            tuple((d, alpha, a, theta) for a, alpha, d, theta in ARM.table),
            "columns_swapped",
            (
                "The lengths a and the offsets d are exchanged throughout: a is measured along "
                "x, d along z."
            ),
        ),
        (
            ((NONE, UP, *ROW1[2:]), (ROW2[0], DOWN, *ROW2[2:]), ROW3, (ROW4[0], DOWN, *ROW4[2:])),
            "parameter_sign",
            (
                "α has the wrong sign throughout: it is measured about x, positive by the "
                "right-hand rule."
            ),
        ),
        (
            (
                (NONE, NONE, *ROW1[2:]),
                (*ROW1[:2], *ROW2[2:]),
                (*ROW2[:2], *ROW3[2:]),
                (*ROW3[:2], *ROW4[2:]),
                (*ROW4[:2], NONE, NONE),
            ),
            "other_convention",
            (
                "A table of the modified convention is multiplied with the link transform of the "
                "standard one: use the same convention for both."
            ),
        ),
        (
            (ROW1, ROW4, ROW3, ROW2),
            "row_order",
            (
                "Rows 2 and 4, or their link transforms, are exchanged: check which joint each "
                "row of the table belongs to."
            ),
        ),
        (
            (ROW1, (*ROW4[:3], ROW2[3]), ROW3, (*ROW2[:3], ROW4[3])),
            "row_order",
            (
                "Rows 2 and 4 are exchanged, but for their joint variables: check which joint "
                "each row of the table belongs to."
            ),
        ),
    ],
)
def test_the_slip_is_named(table: Table, code: str, words: str) -> None:
    assert said(table) == ((code, words),)


def test_a_standard_table_in_a_modified_product_is_named() -> None:
    first = (NONE, NONE, *ROW1[2:])
    last = ({"a3": 1.0}, NONE, NONE, NONE)
    rows = (first, (NONE, DOWN, *ROW2[2:]), (*ROW2[:2], *ROW3[2:]), last)
    standard = ((NONE, DOWN, *ROW1[2:]), ROW2, ROW3)
    [(code, words)] = said(standard, arm=Arm(rows, "RRR", "modified"))
    assert code == "other_convention"
    assert words.startswith("A table of the standard convention is multiplied with the link")


def test_exchanged_rows_are_no_missing_link() -> None:
    # The last length is 0, so the position does not show an exchange of rows 3 and 4.
    wrist = (ROW1, ROW2, (NONE, UP, {"d3": 1.0}, {"q3": 1.0}), (NONE, NONE, NONE, {"q4": 1.0}))
    arm = Arm(wrist, "RRRR", STANDARD)
    [(code, words)] = said((wrist[0], wrist[2], wrist[1], wrist[3]), "position", arm)
    assert code == "row_order"
    assert "Rows 2 and 3, or their link transforms, are exchanged" in words


def test_a_missing_link_is_named() -> None:
    [(code, words)] = said((ROW1, ROW2, ROW4))
    assert (code, words) == (
        "missing_link",
        (
            "This matrix is the product without A3. Check that each row of the table takes part "
            "in the product."
        ),
    )


def test_exchanged_rows_and_a_missing_link_are_both_named_if_both_fit() -> None:
    # Row 3 only turns: without A3, the position is the same as with rows 3 and 4 exchanged.
    rows = (ROW1, ROW2, (NONE, UP, NONE, {"q3": 1.0}), ROW4)
    [(code, words)] = said((*rows[:2], ROW4), "position", Arm(rows, "RRRR", STANDARD))
    assert (code, words) == (
        "row_order",
        (
            "One of these slips explains it: rows 3 and 4, or their link transforms, are "
            "exchanged; or A3 is missing in the product. Check each of them."
        ),
    )


def test_exchanged_lengths_and_columns_are_both_named_if_both_fit() -> None:
    [(code, words)] = said((ROW1, (ROW2[2], UP, ROW2[0], ROW2[3]), ROW3, ROW4))
    assert (code, words) == (
        "columns_swapped",
        (
            "One of these slips explains it: the length a and the offset d are exchanged in row "
            "2; or the lengths a2 and d2 are exchanged. Check each of them."
        ),
    )


def test_the_two_axes_are_named() -> None:
    turned = (ROW1, (ROW2[0], NONE, *ROW2[2:]), ROW3, ROW4)
    [(code, words)] = said(turned)
    assert code == "quarter_turn"
    assert words.endswith("is not right: compare z1 and z2 in the home position.")
