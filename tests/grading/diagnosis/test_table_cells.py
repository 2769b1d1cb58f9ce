"""Test misconceptions in cells and rows of tables."""

import numpy as np
import pytest
from dh_grader.catalogue import Joint
from dh_grader.expressions import Symbol, Vocabulary, read
from dh_grader.grading.diagnosis import table_cells as cell_variables
from dh_grader.grading.diagnosis import table_cells as dh_row
from dh_grader.grading.diagnosis import table_cells as table_cell
from dh_grader.grading.diagnosis.table_cells import WrongRow, diagnose, violated
from dh_grader.grading.misconception import WrongCell, diagnosed, undefined
from dh_grader.grading.numbers import HALF, SAMPLES, Samples, coefficients
from dh_grader.grading.report import Correction
from dh_grader.kinematics import (
    COLUMNS,
    Convention,
    Matrices,
    Numbers,
    link_transforms,
    rot_x,
    rot_y,
    row,
)

from tests.grading.diagnosis.pairs import Pair, assert_explains_only_the_first, each_pair
from tests.kinematics.constructions import trans

# --- Test the misconceptions about a table cell

RNG = np.random.default_rng(5)
JOINTS = (Joint(1, "q1", False), Joint(2, "q2", False), Joint(3, "d3", True))
LETTERS = {name: np.tile(RNG.uniform(0.2, 0.9, HALF), 2) for name in ("a1", "a2")}
VALUES = {joint.variable: RNG.uniform(-3, 3, SAMPLES) for joint in JOINTS} | LETTERS
SAMPLE = Samples(VALUES)
KINDS = {"q1": "angle", "q2": "angle", "d3": "length", "a1": "length", "a2": "length"}
# The robot has no theta3 (joint 3 slides) and no d1, but a table may contain them.
WORDS = Vocabulary(
    [Symbol(name, kind) for name, kind in KINDS.items()]  # type: ignore[arg-type]
    + [Symbol("theta3", "angle"), Symbol("d1", "length")]
)
TYPED = SAMPLE.with_names({"theta3", "d1"}).values


def wrong(column: str, number: int, written: str, right: str) -> WrongCell:
    angle = column in ("alpha", "theta")
    quantity = "angle" if angle else "length"
    expression = read(written, WORDS, quantity=quantity)  # type: ignore[arg-type]
    expected = read(right, WORDS, quantity=quantity)  # type: ignore[arg-type]
    values = [np.zeros(SAMPLES) + text.evaluate(TYPED) for text in (expression, expected)]
    values[0][~np.isfinite(values[0])] = np.nan
    contained, required = (
        None if counts is None else {JOINTS[k]: n for k, n in enumerate(counts) if n}
        for counts in coefficients(np.array(values), JOINTS, SAMPLE, np.array([angle, angle]))
    )
    return WrongCell(
        expression=expression,
        actual=values[0],
        expected=values[1],
        correction=Correction(right, right),
        samples=SAMPLE,
        scale=1.0 if angle else 0.5,
        angle=angle,
        column=COLUMNS.index(column),
        joint=JOINTS[number - 1],
        contained=contained,
        required=required or {},
        joints=JOINTS,
    )


# The codes that differ from the name of the function.
CODES = {"cell_in_degrees": "degrees_as_radians"}
PAIRS = [
    Pair(function, wrong(*explained), wrong(*unexplained), CODES.get(function.__name__, ""))
    for function, explained, unexplained in (
        (
            cell_variables.joint_variable_absent,
            ("theta", 3, "theta3", "0"),
            ("theta", 3, "q2", "0"),
        ),
        (undefined, ("d", 1, "a1/0", "a1"), ("d", 1, "a2", "a1")),
        (
            cell_variables.joint_variable_missing,
            ("theta", 1, "pi/2", "q1 + pi/2"),
            ("theta", 1, "q2", "q1"),
        ),
        (cell_variables.joint_variable_sign, ("d", 3, "-d3", "d3"), ("d", 3, "d3 + a1", "d3")),
        (
            cell_variables.joint_variable_index,
            ("theta", 1, "q2", "q1"),
            ("theta", 1, "q1 + q2", "q1"),
        ),
        (
            cell_variables.joint_variable_doubled,
            ("theta", 2, "2*q2", "q2"),
            ("theta", 2, "-q2", "q2"),
        ),
        (
            cell_variables.cell_in_degrees,
            ("theta", 2, "180*q2/pi + 90deg", "q2 + 90deg"),
            ("theta", 2, "90*q2/pi + 90deg", "q2 + 90deg"),
        ),
        (cell_variables.joint_variable_column, ("alpha", 1, "q1", "0"), ("alpha", 1, "q2", "0")),
        (
            cell_variables.joint_variable_extra,
            ("theta", 1, "q1 + q2", "q1"),
            ("theta", 1, "-q1", "q1"),
        ),
        (cell_variables.wrong_quantity, ("d", 1, "90deg", "a1"), ("d", 1, "90", "a1")),
        (table_cell.sign, ("a", 1, "-a1", "a1"), ("a", 1, "-a2", "a1")),
        (table_cell.distance_left_out, ("d", 1, "0", "a1"), ("d", 1, "a2", "a1")),
        (table_cell.distance_extra, ("d", 3, "d3 + a1", "d3"), ("a", 3, "a1", "a2")),
        (
            table_cell.degrees_as_radians,
            ("alpha", 1, "90", "pi/2"),
            ("alpha", 1, "91", "pi/2"),
        ),
        (
            table_cell.radians_as_degrees,
            ("alpha", 1, "pi*pi/360", "pi/2"),
            ("alpha", 1, "0", "pi/2"),
        ),
        (
            table_cell.quarter_turn,
            ("theta", 1, "q1", "q1 + pi/2"),
            ("theta", 1, "q1 + pi", "q1"),
        ),
        (
            table_cell.half_turn,
            ("theta", 1, "q1 + pi", "q1"),
            ("theta", 1, "q1 + pi/2", "q1"),
        ),
    )
]


@each_pair(PAIRS)
def test_a_misconception_explains_only_its_case(pair: Pair) -> None:
    finding = assert_explains_only_the_first(pair)
    assert finding.correction == pair.explained.correction


@each_pair(PAIRS)
def test_a_misconception_is_the_first_that_explains_its_cell(pair: Pair) -> None:
    assert diagnose(pair.explained).code == (pair.code or pair.function.__name__)


def test_an_unexplained_cell_gets_a_counterexample() -> None:
    finding = diagnose(wrong("a", 1, "a1 + 0.3", "a1"))
    assert finding.code == "value"
    assert finding.values is not None
    assert finding.values["yours"] == pytest.approx(float(VALUES["a1"][0]) + 0.3, rel=1e-3)


@pytest.mark.parametrize(
    ("column", "written", "right", "is_advised"),
    [
        ("a", "0.4", "a1", True),
        ("d", "d3 + 0.4", "d3 + a1", False),
        ("a", "a2", "a1", False),
        ("a", "0.4", "0.5", False),
        ("alpha", "0.4", "pi/2", False),
    ],
)
def test_a_number_for_a_length_gets_advice_to_use_symbols(
    column: str, written: str, right: str, is_advised: bool
) -> None:
    hint = diagnose(wrong(column, 3, written, right)).hint
    assert hint.endswith("Give it in the exercise's symbols.") is is_advised, hint


@pytest.mark.parametrize("right", ["a1", "0", "d3"])
def test_an_unknown_length_is_named(right: str) -> None:
    # Joint 1 is revolute, so d1 is not its variable, and the exercise has no length d1.
    finding = diagnose(wrong("d", 3 if right == "d3" else 1, "d1", right))
    assert finding.code == "unknown_symbol"
    assert finding.hint == "This exercise has no d1. It has d3."


# --- Test the misconceptions about the DH row of a transform

DH_ROW_RNG = np.random.default_rng(10)
A, ALPHA, D, THETA = ROW = DH_ROW_RNG.uniform(0.3, 1.2, (4, SAMPLES))
ZERO = np.zeros(SAMPLES)
STANDARD, MODIFIED = Convention.STANDARD, Convention.MODIFIED


def link(convention: Convention, *cells: Numbers) -> Matrices:
    return link_transforms(convention, *cells)


def case(
    written: list[Numbers], transform: Matrices, convention: Convention = STANDARD
) -> WrongRow:
    scale = np.array([0.7, 1.0, 0.7, 1.0])
    return WrongRow(np.array(written), row(transform, convention), scale, transform, convention)


FULL = link(STANDARD, *ROW)
# Without twist and offset, both conventions have a row, and the inverse has one, too.
FLAT = link(STANDARD, A, ZERO, ZERO, THETA)
# After half a turn, both conventions have a row, but the rows differ.
HALF_TURN = np.full(SAMPLES, np.pi)
TURNED = link(STANDARD, A, ALPHA, ZERO, HALF_TURN)
SCREW_ALONG_Z = link(STANDARD, ZERO, ZERO, D, THETA)

DH_ROW_PAIRS = [
    Pair(
        dh_row.exchanged_parameters,
        case([D, ALPHA, A, THETA], FULL),
        case([D, ALPHA, A, -THETA], FULL),
    ),
    Pair(
        dh_row.other_convention,
        case([-A, -ALPHA, ZERO, HALF_TURN], TURNED),
        case([-A, ALPHA, ZERO, HALF_TURN], TURNED),
    ),
    Pair(
        dh_row.inverse_row,
        case([ZERO, ZERO, -D, -THETA], SCREW_ALONG_Z),
        case([-A, ZERO, ZERO, -THETA], FLAT),
        "inverse_transform",
    ),
]


@each_pair(DH_ROW_PAIRS)
def test_a_misconception_explains_only_its_row(pair: Pair) -> None:
    assert_explains_only_the_first(pair)


def test_a_right_row_gets_no_finding() -> None:
    assert diagnosed(case(list(ROW), FULL)) is None


@pytest.mark.parametrize(
    ("transform", "codes"),
    [
        (FULL, []),
        (trans(0.5, 0, 0.2) @ rot_y(0.3), ["dh_not_perpendicular"]),
        (trans(0.5, 0.4, 0.2) @ rot_x(0.3), ["dh_not_intersecting"]),
        (trans(0.5, 0.4, 0.2) @ rot_y(0.3), ["dh_not_perpendicular", "dh_not_intersecting"]),
    ],
)
def test_violated_conditions_are_named(transform: Matrices, codes: list[str]) -> None:
    batch = np.broadcast_to(transform, (SAMPLES, 4, 4))
    findings = violated(batch, STANDARD, 0.7)
    assert [finding.code for finding in findings] == codes
    assert all("x1" in finding.hint and "z0" in finding.hint for finding in findings)


def test_the_modified_convention_names_its_own_axes() -> None:
    [finding] = violated(np.broadcast_to(rot_y(0.3), (SAMPLES, 4, 4)), MODIFIED, 0.7)
    assert "x0" in finding.hint
    assert "z1" in finding.hint
