"""Memoized rows have the same entries and the same cost as rows that are read."""

from collections.abc import Mapping

import pytest

from service.catalogue import Exercise
from service.expressions import AngleUnit
from service.grading.feedback import Finding
from service.grading.numerics.samples import draw
from service.grading.reading.entry import Entry, Reader
from service.grading.reading.tables.row_entries import memoized_row, read_row
from service.grading.work_budget import WorkBudget

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
        found = memoized_row(ROW, 2, remembering)
        assert found is not None
        assert list(map(told, found)) == list(map(told, expected))
        assert remembering.budget == fresh.budget


def test_the_memo_distinguishes_units_and_row_numbers(exercise: Exercise) -> None:
    inner = memoized_row(("0", "90", "0", "0"), 2, reader_of(exercise))
    degrees = memoized_row(("0", "90", "0", "0"), 2, reader_of(exercise, "degrees"))
    assert inner is not None
    assert degrees is not None
    assert told(inner[1]) != told(degrees[1])
    assert memoized_row(("0", "0", "0", "theta_1 = 5"), 1, reader_of(exercise)) is not None
    assert memoized_row(("0", "0", "0", "theta_1 = 5"), 2, reader_of(exercise)) is None


@pytest.mark.parametrize(
    "cells",
    [
        ("0", "-90deg", "(d2", "theta2"),
        ("0", "-90deg", "", "theta2"),
        ("0", "-90deg", None, "theta2"),
        (0, "-90deg", "d2", "theta2"),
        ("0", "-90deg", "theta9", "theta2"),
        ("0", "-90deg", " " * 90 + "d2", "theta2"),
    ],
)
def test_long_or_unreadable_rows_are_not_memoized(
    exercise: Exercise, cells: tuple[object, ...]
) -> None:
    reader = reader_of(exercise)
    for _ in range(2):
        assert memoized_row(cells, 2, reader) is None
        assert reader.budget == WorkBudget(symbols=100)


def test_the_memo_has_no_row_beyond_the_budget(exercise: Exercise) -> None:
    assert memoized_row(ROW, 2, reader_of(exercise)) is not None
    short = reader_of(exercise, symbols=3)
    assert memoized_row(ROW, 2, short) is None
    assert short.budget.symbols == 3
