"""Test figures of a submitted table."""

import re
import xml.etree.ElementTree as ET
from collections import Counter
from collections.abc import Iterable, Iterator
from typing import Any

import httpx
import numpy as np
import pytest
from dh_grader.api.application import application
from dh_grader.expressions import Expression, evaluate_all
from dh_grader.figures.table_figure import (
    DrawingScope,
    TableFormulas,
    TableFrames,
    free_scope,
    table_formulas,
    table_frames,
    table_to_draw,
)
from dh_grader.grading.report import UnreadableAnswerError, WorkBudget
from dh_grader.kinematics import Convention, Table, pose

from tests.api.conftest import InProcess
from tests.browser.hostile import TEXTS
from tests.shipped import shipped_exercises

# --- The figure of a student's table contains no text of the student

SHIPPED = shipped_exercises()
SVG = "{http://www.w3.org/2000/svg}"
# A revolute joint, a prismatic joint perpendicular to it, and a fixed row.
TABLE = {"structure": "RP", "rows": "0 90° d1 q1\n0 0 q2 0\n0.2 0 0 0"}


@pytest.fixture(scope="module")
def client() -> Iterator[httpx.Client]:
    app = application(SHIPPED)
    with httpx.Client(transport=InProcess(app), base_url="http://service") as made:
        yield made


def drawn(client: httpx.Client, **body: Any) -> ET.Element:
    response = client.post("/v1/frames", json={"figure": "light", **body})
    assert response.status_code == 200, response.text
    return ET.fromstring(response.json()["figure"])


def names(svg: ET.Element) -> set[str]:
    texts = ("".join(each.itertext()) for each in svg.iter(f"{SVG}text"))
    return {name for text in texts for name in text.split(", ")}


def kinds(svg: ET.Element) -> Counter[str]:
    return Counter(each.get("class", "").split()[0] for each in svg.iter() if each.get("class"))


def test_a_table_is_drawn_as_a_robot_with_its_frames(client: httpx.Client) -> None:
    svg = drawn(client, table=TABLE, symbols={"d1": 0.5}, joints=[[0.0, 0.4]])
    assert names(svg) == {f"{axis}{i}" for axis in "xyz" for i in range(4)}
    found = kinds(svg)
    assert (found["turning"], found["rod"], found["chain"]) == (1, 3, 0)
    assert found["sliding"] > 0
    # The first rod goes up by d1 = 0.5.
    up, *_ = svg.iterfind(".//*[@class='rod']")
    (x0, y0), (x1, y1) = (map(float, point.split(",")) for point in up.get("points", "").split())
    assert x0 == pytest.approx(x1)
    assert y1 < y0


@pytest.mark.long
def test_a_table_is_drawn_over_the_mechanism_of_its_exercise(client: httpx.Client) -> None:
    # Without a table, the figure contains no answer: no names, and no lines of a chain.
    for name, exercise in SHIPPED.items():
        if exercise.reference is not None:
            alone = drawn(client, exercise=name)
            assert (names(alone), kinds(alone)["chain"], kinds(alone)["frame"]) == (set(), 0, 0)
    right = [["a1", 0, 0, "theta1"], ["a2", 0, 0, "theta2"]]
    over = drawn(client, exercise="planar-rr", table={"rows": right}, joints=[[0.4, 0.7]])
    assert names(over) == {f"{axis}{i}" for axis in "xyz" for i in range(3)}
    assert kinds(over)["chain"] == 2
    # The last origin of a right table is the tool point of the gripper.
    point = over.find(".//*[@class='point']")
    assert point is not None
    tip = over.findall(".//*[@class='chain']")[-1].get("points", "").split()[-1]
    assert tip == f"{point.get('cx')},{point.get('cy')}"


def test_a_figure_contains_no_text_of_a_hostile_table(client: httpx.Client) -> None:
    rows = [[TEXTS[i % len(TEXTS)], 0, 0, "theta1"] for i in range(2)]
    for table in ({"rows": rows}, {"rows": TEXTS[0]}, {"rows": [["1e6", "1", "-1e6", "1"]] * 12}):
        svg = drawn(client, exercise="planar-rr", table=table)
        text = ET.tostring(svg, encoding="unicode")
        assert not re.search(r"script|onerror|javascript|nan|inf\b|href", text)
        assert {each.tag.removeprefix(SVG) for each in svg.iter()} <= {
            "svg", "title", "desc", "style", "rect", "g", "polygon", "polyline", "path", "ellipse",
            "circle", "text", "tspan", "linearGradient", "stop",
        }  # fmt: skip
    # With unreadable rows and no exercise, there is nothing to draw.
    body = {"figure": "auto", "table": {"structure": "R", "rows": TEXTS[1]}}
    assert "figure" not in client.post("/v1/frames", json=body).json()


# --- The formulas of a table have the same values as a numeric computation

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


# --- Test the frames computed from students' tables

STANDARD, MODIFIED = Convention


def framed(
    rows: object,
    structure: str,
    amounts: list[list[float]],
    convention: Convention = STANDARD,
    **numbers: float,
) -> TableFrames:
    scope: DrawingScope = free_scope(structure)
    written = table_to_draw(rows, scope, WorkBudget())
    return table_frames(written, convention, scope, scope.numbers(numbers), np.array(amounts))


ELBOW = [["0", "90deg", "d1", "theta1"], ["a2", "0", "0", "q2"]]


def test_the_frames_of_an_elbow_are_those_computed_by_hand() -> None:
    # θ1 = 90° turns the arm to y, and θ2 = 30° raises it.
    found = framed(ELBOW, "RR", [[0, 0], [np.pi / 2, np.pi / 6]], d1=0.5, a2=2)
    assert found.complete
    assert found.frames.shape == (2, 3, 4, 4)
    assert found.frames[0, 0] == pytest.approx(np.eye(4))
    assert found.frames[0, 2, :3, 3] == pytest.approx([2, 0, 0.5])
    assert found.frames[1, 2, :3, 3] == pytest.approx([0, np.sqrt(3), 1.5])
    assert found.frames[1, 1, :3, 2] == pytest.approx([1, 0, 0], abs=1e-12)
    assert found.symbols == {"d1", "a2", "theta1", "theta2"}
    assert (found.freedoms, found.lost) == (2, ())


def test_frames_follow_the_convention_and_the_angle_unit() -> None:
    # In the modified convention, a and α come before d and θ, which gives another arm.
    found = framed(ELBOW, "RR", [[0, 0]], MODIFIED, d1=0.5, a2=2)
    assert found.frames[0, 2, :3, 3] == pytest.approx([2, -0.5, 0])
    scope = free_scope("R")
    amounts = np.zeros((1, 1))
    rows = [["1", "90", "0", "q1"]]
    written = table_to_draw(rows, scope, WorkBudget(), "degrees")
    found = table_frames(written, STANDARD, scope, scope.numbers({}), amounts)
    assert found.frames[0, 1, :3, 2] == pytest.approx([0, -1, 0], abs=1e-12)


def test_pasted_text_is_read_as_grading_reads_it() -> None:
    pasted = framed("i a alpha d theta\n1 0 90° d1 θ1\n2 a2 0 0 θ2", "RR", [[0.3, 0.4]])
    assert pasted.frames == pytest.approx(framed(ELBOW, "RR", [[0.3, 0.4]]).frames)


@pytest.mark.parametrize(
    ("cell", "code", "suggestion"),
    [
        ("a2 +", "trailing_operator", "a2"),
        ("", "missing", None),
        ("1/(q2 - 0.4)", "undefined", None),
        ("1e7 a2", "undefined", None),
        ("q3", "unknown_joint", None),
    ],
)
def test_frames_end_before_a_cell_without_a_number(
    cell: str, code: str, suggestion: str | None
) -> None:
    found = framed([ELBOW[0], [cell, "0", "0", "q2"], ["1", "0", "0", "0"]], "RR", [[0.3, 0.4]])
    assert not found.complete
    assert found.frames.shape == (1, 2, 4, 4)
    [unread] = found.unread
    assert (unread.row, unread.column) == ("2", "a")
    assert (unread.finding.code, unread.finding.suggestion) == (code, suggestion)
    assert found.freedoms is None


@pytest.mark.parametrize(
    ("rows", "structure", "freedoms", "lost"),
    [
        (["0 0 d1 q1", "0 0 0 q2"], "RR", 1, [(1, 2)]),
        (["0 0 q1 0", "a1 0 q2 0", "0 0 0 q3"], "PPR", 2, [(1, 2)]),
        (["a1 0 0 q1", "a2 0 0 0"], "RR", 1, [(2,)]),
        (["a1 0 0 q1", "a2 0 0 q2", "a3 0 0 q3", "a4 0 0 q4"], "RRRR", 3, []),
    ],
)
def test_lost_freedoms_are_named(
    rows: list[str], structure: str, freedoms: int, lost: list[tuple[int, ...]]
) -> None:
    found = framed([row.split() for row in rows], structure, [[0.0] * len(structure)])
    assert found.freedoms == freedoms
    assert [each.joints for each in found.lost] == lost


def test_an_answer_without_rows_is_unreadable() -> None:
    with pytest.raises(UnreadableAnswerError):
        framed(7, "R", [[0]])
    assert framed({"rows": []}, "R", [[0]]).frames.shape == (1, 1, 4, 4)
