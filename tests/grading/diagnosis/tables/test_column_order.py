"""Recognise tables whose columns are in an unexpected order."""

from collections.abc import Mapping, Sequence
from itertools import permutations

import pytest
from dh_grader.catalogue import Exercise
from dh_grader.grading import PartReport
from dh_grader.grading.report import messages_of

from tests.grading.support.submitting import handed_in, part

SYMBOLS = ("a", "α", "d", "θ")
SCARA = [
    ("a1", "0", "0", "theta1"),
    ("a2", "180deg", "0", "theta2"),
    ("0", "0", "d3", "0"),
    ("0", "0", "d4", "theta4"),
]
# Its columns can be told apart only by joint variables and angles.
RRRP = [
    ("l2", "0", "l1", "q1"),
    ("l3", "180deg", "0", "q2"),
    ("0", "0", "l4", "q3"),
    ("0", "0", "q4", "0"),
]
BAXTER = [
    ("0.069", "-90deg", "0.27035", "theta1"),
    ("0", "90deg", "0", "theta2 + 90deg"),
    ("0.069", "-90deg", "0.36435", "theta3"),
    ("0", "90deg", "0", "theta4"),
    ("0.010", "-90deg", "0.37429", "theta5"),
    ("0", "90deg", "0", "theta6"),
    ("0", "0", "0.229525", "theta7"),
]
TOOLBOX, CRAIG, WIKIPEDIA = (3, 2, 0, 1), (1, 0, 2, 3), (2, 3, 0, 1)
LAST = [[0, 0, 1, 0], [0, 0, 0, 1]]


def in_order(rows: Sequence[Sequence[str]], order: Sequence[int]) -> list[list[str]]:
    return [[row[column] for column in order] for row in rows]


def graded(exercise: Exercise, answer: object) -> PartReport:
    return part(handed_in(exercise, {"table": answer}), "table")


def error_codes(report: PartReport) -> list[str]:
    return [message.code for message, _, _ in messages_of(report) if message.severity == "error"]


@pytest.mark.parametrize("order", [TOOLBOX, CRAIG])
@pytest.mark.parametrize(
    ("name", "rows"), [("scara", SCARA), ("rrrp", RRRP), ("baxter-left-arm", BAXTER)]
)
def test_the_column_orders_of_other_books_are_named(
    catalogue: Mapping[str, Exercise],
    name: str,
    rows: Sequence[Sequence[str]],
    order: Sequence[int],
) -> None:
    written = in_order(rows, order)
    pasted = "\n".join(", ".join(row) for row in written)
    for answer in (
        written,
        {"rows": written},
        pasted,
        [[i + 1, *r] for i, r in enumerate(written)],
    ):
        report = graded(catalogue[name], answer)
        assert error_codes(report) == ["columns_permuted"]
        assert report.points == 0.75 * report.max_points
        [message] = [each for each in report.feedback if each.code == "columns_permuted"]
        assert f"the order {', '.join(SYMBOLS[column] for column in order)}." in message.message
        # The note that the columns were read as a, α, d, θ would contradict the message.
        assert [each.code for each in report.feedback].count("column_order") == 0


@pytest.mark.parametrize("order", [WIKIPEDIA, (2, 3, 1, 0)])
def test_the_order_that_leaves_nothing_wrong_is_named(
    order: Sequence[int], catalogue: Mapping[str, Exercise]
) -> None:
    """The only length is in the first column, which may be a or d."""
    rows = [
        ("0", "-90deg", "0", "theta4"),
        ("0", "90deg", "0", "theta5"),
        ("0", "0", "d6", "theta6"),
    ]
    report = graded(catalogue["spherical-wrist"], in_order(rows, order))
    assert error_codes(report) == ["columns_permuted"]
    assert report.points == 0.75 * report.max_points


@pytest.mark.parametrize("order", [order for order in permutations(range(4)) if order[3] != 3])
def test_every_order_with_moved_angles_is_named(
    catalogue: Mapping[str, Exercise], order: tuple[int, ...]
) -> None:
    report = graded(catalogue["rrrp"], in_order(RRRP, order))
    assert error_codes(report) in (["columns_permuted"], ["columns_swapped"])
    assert report.points == 0.75 * report.max_points


def test_another_slip_is_named_in_its_own_column(catalogue: Mapping[str, Exercise]) -> None:
    rows = [list(row) for row in BAXTER]
    rows[2][1] = "90deg"
    report = graded(catalogue["baxter-left-arm"], in_order(rows, TOOLBOX))
    assert sorted(error_codes(report)) == ["columns_permuted", "sign"]
    assert report.points < 0.75 * report.max_points


@pytest.mark.parametrize("order", [TOOLBOX, CRAIG, (0, 1, 3, 2), (3, 0, 1, 2), (0, 3, 1, 2)])
def test_cells_under_wrong_headers_get_one_message(
    catalogue: Mapping[str, Exercise], order: Sequence[int]
) -> None:
    names = ("a", "alpha", "d", "theta")
    rows = [dict(zip(names, row, strict=True)) for row in in_order(SCARA, order)]
    report = graded(catalogue["scara"], {"rows": rows})
    assert error_codes(report) == ["columns_permuted"]
    assert report.points == 0.75 * report.max_points
    [message] = report.feedback
    written = ", ".join(SYMBOLS[column] for column in order)
    assert message.message == (
        f"The columns stand in the order {written}. Write each parameter under its own header: a, "
        "α, d, θ."
    )


def test_one_wrong_cell_is_no_other_column_order(catalogue: Mapping[str, Exercise]) -> None:
    assert error_codes(graded(catalogue["scara"], in_order(SCARA, range(4)))) == []
    rows = [list(row) for row in SCARA]
    rows[1][1] = "0"
    assert "columns_permuted" not in error_codes(graded(catalogue["scara"], rows))
    names = ("a", "alpha", "d", "theta")
    typed = [dict(zip(names, row, strict=True)) for row in rows]
    assert error_codes(graded(catalogue["scara"], {"rows": typed})) == ["half_turn"]


def test_the_links_follow_from_the_intended_table(
    catalogue: Mapping[str, Exercise],
) -> None:
    # The last link has L1 for L2: another slip, which is repeated in the links.
    rows = in_order(
        [("R", "90deg", "0", "theta1"), *(("L1", "0", "0", f"theta{i}") for i in (2, 3))], TOOLBOX
    )
    links = [
        [["c1", 0, "s1", "R c1"], ["s1", 0, "-c1", "R s1"], [0, 1, 0, 0], LAST[1]],
        *(
            [[f"c{i}", f"-s{i}", 0, f"L1 c{i}"], [f"s{i}", f"c{i}", 0, f"L1 s{i}"], *LAST]
            for i in (2, 3)
        ),
    ]
    report = handed_in(catalogue["spatial-rrr"], {"table": rows, "links": links})
    assert "columns_permuted" in error_codes(part(report, "table"))
    follows = part(report, "links")
    assert follows.follow_through
    assert follows.points == follows.max_points
