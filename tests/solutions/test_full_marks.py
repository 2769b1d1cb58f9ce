"""For every exercise the model solution, handed in, gets full marks in every part."""

import re
import time
from collections.abc import Callable, Mapping

import pytest

from service.catalogue import Exercise, shipped_folder
from service.expressions import read
from service.solutions import ModelSolution, PartAnswer, solve
from tests.grading.support.robots import AngleUnit
from tests.grading.support.submitting import full_marks, handed_in

IDS = sorted(file.stem for file in shipped_folder().glob("*.toml"))


@pytest.fixture(scope="module")
def solution_of(catalogue: Mapping[str, Exercise]) -> Callable[[str], ModelSolution]:
    known: dict[str, ModelSolution] = {}

    def of(exercise_id: str) -> ModelSolution:
        if exercise_id not in known:
            known[exercise_id] = solve(catalogue[exercise_id])
        return known[exercise_id]

    return of


def posted(part: PartAnswer, solution: ModelSolution, form: str) -> object:
    """The part's answer as JSON, or as text to be pasted."""
    if form == "json":
        return part.answer
    if part.kind == "link_transforms":  # a list, whose matrices are each pasted
        return [getattr(link, form) for link in solution.links]
    if part.text == "none":  # that there is no row is no formula
        return part.answer
    return getattr(part, form)


@pytest.mark.parametrize("unit", ["radians", "degrees"])
@pytest.mark.parametrize("form", ["json", "text", "latex"])
@pytest.mark.parametrize("exercise_id", IDS)
def test_the_model_solution_gets_full_marks(
    exercise_id: str,
    form: str,
    unit: AngleUnit,
    catalogue: Mapping[str, Exercise],
    solution_of: Callable[[str], ModelSolution],
) -> None:
    exercise, solution = catalogue[exercise_id], solution_of(exercise_id)
    answers = {part.part: posted(part, solution, form) for part in solution.parts}
    assert set(answers) == {part.id for part in exercise.parts}
    report = handed_in(exercise, answers, unit)
    for part in report.parts:
        assert full_marks(part), part
        assert not part.follow_through


@pytest.mark.parametrize("exercise_id", IDS)
def test_it_reads_back_within_the_limits_with_its_shorthand_explained(
    exercise_id: str, catalogue: Mapping[str, Exercise], solution_of: Callable[[str], ModelSolution]
) -> None:
    vocabulary = catalogue[exercise_id].vocabulary
    for name, meaning in solution_of(exercise_id).notation.items():
        assert read(name, vocabulary).text() == meaning


def test_how_long_the_longest_entry_and_the_slowest_solution_are(
    catalogue: Mapping[str, Exercise], figure: Callable[[str], None]
) -> None:
    times, longest = {}, 0
    for exercise in catalogue.values():
        start = time.perf_counter()
        solution = solve(exercise)
        times[exercise.id] = time.perf_counter() - start
        if solution.pose is not None:
            longest = max(longest, *map(len, re.split(r"[,;]", solution.pose.text)))
    slowest = max(times, key=times.__getitem__)
    figure(f"slowest model solution: {slowest}, {times[slowest] * 1e3:.0f} ms")
    figure(f"longest entry of a model solution: {longest} of 500 characters")
    assert longest <= 500
