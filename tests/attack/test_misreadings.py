"""Run a small part of `python -m tests.attack.misreadings`."""

import pytest

from tests.attack.misreadings import REFUSED, SECTIONS, Tally, tallied


@pytest.mark.long
@pytest.mark.parametrize(
    ("section", "count"), [("spellings", 30), ("grids", 3), ("submissions", 4)]
)
def test_no_formula_is_read_as_another_one(section: str, count: int) -> None:
    tally = tallied(section, count, "suite")
    assert tally.misread == []
    refused = {name: tally.refused(name) for name in tally.outcomes}
    # Of a few texts, a single refusal is a large share.
    assert {name: share for name, share in refused.items() if share > REFUSED + 1 / count} == {}


def test_a_tally_counts_readings_refusals_and_misreadings() -> None:
    tally = Tally()
    tally.add("plain", "read")
    tally.add("plain", "refused: two_values")
    tally.add("plain", "misread", "c12")
    assert tally.refused("plain") == pytest.approx(2 / 3)
    assert tally.misread == ["plain: c12"]
    assert list(SECTIONS) == ["spellings", "grids", "submissions"]
