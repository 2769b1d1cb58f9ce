"""Run a small part of `make fuzz`."""

import pytest

from tests.attack.hostile import Case, Found, Reading, group, groups, sample


@pytest.mark.long
def test_hostile_texts_grids_and_requests() -> None:
    found = sample(250, "hostile")
    assert found.escaped == []
    assert found.differing == []
    kinds = {name.split()[0] for name in found.outcomes}
    assert kinds == {"text", "grid", "submission", "preview"}


class Unsteady(Reading):
    """A fake reader that gives a different result each time."""

    def __init__(self) -> None:
        self.times = 0

    def outcome(self, case: Case) -> tuple[str, bytes, float]:
        self.times += 1
        if case.value == "bad":
            raise ValueError(case.value)
        return "text read", str(self.times).encode(), 0.0


def test_exceptions_and_differing_readings_are_found() -> None:
    found = group([Case("text", "q1"), Case("text", "bad")], Unsteady())
    assert [line.split()[0] for line in found.differing] == ["twice", "from"]
    assert len(found.escaped) == 1
    total = Found()
    total.add(found)
    assert (total.count, total.outcomes["text read"]) == (2, 1)


def test_the_sizes_of_the_groups_sum_up_to_the_count() -> None:
    assert list(groups(1200, "a", 500)) == [(500, "a.0"), (500, "a.1"), (200, "a.2")]
