"""Indices in square brackets count from 0 or from 1, or the text is refused."""

import pytest

from service.expressions import Vocabulary, joint_variable
from service.grading.numerics.samples import Samples
from service.grading.reading.entry import Reader
from service.grading.reading.pasted import pasted_grid
from service.grids import GridError


def cells(text: str) -> list[str]:
    reader = Reader(Vocabulary([joint_variable(i) for i in (1, 2, 3)]), Samples({}), "radians", "m")
    entries = [reader.read(cell.text, "number") for cell in pasted_grid(text, reader).rows[0]]
    return [entry.expression.text() for entry in entries if entry.expression]


def test_a_joint_with_index_0_counts_from_0() -> None:
    assert cells("q[0], q[1]") == ["theta1", "theta2"]


def test_the_number_of_the_last_joint_counts_from_1() -> None:
    assert cells("theta[1], theta[3]") == ["theta1", "theta3"]


@pytest.mark.parametrize("text", ["q[1], 0", "cos(q[1]), sin(q[2])", "θ[2], 1"])
def test_other_indices_have_two_readings(text: str) -> None:
    with pytest.raises(GridError) as caught:
        cells(text)
    assert caught.value.code == "ambiguous_index"
