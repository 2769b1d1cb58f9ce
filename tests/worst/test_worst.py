"""The costliest known request bodies take no more time than promised."""

import random
import re
from collections import Counter
from collections.abc import Callable, Iterator
from functools import partial
from itertools import count
from types import SimpleNamespace

import pytest
from dh_grader.grading import Submission, grade
from dh_grader.grading.reading import preview_pasted
from dh_grader.pasting import source as pairs

from tests.worst.__main__ import PROMISED, PROMISED_DECIMALS
from tests.worst.bodies import ARM, KNOWN, NESTED, OF_DECIMALS
from tests.worst.entry_points import ATTEMPTS, ENTRIES, GRADE, HINTS, SOLUTION, Attack, Target
from tests.worst.exercises import exercises
from tests.worst.mutations import Mutator
from tests.worst.search import Search
from tests.worst.seeds import cells

# The least of several costs is compared with the promise, so that a busy machine fails no test.
GUARD = 1.25
# A hint on a message that is not in the report, and a solution for answers that are not right.
STATUS = {ATTEMPTS: 201, HINTS: 404, SOLUTION: 403}


@pytest.fixture(scope="module")
def target() -> Iterator[Target]:
    found = exercises()
    target = Target({each.exercise: found[each.exercise] for each in KNOWN.values()})
    yield target
    target.close()


@pytest.mark.long
@pytest.mark.parametrize("name", KNOWN)
def test_a_known_costly_body_is_within_the_promise(
    name: str, target: Target, figure: Callable[[str], None]
) -> None:
    attack = KNOWN[name]
    most = GUARD * (PROMISED_DECIMALS if name in OF_DECIMALS else PROMISED)
    ratio, status = target.ratio(attack, most)
    assert status == (422 if "unknown" in name else STATUS.get(attack.entry, 200))
    figure(f"{name}: {ratio:.0f} × the floor")
    assert ratio < most


def test_a_body_is_known_for_each_entry_point() -> None:
    assert {attack.entry for attack in KNOWN.values()} == set(ENTRIES)


def test_the_pairs_of_a_text_are_found_once(monkeypatch: pytest.MonkeyPatch) -> None:
    # Six links, a pose and a table of the same text.
    exercise = exercises()[ARM]
    searched: Counter[str] = Counter()

    class Sign:
        """The pattern of a bracket, which counts how often each text is searched."""

        def __init__(self, pattern: re.Pattern[str]) -> None:
            self._pattern = pattern

        def finditer(self, text: str) -> Iterator[re.Match[str]]:
            searched[text] += 1
            return self._pattern.finditer(text)

    monkeypatch.setattr(pairs, "_BRACKET_OR_QUOTE", Sign(pairs._BRACKET_OR_QUOTE))
    text = "[" + "(" * 2_000 + ")" * 2_000 + "]"
    grade(exercise, Submission({"links": [text] * 6, "pose": text, "table": text}))
    assert searched[text] == 1
    # Also the text inside the brackets, and inside the next two.
    assert sum(count for text, count in searched.items() if len(text) > 1_000) <= 5


def test_more_brackets_than_any_formula_has_are_refused() -> None:
    preview = preview_pasted(NESTED, exercises()[ARM], "pose")
    assert preview.problem is not None
    assert preview.problem.code == "too_long"
    assert "8,000 brackets" in preview.problem.message


@pytest.mark.long
def test_each_kind_of_body_is_changed() -> None:
    mutator = Mutator(random.Random(1), cells())
    for attack in KNOWN.values():
        found = {mutator.mutated(attack, [*KNOWN.values()]).content for _ in range(5)}
        assert len(found) > 1, attack.entry


@pytest.mark.long
def test_the_search_keeps_what_costs_most(target: Target, monkeypatch: pytest.MonkeyPatch) -> None:
    search = Search(target, 1, cells())
    cheap = Attack(GRADE, ARM, {"answers": {"pose": [["1"]]}})
    dear = KNOWN["cells that nearly repair"]
    # A clock that advances by a second at each call.
    clock = SimpleNamespace(monotonic=partial(next, count()))
    monkeypatch.setattr("tests.worst.search.time", clock)
    search.evolve([cheap, dear], 9)
    assert search.tried == 9
    [costliest] = search.costliest(GRADE, 3)
    assert costliest.ratio > search.measured(cheap).ratio
