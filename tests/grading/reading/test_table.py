"""Read tables with empty cells and dashes."""

from collections.abc import Mapping
from dataclasses import replace

import pytest
from dh_grader.catalogue import Exercise
from dh_grader.catalogue.kinds import DhTableSpec
from dh_grader.grading import PartReport, Verdict
from dh_grader.grading.numbers import draw
from dh_grader.grading.reading.entries import Reader
from dh_grader.grading.reading.table import read_table

from tests.grading.support.submitting import full_marks, handed_in, not_correct, part, table

SCARA = [
    ("a1", "0", "0", "theta1"),
    ("a2", "180deg", "0", "theta2"),
    ("0", "0", "d3", "0"),
    ("0", "0", "d4", "theta4"),
]
LABELS = ("a", "alpha", "d", "theta")
ZEROS = {
    (str(i + 1), LABELS[j])
    for i, row in enumerate(SCARA)
    for j, cell in enumerate(row)
    if cell == "0"
}
SIGNS = ("", " ", "-", "–", "—", "−")


def with_empty(sign: str) -> list[tuple[str, ...]]:
    return [tuple(sign if cell == "0" else cell for cell in row) for row in SCARA]


def graded(exercise: Exercise, answer: object) -> PartReport:
    return part(handed_in(exercise, {"table": answer}), "table")


def as_zero(exercise: Exercise) -> Exercise:
    parts = tuple(
        each.model_copy(update={"empty_cells": "zero"}) if isinstance(each, DhTableSpec) else each
        for each in exercise.parts
    )
    return replace(exercise, parts=parts)


@pytest.mark.parametrize("sign", SIGNS)
def test_empty_cells_get_one_message_for_the_table(
    catalogue: Mapping[str, Exercise], sign: str
) -> None:
    rows = with_empty(sign)
    pasted = "\n".join(["a,alpha,d,theta", *(",".join(row) for row in rows)])
    for answer in (table(rows), pasted):
        report = graded(catalogue["scara"], answer)
        assert not_correct(report) == dict.fromkeys(ZEROS, Verdict.MISSING)
        [message] = report.feedback
        assert message.code == "missing"
        assert message.suggestion is None
        assert {(place.row, place.cell) for place in message.places or ()} == ZEROS
        assert not any(cell.feedback for row in report.rows for cell in row.cells)


def test_blanks_and_dashes_in_one_table_are_one_slip(catalogue: Mapping[str, Exercise]) -> None:
    rows = [*with_empty("-")[:2], *with_empty("")[2:]]
    assert [message.code for message in graded(catalogue["scara"], table(rows)).feedback] == [
        "missing"
    ]


@pytest.mark.parametrize("sign", SIGNS)
def test_empty_cells_are_0_if_the_exercise_says_so(
    catalogue: Mapping[str, Exercise], sign: str
) -> None:
    report = graded(as_zero(catalogue["scara"]), table(with_empty(sign)))
    assert full_marks(report)
    assert [(message.code, str(message.severity)) for message in report.feedback] == [
        ("empty_cells", "info")
    ]


def test_0_where_the_joint_variable_belongs_is_wrong(catalogue: Mapping[str, Exercise]) -> None:
    rows = [*SCARA[:3], ("0", "0", "d4", "")]
    report = graded(as_zero(catalogue["scara"]), table(rows))
    assert not_correct(report) == {("4", "theta"): Verdict.INCORRECT}


def test_an_empty_row_is_not_a_row_of_zeros(catalogue: Mapping[str, Exercise]) -> None:
    rows = [*SCARA[:3], ("", "", "-", "")]
    report = graded(as_zero(catalogue["scara"]), table(rows))
    assert set(not_correct(report).values()) == {Verdict.MISSING}
    empty = part(handed_in(as_zero(catalogue["scara"]), {"table": table([("",) * 4] * 4)}), "table")
    assert empty.points == 0


PARAMETERS = {
    label: [row[j] for row in SCARA] for j, label in enumerate(("a", "alpha", "d", "theta"))
}


def test_parameters_in_rows(catalogue: Mapping[str, Exercise]) -> None:
    lines = [[label, *cells] for label, cells in PARAMETERS.items()]
    numbered = [["joint", "1", "2", "3", "4"], *reversed(lines)]
    for rows in (lines, numbered):
        for pasted in ("\n".join(",".join(row) for row in rows), "\n".join(map("\t".join, rows))):
            report = graded(catalogue["scara"], pasted)
            assert full_marks(report)
            assert [message.code for message in report.feedback] == ["parameters_in_rows"]
        assert full_marks(graded(catalogue["scara"], rows))
        assert full_marks(graded(catalogue["scara"], {"rows": rows}))


def test_a_table_may_have_a_list_for_each_parameter(catalogue: Mapping[str, Exercise]) -> None:
    assert full_marks(graded(catalogue["scara"], PARAMETERS))
    greek = dict(zip(("θ_i", "d_i", "α_i", "a_i"), reversed(PARAMETERS.values()), strict=True))
    assert full_marks(graded(catalogue["scara"], greek))


@pytest.mark.parametrize(
    "answer",
    [
        {**PARAMETERS, "d": ["0"]},
        {"a": [], "alpha": [], "d": [], "theta": []},
        {name: cells for name, cells in PARAMETERS.items() if name != "d"},
        [["a", "a1"], ["alpha", "0", "0"], ["d", "0"], ["theta", "theta1"]],
    ],
)
def test_lists_of_other_shapes_are_not_tables(
    catalogue: Mapping[str, Exercise], answer: object
) -> None:
    report = graded(catalogue["scara"], answer)
    assert report.points == 0


def test_only_the_first_row_of_a_long_table_is_read_twice(
    catalogue: Mapping[str, Exercise],
) -> None:
    # The first row is read twice, because it might be a row of headers.
    exercise = catalogue["planar-rrr"]
    for cell, rows in (("q1", 3), ("q1" + "+0" * 60, 2)):
        reader = Reader.of(exercise, draw(exercise, cell), "degrees")
        table = read_table("\n".join([", ".join([cell] * 4)] * 3), reader)
        assert len(table.rows) == 3
        assert table.reread is not None
        again = table.reread(("alpha", "a", "theta", "d"))
        readable = [row for row in again.rows if row.entries[3].readable]
        assert len(readable) == rows
