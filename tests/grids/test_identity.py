"""Read the identity matrix by its name."""

import numpy as np
import pytest
from dh_grader.expressions import Kind, Vocabulary, joint_variable
from dh_grader.grading.numbers import Samples
from dh_grader.grading.reading.entries import Reader
from dh_grader.grading.reading.matrices import read_matrices, read_matrix
from dh_grader.grading.report import UnreadableAnswerError
from dh_grader.pasting import GridError, read_grid

TURN = "[c1 -s1 0; s1 c1 0; 0 0 1]"


def reader() -> Reader:
    return Reader(
        Vocabulary([joint_variable(1)]), Samples({"theta1": np.array([0.3])}), "radians", "m"
    )


def values(text: str, size: int) -> list[list[float]]:
    read = read_matrix(text, [["number"] * size] * size, reader()).values
    return [[float(cell[0]) for cell in row] for row in read]


def unit(size: int) -> list[list[float]]:
    return [[float(i == j) for j in range(size)] for i in range(size)]


# The sign # stands for the size.
OF_SIZE = [
    "eye(#)", "np.eye(#)", "eye(#, #);", "T = np.identity(#)", "IdentityMatrix[#]", "I_#", "I#",
    "A1 = sp.eye(#)", "$I_{#}$", r"\mathbf{I}_#", r"I_{# \times #}", "R := eye(#)",
]  # fmt: skip


@pytest.mark.parametrize("size", [3, 4])
@pytest.mark.parametrize("text", OF_SIZE)
def test_a_named_identity_is_read(text: str, size: int) -> None:
    assert values(text.replace("#", str(size)), size) == unit(size)


@pytest.mark.parametrize(
    "text",
    [
        "import numpy as np\nT = np.eye(4)", "T = np.eye(4)\nprint(T)",
        "T = eye(4); % pose\ndisp(T)", "% the pose\nT = eye(4)",
    ],
)  # fmt: skip
def test_a_program_that_makes_only_the_identity_is_read(text: str) -> None:
    assert values(text, 4) == unit(4)


@pytest.mark.parametrize("text", ["I", "T = I", "$I$", r"\mathbf{I}"])
def test_an_identity_without_a_size_has_the_size_that_is_asked_for(text: str) -> None:
    assert values(text, 3) == unit(3)
    assert values(text, 4) == unit(4)


def test_an_identity_of_another_size_is_refused() -> None:
    with pytest.raises(UnreadableAnswerError, match="yours is 3 × 3"):
        values("eye(3)", 4)


@pytest.mark.parametrize("name", ["eye(3)", "np.identity(3)", "I", "I_3"])
def test_an_identity_stands_in_a_list_of_matrices(name: str) -> None:
    for text in (
        f"R1 = {TURN}\nR2 = {name}",
        f"R1 = {TURN}; R2 = {name};",
        f"R2 = {name}\nR1 = {TURN}",
    ):
        quantities: list[list[Kind]] = [["number"] * 3] * 3
        _, second = read_matrices(text, ["1", "2"], quantities, reader())
        assert [[float(cell[0]) for cell in row] for row in second.values] == unit(3)


@pytest.mark.parametrize("text", ["eye(4)*A", "I + 1", "eye(5)", "eye(3, 4)", "Ix", "identity"])
def test_other_texts_are_no_identity(text: str) -> None:
    with pytest.raises(GridError):
        read_grid(text)


def test_no_table_is_an_identity() -> None:
    with pytest.raises(GridError):
        read_grid("I", of_table=True)
