"""Each example in docs/answer-kinds.md gets full marks."""

import json
import re
from collections.abc import Mapping
from pathlib import Path

import pytest
from dh_grader.catalogue import Exercise
from dh_grader.grading.kinds import KINDS

from tests.grading.support.submitting import full_marks, handed_in, part

PAGE = (Path(__file__).parents[2] / "docs" / "answer-kinds.md").read_text(encoding="utf-8")
BLOCKS = re.findall(r"^```json (\S+)\n(.*?)^```$", PAGE, re.DOTALL | re.MULTILINE)


def test_every_block_is_an_example() -> None:
    assert len(BLOCKS) == PAGE.count("\n```") / 2


@pytest.mark.parametrize(("exercise_id", "body"), BLOCKS)
def test_an_example_gets_full_marks(
    exercise_id: str, body: str, catalogue: Mapping[str, Exercise]
) -> None:
    answers = json.loads(body)["answers"]
    report = handed_in(catalogue[exercise_id], answers)
    assert answers
    for part_id in answers:
        assert full_marks(part(report, part_id)), part(report, part_id)


def test_every_kind_has_an_entry() -> None:
    assert set(re.findall(r"^## `(\w+)`$", PAGE, re.MULTILINE)) == set(KINDS)


def test_every_code_on_the_page_exists() -> None:
    program = "\n".join(
        file.read_text(encoding="utf-8")
        for file in (Path(__file__).parents[2] / "service" / "dh_grader" / "grading").rglob("*.py")
    )
    named = {code for code in re.findall(r"`([a-z]+_[a-z_0-9]+)`", PAGE) if code not in KINDS}
    assert len(named) > 25
    assert {code for code in named if f'"{code}"' not in program} == set()
