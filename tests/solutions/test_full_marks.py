"""The model solution of every exercise gets full marks in every part."""

import re
from collections.abc import Callable, Mapping

import pytest
from dh_grader.catalogue import Exercise, shipped_folder
from dh_grader.expressions import LIMITS, read
from dh_grader.solutions import ModelSolution, PartAnswer

from tests.grading.support.robots import AngleUnit
from tests.grading.support.submitting import full_marks, handed_in
from tests.shipped import sampled
from tests.solutions.solved import solved

IDS = sorted(file.stem for file in shipped_folder().glob("*.toml"))


def posted(part: PartAnswer, solution: ModelSolution, form: str) -> object:
    if form == "json":
        return part.answer
    if part.kind == "link_transforms":  # a list of matrices, each of which is pasted
        return [getattr(link, form) for link in solution.links]
    if part.text == "none":  # the answer that there is no row is only accepted as JSON
        return part.answer
    return getattr(part, form)


@pytest.mark.sampled(12)
@pytest.mark.parametrize("unit", ["radians", "degrees"])
@pytest.mark.parametrize("form", ["json", "text", "latex"])
@pytest.mark.parametrize("exercise_id", sampled(IDS))
def test_the_model_solution_gets_full_marks(
    exercise_id: str,
    form: str,
    unit: AngleUnit,
    catalogue: Mapping[str, Exercise],
) -> None:
    exercise = catalogue[exercise_id]
    solution = solved(exercise)
    answers = {part.part: posted(part, solution, form) for part in solution.parts}
    assert set(answers) == {part.id for part in exercise.parts}
    report = handed_in(exercise, answers, unit)
    for part in report.parts:
        assert full_marks(part), part
        assert not part.follow_through


@pytest.mark.parametrize("exercise_id", sampled(IDS))
def test_each_shorthand_reads_back_to_its_meaning(
    exercise_id: str, catalogue: Mapping[str, Exercise]
) -> None:
    exercise = catalogue[exercise_id]
    for name, meaning in solved(exercise).notation.items():
        assert read(name, exercise.vocabulary).text() == meaning


@pytest.mark.long
def test_the_longest_entry_is_within_the_limit(
    catalogue: Mapping[str, Exercise], figure: Callable[[str], None]
) -> None:
    poses = [pose for exercise in catalogue.values() if (pose := solved(exercise).pose)]
    longest = max(len(entry) for pose in poses for entry in re.split(r"[,;]", pose.text))
    figure(f"longest entry of a model solution: {longest} of {LIMITS.characters} characters")
    assert longest <= LIMITS.characters
