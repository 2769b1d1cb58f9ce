"""All variants of a shipped exercise are sound and equally hard."""

import re
from collections.abc import Iterable, Iterator

import pytest
from dh_grader.catalogue import Exercise
from dh_grader.figures import exercise_figure
from dh_grader.grading import Submission, grade
from dh_grader.variants import built, seed_of
from dh_grader.variants.deployment import Form, checked_variant, difficulty_of, form_of

from tests.variants.shipped import VARIED, shipped

# What students get wrong: a cell of the table, from its numbers to other ones.
SLIPS = {
    "an alpha forgotten": (1, "0"),
    "a length forgotten": (0, "0"),
    "a sign of theta": (3, "-({})"),
    "an offset too much": (2, "{} + 0.123"),
}


def sound(exercise: Exercise, seeds: range) -> None:
    checked = [checked_variant(exercise, str(seed)) for seed in seeds]
    faults = [(each.seed, remark.text) for each in checked for remark in each.remarks]
    assert not faults
    scores = {each.difficulty.score for each in checked}
    assert max(scores) <= 1.2 * min(scores)
    assert len({each.form for each in checked}) > 0.6 * len(checked)


@pytest.mark.parametrize("name", VARIED)
def test_variants_are_sound_different_and_equally_hard(name: str) -> None:
    sound(shipped(name), range(1, 3))


@pytest.mark.campaign
@pytest.mark.parametrize("name", VARIED)
def test_two_hundred_variants_are_sound_different_and_equally_hard(name: str) -> None:
    sound(shipped(name), range(1, 201))


@pytest.mark.parametrize("name", VARIED)
def test_statement_and_figure_suit_every_seed(name: str) -> None:
    exercise = shipped(name)
    figures = set()
    for seed in range(1, 11):
        variant = built(exercise, str(seed))
        assert "{{" not in variant.statement + variant.title
        assert not re.search(r"\d{4}", variant.statement), "an unrounded number"
        if seed <= 2:
            figures.add(exercise_figure(variant))
        lengths = re.findall(r"(\d\.\d+)\s+m\b", variant.statement)
        table = variant.robot.tables[variant.robot.convention]
        written = {cell.text() for row in table.rows for cell in row}
        # Each length of the statement is in the table, and each of the table in the statement.
        assert set(lengths) == {each for each in written if re.fullmatch(r"\d\.\d+", each)}
    assert len(figures) == 2


def slips(rows: list[list[str]]) -> Iterator[tuple[str, list[list[str]]]]:
    """Yield wrong tables with one slip, each with a description."""
    for i in range(len(rows)):
        for slip, (column, text) in SLIPS.items():
            wrong = [list(row) for row in rows]
            wrong[i][column] = text.format(wrong[i][column])
            if wrong[i][column] != rows[i][column]:
                yield f"{slip} in row {i}", wrong


def points(variant: Exercise, rows: list[list[str]]) -> float:
    report = grade(variant, Submission({"table": {"rows": rows}}))
    return next(part.points for part in report.parts if part.part == "table")


def alike(exercise: Exercise, seeds: Iterable[str]) -> None:
    earned: dict[tuple[object, ...], set[float]] = {}
    for seed in seeds:
        variant = built(exercise, seed)
        table = variant.robot.tables[variant.robot.convention]
        rows = [[cell.text() for cell in row] for row in table.rows]
        assert points(variant, rows) == variant.parts[0].points
        # Where joints slide or axes are parallel, the same change may be a free choice.
        kind = (variant.structure, difficulty_of(variant))
        for slip, wrong in slips(rows):
            earned.setdefault((*kind, slip), set()).add(points(variant, wrong))
    assert len(earned) >= 8
    assert all(len(each) == 1 for each in earned.values()), earned


@pytest.mark.parametrize("name", VARIED)
def test_equally_good_answers_earn_the_same_in_every_variant(name: str) -> None:
    alike(shipped(name), map(str, range(4)))


@pytest.mark.campaign
@pytest.mark.parametrize("name", VARIED)
def test_equally_good_answers_of_two_hundred_learners_earn_the_same(name: str) -> None:
    alike(shipped(name), [seed_of("secret", f"learner {i}", name, 0) for i in range(200)])


def test_two_variants_have_one_form_only_if_they_are_the_same() -> None:
    exercise = shipped("planar-rr-numbers")
    by_form: dict[Form, set[str]] = {}
    for seed in range(1, 60):
        variant = built(exercise, str(seed))
        text = " ".join(variant.statement.split())
        by_form.setdefault(form_of(variant), set()).add(text)
    assert len(by_form) > 40
    assert all(len(texts) == 1 for texts in by_form.values())
    texts = [text for each in by_form.values() for text in each]
    assert len(texts) == len(set(texts))
