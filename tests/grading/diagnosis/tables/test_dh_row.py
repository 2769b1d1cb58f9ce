"""Test the misconceptions about the DH row of a transform."""

import numpy as np
import pytest
from dh_grader.grading.diagnosis import table_cells as dh_row
from dh_grader.grading.diagnosis.table_cells import WrongRow, violated
from dh_grader.grading.misconception import diagnosed
from dh_grader.grading.numbers import SAMPLES
from dh_grader.kinematics import Convention, Matrices, Numbers, link_transforms, rot_x, rot_y, row

from tests.grading.diagnosis.pairs import Pair, assert_explains_only_the_first, each_pair
from tests.kinematics.constructions import trans

RNG = np.random.default_rng(10)
A, ALPHA, D, THETA = ROW = RNG.uniform(0.3, 1.2, (4, SAMPLES))
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

PAIRS = [
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


@each_pair(PAIRS)
def test_a_misconception_explains_only_its_case(pair: Pair) -> None:
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
