"""Read the cells of a table."""

from collections.abc import Mapping
from typing import Any

import pytest
from dh_grader.catalogue import Exercise
from dh_grader.expressions import AngleUnit
from dh_grader.grading.numbers import draw
from dh_grader.grading.reading import table_cells as reading_cells
from dh_grader.grading.reading.entries import Entry, Reader
from dh_grader.grading.reading.table_cells import canonical_table, memoized_row, read_row
from dh_grader.grading.report import Finding, WorkBudget

from tests.grading.support.submitting import table

# Craig, Introduction to Robotics, the planar two-link arm in the standard convention.
ROWS: list[list[Any]] = [["l1", "0", "0", "q1"], ["l2", 0, "0", "q2"]]
TABLE = table(ROWS)


def named(keys: str, rows: list[list[Any]]) -> list[dict[str, Any]]:
    return [dict(zip(keys.split("|"), row, strict=True)) for row in rows]


@pytest.mark.parametrize(
    "answer",
    [
        TABLE,
        TABLE["rows"],
        ROWS,
        {"rows": ROWS},
        [("a", "alpha", "d", "theta"), *ROWS][1:],
        [["a", "alpha", "d", "theta"], *ROWS],
        [["i", "a_i", "α_i", "d_i", "θ_i"], *([i + 1, *row] for i, row in enumerate(ROWS))],
        [["theta", "d", "a", "alpha"], *([r[3], r[2], r[0], r[1]] for r in ROWS)],
        [["1", *ROWS[0]], ["2", *ROWS[1]]],
        [[2, *ROWS[1]], [1, *ROWS[0]]],
        named("a|α|d|θ", ROWS),
        named("A|Alpha|D|Theta", ROWS),
        named("a_i|alpha_i|d_i|theta_i", ROWS),
        named("a_{i-1}|α_{i-1}|d_i|θ_i", ROWS),
        named("link length|twist|offset|joint angle", ROWS),
        named("link_length|link_twist|link_offset|joint_angle", ROWS),
        named("r|alpha|d|theta", ROWS),
        named(r"$a_i$|$\alpha_i$|$d_i$|$\theta_i$", ROWS),
        {"rows": named("a|α|d|θ", ROWS)},
        [{"joint": 2, "type": "R", **TABLE["rows"][1]}, {"joint": 1, **TABLE["rows"][0]}],
        [{"note": "base", **TABLE["rows"][0]}, {"why": "?", **TABLE["rows"][1]}],
    ],
)
def test_a_table_in_each_shape_is_converted(answer: object) -> None:
    assert canonical_table(answer) == TABLE


def test_fields_besides_the_rows_are_kept() -> None:
    answer = {"rows": ROWS, "convention": "modified"}
    assert canonical_table(answer) == {**TABLE, "convention": "modified"}


def test_the_canonical_answer_is_not_copied() -> None:
    assert canonical_table(TABLE) is TABLE


@pytest.mark.parametrize(
    "answer",
    [
        None, 1, True, "a,alpha,d,theta\n0,0,0,q1", {}, [], ["0", "0", "0", "q1"], [[]], [{}],
        {"rows": "0,0,0,q1"}, {"rows": 3}, {"rows": []}, {"table": ROWS}, ["0,0,0,q1"], [None],
        [["1", *"0000"]] * 2, [["l1", *"0000"]],
        [[["1", "0", "0", "0"]] * 4] * 2, [{"x": 1, "y": 2}], [["1", "2", "3"]], [["0"] * 5],
        {"a": "l1", "alpha": 0, "d": 0, "theta": "q1"},
    ],
)  # fmt: skip
def test_an_answer_that_is_not_a_table_is_unchanged(answer: object) -> None:
    assert canonical_table(answer) == answer


@pytest.mark.parametrize(
    "row",
    [
        ["l2", "0", "0"],
        ["l2", "0", "0", "q2", "0"],
        [["l2"], "0", "0", "q2"],
        None,
        "l2, 0, 0, q2",
        # Two keys for one column; and a unit, which a canonical cell cannot have.
        {"a": "l2", "α": 0, "alpha": "pi", "d": 0, "theta": "q2"},
        {"a": "l2", "alpha (deg)": 90, "d": 0, "theta": "q2"},
        {"a [mm]": 300, "alpha": 0, "d": 0, "theta": "q2"},
    ],
)
def test_an_ambiguous_row_affects_only_itself(row: object) -> None:
    assert canonical_table([ROWS[0], row]) == {"rows": [TABLE["rows"][0], row]}
    assert canonical_table({"rows": [ROWS[0], row]}) == {"rows": [TABLE["rows"][0], row]}


def test_an_omitted_column_stays_omitted() -> None:
    assert canonical_table([{"α": 0, "d": "d1"}]) == {"rows": [{"alpha": 0, "d": "d1"}]}


def test_the_tool_row_comes_last() -> None:
    tool = {"i": "e", "a": "l3", "alpha": 0, "d": 0, "theta": 0}
    first = {"i": "1", **TABLE["rows"][0]}
    expected = {"rows": [TABLE["rows"][0], {"a": "l3", "alpha": 0, "d": 0, "theta": 0}]}
    assert canonical_table([tool, first]) == expected


@pytest.mark.parametrize("labels", [(1, 1), (2, "x"), ("", 1), (2, None)])
def test_labels_without_an_order_leave_the_rows_unchanged(labels: tuple[object, object]) -> None:
    rows = [{"i": label, **row} for label, row in zip(labels, TABLE["rows"], strict=True)]
    assert canonical_table(rows) == TABLE


def test_a_single_row_of_names_is_a_row() -> None:
    # If a and d are declared lengths, the only row of a table may look like headers.
    assert canonical_table([["a", "alpha", "d", "theta"]]) == table([["a", "alpha", "d", "theta"]])


def test_too_many_rows_are_still_counted() -> None:
    found = canonical_table([ROWS[0]] * 500)
    assert isinstance(found, dict)
    assert len(found["rows"]) == 500


def test_only_the_first_names_of_a_body_are_read(monkeypatch: pytest.MonkeyPatch) -> None:
    # Each name costs about ten microseconds, and a request may have tens of thousands of names.
    read: list[str] = []
    monkeypatch.setattr(reading_cells, "read_header", read.append)
    canonical_table([{f"α_{i}_{j}": 0 for j in range(200)} for i in range(50)])
    assert 4 < len(read) < 100


def test_a_number_of_any_length_raises_nothing() -> None:
    # Python raises an error if an integer of more than 4,300 digits is converted to text.
    rows = [{"i": 10**5000, "a": 0, "alpha": 0, "d": 0, "theta": "q1"}]
    assert canonical_table(rows) == {"rows": [{"a": 0, "alpha": 0, "d": 0, "theta": "q1"}]}


# Memoized rows have the same entries and the same cost as rows that are read.

ROW = ("0", " -90", "d2 + 1", "theta2")


@pytest.fixture
def exercise(catalogue: Mapping[str, Exercise]) -> Exercise:
    return catalogue["stanford-arm"]


def reader_of(exercise: Exercise, unit: AngleUnit = "radians", symbols: int = 100) -> Reader:
    samples = draw(exercise, {})
    budget = WorkBudget(symbols=symbols)
    return Reader(exercise.vocabulary, samples, unit, "m", budget)


def told(entry: Entry) -> tuple[str, tuple[Finding, ...]]:
    assert entry.expression is not None
    return entry.expression.text(), entry.findings


@pytest.mark.parametrize("unit", ["radians", "degrees"])
def test_a_memoized_row_is_the_one_that_is_read(exercise: Exercise, unit: AngleUnit) -> None:
    fresh, remembering = reader_of(exercise, unit), reader_of(exercise, unit)
    expected = read_row(ROW, 2, fresh)
    for _ in range(2):
        remembering.budget.symbols = 100
        found = memoized_row(ROW, remembering)
        assert found is not None
        assert list(map(told, found)) == list(map(told, expected))
        assert remembering.budget == fresh.budget


def test_the_memo_distinguishes_units(exercise: Exercise) -> None:
    inner = memoized_row(("0", "90", "0", "0"), reader_of(exercise))
    degrees = memoized_row(("0", "90", "0", "0"), reader_of(exercise, "degrees"))
    assert inner is not None
    assert degrees is not None
    assert told(inner[1]) != told(degrees[1])


@pytest.mark.parametrize(
    "cells",
    [
        ("0", "-90deg", "(d2", "theta2"),
        ("0", "-90deg", "", "theta2"),
        ("0", "-90deg", None, "theta2"),
        (0, "-90deg", "d2", "theta2"),
        ("0", "-90deg", "theta9", "theta2"),
        ("0", "-90deg", " " * 90 + "d2", "theta2"),
        ("0", "-90deg", "d2", "theta_1 = theta2"),  # right in one row, wrong in another
    ],
)
def test_long_named_or_unreadable_rows_are_not_memoized(
    exercise: Exercise, cells: tuple[object, ...]
) -> None:
    reader = reader_of(exercise)
    for _ in range(2):
        assert memoized_row(cells, reader) is None
        assert reader.budget == WorkBudget(symbols=100)


def test_the_memo_has_no_row_beyond_the_budget(exercise: Exercise) -> None:
    assert memoized_row(ROW, reader_of(exercise)) is not None
    short = reader_of(exercise, symbols=3)
    assert memoized_row(ROW, short) is None
    assert short.budget.symbols == 3
