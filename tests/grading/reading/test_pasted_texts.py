"""Pasted texts in five languages are read as meant, or refused with advice."""

from collections import Counter
from collections.abc import Callable, Mapping

import pytest
from dh_grader.catalogue import Exercise
from dh_grader.grading.reading import preview_pasted

from tests.grading.reading.pasted_texts import languages, reading_of, texts

LEAST_TEXTS = 500
LEAST_READ = 0.9


@pytest.mark.parametrize("language", languages())
def test_no_text_is_misread_and_each_refused_one_has_advice(language: str) -> None:
    for case in texts(language):
        reading = reading_of(case)
        assert reading.outcome != "misread", (case.title, reading.advice)
        if not case.rows:
            assert reading.outcome == "advised", case.title
        elif reading.outcome != "read":
            assert reading.advice, case.title
            assert not any(advice.startswith("no_grid") for advice in reading.advice), case.title


@pytest.mark.parametrize("file", ["around", "named"])
def test_each_text_of_a_form_that_is_read_keeps_its_meaning(file: str) -> None:
    for case in texts(file):
        reading = reading_of(case)
        assert reading.outcome == ("read" if case.rows else "advised"), (case.title, reading)


@pytest.mark.long
def test_most_texts_are_read(figure: Callable[[str], None]) -> None:
    found = [case for language in languages() for case in texts(language) if case.rows]
    total = sum(len(texts(language)) for language in languages())
    counts = Counter(reading_of(case).outcome for case in found)
    figure(f"{total} pasted texts, {len(found)} with a meaning: {dict(counts)}")
    assert total >= LEAST_TEXTS
    assert counts["read"] / len(found) >= LEAST_READ


@pytest.mark.parametrize("language", languages())
def test_the_preview_shows_rows_or_a_problem(
    language: str, catalogue: Mapping[str, Exercise]
) -> None:
    part = {"matrix": ("planar-rrr", "pose"), "position": ("planar-rr", "position")}
    for case in texts(language):
        exercise, part_id = part.get(case.kind, ("rrrp", "table"))
        preview = preview_pasted(case.text, catalogue[exercise], part_id)
        assert preview.rows or (preview.problem and preview.problem.message), case.title
