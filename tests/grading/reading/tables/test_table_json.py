"""The JSON shapes that people send tables in."""

from typing import Any

import pytest

from service.grading.reading.tables import table_json
from service.grading.reading.tables.table_json import canonical_table
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
def test_a_table_in_each_shape(answer: object) -> None:
    assert canonical_table(answer) == TABLE


def test_what_is_said_besides_the_rows_stays() -> None:
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
def test_what_is_no_table_is_left_alone(answer: object) -> None:
    assert canonical_table(answer) == answer


@pytest.mark.parametrize(
    "row",
    [
        ["l2", "0", "0"],
        ["l2", "0", "0", "q2", "0"],
        [["l2"], "0", "0", "q2"],
        None,
        "l2, 0, 0, q2",
        # Two of one column; and a unit, which a cell of the canonical form could not carry.
        {"a": "l2", "α": 0, "alpha": "pi", "d": 0, "theta": "q2"},
        {"a": "l2", "alpha (deg)": 90, "d": 0, "theta": "q2"},
        {"a [mm]": 300, "alpha": 0, "d": 0, "theta": "q2"},
    ],
)
def test_a_row_that_cannot_be_told_costs_only_itself(row: object) -> None:
    assert canonical_table([ROWS[0], row]) == {"rows": [TABLE["rows"][0], row]}
    assert canonical_table({"rows": [ROWS[0], row]}) == {"rows": [TABLE["rows"][0], row]}


def test_a_column_left_out_is_left_out() -> None:
    assert canonical_table([{"α": 0, "d": "d1"}]) == {"rows": [{"alpha": 0, "d": "d1"}]}


def test_the_tool_row_comes_last() -> None:
    tool = {"i": "e", "a": "l3", "alpha": 0, "d": 0, "theta": 0}
    first = {"i": "1", **TABLE["rows"][0]}
    expected = {"rows": [TABLE["rows"][0], {"a": "l3", "alpha": 0, "d": 0, "theta": 0}]}
    assert canonical_table([tool, first]) == expected


@pytest.mark.parametrize("labels", [(1, 1), (2, "x"), ("", 1), (2, None)])
def test_labels_that_give_no_order_leave_it_alone(labels: tuple[object, object]) -> None:
    rows = [{"i": label, **row} for label, row in zip(labels, TABLE["rows"], strict=True)]
    assert canonical_table(rows) == TABLE


def test_a_row_of_names_alone_is_a_row() -> None:
    """Where a and d are lengths, the one row of a link transform reads like headers."""
    assert canonical_table([["a", "alpha", "d", "theta"]]) == table([["a", "alpha", "d", "theta"]])


def test_too_many_rows_are_still_counted() -> None:
    found = canonical_table([ROWS[0]] * 500)
    assert isinstance(found, dict)
    assert len(found["rows"]) == 500


def test_of_a_body_full_of_names_few_are_understood(monkeypatch: pytest.MonkeyPatch) -> None:
    """Each costs some ten microseconds, and a body has room for tens of thousands."""
    read: list[str] = []
    monkeypatch.setattr(table_json, "read_header", read.append)
    canonical_table([{f"α_{i}_{j}": 0 for j in range(200)} for i in range(50)])
    assert 4 < len(read) < 100


def test_a_number_of_any_length_raises_nothing() -> None:
    """Python refuses to write out an integer of more than 4,300 digits."""
    rows = [{"i": 10**5000, "a": 0, "alpha": 0, "d": 0, "theta": "q1"}]
    assert canonical_table(rows) == {"rows": [{"a": 0, "alpha": 0, "d": 0, "theta": "q1"}]}
