"""Test the messages about faulty table rows that an exercise file gives to students."""

from pathlib import Path

import pytest
from dh_grader.catalogue import CatalogueError, load_exercise

from tests.catalogue.test_faults import VALID, write

TABLE = 'title = "Table"\nconvention = "standard"\n'


def test_given_rows_are_in_the_shape_of_the_answer(tmp_path: Path) -> None:
    exercise = load_exercise(write(tmp_path, VALID.replace(TABLE, f"{TABLE}given = [2]\n")))
    shape = exercise.parts[0].shape(exercise.reference)
    assert shape.model_dump()["given"] == {"2": ["0", "0", "d2 + a1", "0"]}
    assert shape.in_words().endswith("row 2 given")


@pytest.mark.parametrize(
    ("given", "reason"),
    [
        ("given = [3]", "leave at least one of the 2 rows to the student"),
        ("given = [1, 2]", "leave at least one of the 2 rows to the student"),
        ("given = [2, 1]", "each number in given once, in order"),
        ("given = [0]", "greater than or equal to 1"),
        ('given = [1]\nframes = "free"', 'given rows need frames = "given"'),
    ],
)
def test_given_rows_that_do_not_fit_are_refused(tmp_path: Path, given: str, reason: str) -> None:
    text = VALID.replace(TABLE, f"{TABLE}{given}\n")
    with pytest.raises(CatalogueError) as refused:
        load_exercise(write(tmp_path, text))
    assert reason in str(refused.value)


def test_given_rows_are_those_of_the_robots_own_table(tmp_path: Path) -> None:
    text = VALID.replace(TABLE, 'title = "Table"\nconvention = "modified"\ngiven = [1]\n')
    with pytest.raises(CatalogueError, match='write convention = "standard"'):
        load_exercise(write(tmp_path, text))
