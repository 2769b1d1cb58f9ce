"""The formulas of a table have the same values as a numeric computation."""

from collections.abc import Iterable

import numpy as np
import pytest
from dh_grader.expressions import Expression, evaluate_all
from dh_grader.figures.table_figure import TableFormulas, free_scope, table_formulas, table_to_draw
from dh_grader.grading.report import WorkBudget
from dh_grader.kinematics import Convention, Table, pose

TABLES = {
    "planar": ("RR", [["a1", "0", "0", "theta1"], ["a2", "0", "0", "theta2"]]),
    "scara": (
        "RRP",
        [["a1", "0", "d1", "q1"], ["-a2", "pi", "0", "q2 + pi/2"], ["0", "0", "q3", "0"]],
    ),
    "spherical": (
        "RRP",
        [["0", "-90°", "0.4", "q1"], ["0", "pi/2", "d2", "q2"], ["l3", "pi/6", "q3", "-pi/2"]],
    ),
    "strange": ("RP", [["a1+l1", "alpha1", "0", "2 q1 - pi"], ["0", "pi/2", "q2/2", "sin(a2)"]]),
    "wrist": (
        "RRR",
        [["0", "-pi/2", "0", "q1"], ["0", "pi/2", "0", "q2"], ["0", "0", "d6", "-q3"]],
    ),
}


def formulas_of(rows: object, structure: str, convention: Convention) -> TableFormulas:
    scope, budget = free_scope(structure), WorkBudget.of_drawing(with_figure=True)
    return table_formulas(table_to_draw(rows, scope, budget), convention, scope, budget)


def found(name: str, convention: Convention) -> TableFormulas:
    structure, rows = TABLES[name]
    return formulas_of(rows, structure, convention)


@pytest.mark.parametrize("convention", Convention)
@pytest.mark.parametrize("name", TABLES)
def test_formulas_have_the_values_of_the_table(name: str, convention: Convention) -> None:
    formulas = found(name, convention)
    rng = np.random.default_rng(5)
    variables = free_scope(TABLES[name][0]).variables
    values = {variable.name: rng.uniform(-2, 2, 6) for variable in variables}

    def table(rows: Iterable[Iterable[Expression | None]]) -> Table:
        cells = [cell for row in rows for cell in row]
        numbers = [np.broadcast_to(each, 6) for each in evaluate_all(cells, values, {})]
        return np.array(numbers).reshape(-1, 4, 6)

    reached = pose(table(formulas.cells), convention)
    other = pose(table([row.cells for row in formulas.converted]), convention.other)
    assert other == pytest.approx(reached)
    assert np.moveaxis(table(formulas.pose), -1, 0) == pytest.approx(reached)


def test_parallel_axes_give_the_formulas_of_a_textbook() -> None:
    texts = [[cell.text() for cell in row] for row in found("planar", Convention.STANDARD).pose]
    assert texts[0] == [
        "cos(theta1 + theta2)",
        "-sin(theta1 + theta2)",
        "0",
        "a1*cos(theta1) + a2*cos(theta1 + theta2)",
    ]


def test_unreadable_or_too_long_formulas_are_left_out() -> None:
    half = formulas_of([["a1", "0", "", "q1"]], "R", Convention.STANDARD)
    assert [cell and cell.text() for cell in half.cells[0]] == ["a1", "0", None, "theta1"]
    assert not half.converted
    assert not half.pose
    rows = [[f"a{i}", f"alpha{i}", f"d{i}", f"q{i}"] for i in range(1, 11)]
    long = formulas_of(rows, "R" * 10, Convention.STANDARD)
    assert len(long.converted) == 11
    assert not long.pose


@pytest.mark.parametrize("convention", Convention)
def test_a_table_without_rows_has_no_formulas(convention: Convention) -> None:
    assert formulas_of(" ", "R", convention) == TableFormulas(())


def test_printing_stops_when_the_budget_is_used_up() -> None:
    rows = [[f"{'sin(30)' * 25}+{4 * i + j}" for j in range(4)] for i in range(12)]
    cells = [cell for row in formulas_of(rows, "R", Convention.STANDARD).cells for cell in row]
    printed = [cell is not None for cell in cells]
    assert printed == sorted(printed, reverse=True)
    assert 0 < sum(printed) < len(printed)
