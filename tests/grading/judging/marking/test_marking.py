"""An empty entry never earns more than a wrong entry."""

import json
import random
from collections.abc import Iterator
from copy import deepcopy
from typing import Any, Final

import pytest
from dh_grader.api.http import validated
from dh_grader.catalogue import Exercise, PartSpec
from dh_grader.grading import PartReport, grade
from dh_grader.submissions.bodies import GradeRequest

from tests.shipped import shipped_exercises
from tests.solutions.solved import solved

pytestmark = pytest.mark.long

TRIES: Final = 20
# Tables have a search for the frames, and a campaign of their own: tests/frame_choice/rows.
ELSEWHERE: Final = {"dh_table", "frames", "find_slip"}
Path = tuple[str | int, ...]


def parts_with_answers() -> list[tuple[Exercise, PartSpec, Any]]:
    return [
        (exercise, part, answer)
        for exercise in shipped_exercises().values()
        for part in exercise.parts
        for answer in [dict[str, Any](solved(exercise).answers)[part.id]]
        if part.kind not in ELSEWHERE and any(entries(answer))
    ]


def entries(answer: Any, path: Path = ()) -> Iterator[tuple[Path, str]]:
    if isinstance(answer, str):
        yield path, answer
    elif isinstance(answer, dict | list):
        pairs = answer.items() if isinstance(answer, dict) else enumerate(answer)
        for key, value in pairs:
            yield from entries(value, (*path, key))


def with_texts(answer: Any, texts: dict[Path, str]) -> Any:
    changed = deepcopy(answer)
    for (*path, last), text in texts.items():
        inner = changed
        for key in path:
            inner = inner[key]
        inner[last] = text
    return changed


def graded(exercise: Exercise, part: PartSpec, answer: Any) -> PartReport:
    body = validated(GradeRequest, json.loads(json.dumps({"answers": {part.id: answer}})), ())
    report = grade(exercise, body.submission(exercise.feedback))
    return next(each for each in report.parts if each.part == part.id)


@pytest.mark.parametrize("seed", range(4))
def test_an_empty_entry_or_row_earns_no_more(seed: int) -> None:
    choose, asked = random.Random(seed), parts_with_answers()
    for _ in range(TRIES):
        exercise, part, answer = choose.choice(asked)
        places = dict(entries(answer))
        spoiled = choose.sample(sorted(places, key=str), min(len(places), choose.randint(1, 16)))
        texts = {
            place: choose.choice(["-({})", "({}) + 0.321", "0", "1", "2*({})"]).format(
                places[place]
            )
            for place in spoiled
        }
        written = with_texts(answer, texts)
        row = choose.choice(sorted(places, key=str))[:-1]
        emptied = [[place] for place in choose.sample(sorted(places, key=str), min(3, len(places)))]
        for empty in [*emptied, [place for place in places if place[:-1] == row]]:
            less = graded(exercise, part, with_texts(written, dict.fromkeys(empty, "")))
            earned = graded(exercise, part, written).points
            assert less.points <= earned, (exercise.id, part.id, texts, empty)
