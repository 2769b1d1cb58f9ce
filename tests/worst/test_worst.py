"""The costliest known request bodies take no more time than promised."""

import random
from collections.abc import Callable, Iterator
from functools import partial
from itertools import count
from types import SimpleNamespace

import pytest

from tests.worst.__main__ import PROMISED
from tests.worst.bodies import ARM, KNOWN
from tests.worst.entry_points import ATTEMPTS, GRADE, Attack, Target, floor_seconds
from tests.worst.exercises import exercises
from tests.worst.mutations import Mutator
from tests.worst.search import Search
from tests.worst.seeds import cells

# A wide margin, so that a busy machine or the measurement of coverage fails no test.
GUARD = 10 * PROMISED


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
    seconds, status = target.seconds(KNOWN[name])
    ratio = seconds / floor_seconds()
    accepted = 201 if KNOWN[name].entry == ATTEMPTS else 200
    assert status == (422 if "unknown" in name else accepted)
    figure(f"{name}: {ratio:.0f} × the floor")
    assert ratio < GUARD


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
