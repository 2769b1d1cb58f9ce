"""The model table of every exercise, pasted in every format, gets full marks."""

from collections.abc import Mapping

import pytest
from dh_grader.catalogue import Exercise, shipped_folder
from dh_grader.catalogue.kinds import DhTableSpec
from dh_grader.kinematics import COLUMNS

from tests.grading.support.submitting import full_marks, handed_in
from tests.pasting.writers import FORMATS
from tests.shipped import sampled
from tests.solutions.solved import solved

IDS = sorted(file.stem for file in shipped_folder().glob("*.toml"))


@pytest.mark.sampled(4)
@pytest.mark.parametrize("exercise_id", sampled(IDS))
def test_the_model_table_gets_full_marks_in_every_format(
    exercise_id: str, catalogue: Mapping[str, Exercise]
) -> None:
    exercise = catalogue[exercise_id]
    tables = [part for part in exercise.parts if isinstance(part, DhTableSpec)]
    if not tables:
        pytest.skip("asks for no table")
    solution = {part.part: part.answer for part in solved(exercise).parts}
    for part in tables:
        answer = solution[part.id]
        assert isinstance(answer, dict)
        rows = [[str(row[column]) for column in COLUMNS] for row in answer["rows"]]
        refused = []
        for name, write in FORMATS.items():
            report = handed_in(exercise, {part.id: write(rows)})
            graded = next(each for each in report.parts if each.part == part.id)
            if not full_marks(graded):
                refused.append((name, write(rows), graded.feedback))
        assert not refused, refused[:2]
