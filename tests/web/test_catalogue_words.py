"""The words by which the catalogue's search finds the shipped exercises."""

import pytest

from service.web.catalogue_words import words_of
from tests.shipped import shipped_exercises


@pytest.mark.parametrize(
    ("query", "expected"),
    [
        ("proximal", {"planar-rrr", "planar-rrr-drawn", "rrrp-proximal"}),
        ("modified", {"planar-rrr", "planar-rrr-drawn", "rrrp-proximal"}),
        ("6dof", {"stanford-arm", "stanford-arm-d1", "stanford-arm-drawn"}),
        ("7R", {"baxter-left-arm"}),
        ("puma", {"spatial-rrr", "spherical-wrist"}),
        ("scara", {"scara", "rrrp", "rrrp-drawn", "rrrp-proximal"}),
        ("spherical", {"spherical-wrist", "stanford-arm", "stanford-arm-d1", "stanford-arm-drawn"}),
        ("RPP", {"three-link-cylindrical"}),
    ],
)
def test_a_word_finds_the_exercises_that_it_means(query: str, expected: set[str]) -> None:
    shipped = shipped_exercises()
    found = {
        name for name, each in shipped.items() if query.lower() in words_of(each).lower().split()
    }
    assert found == expected


def test_words_of_conventions_and_joints_find_every_exercise_with_them() -> None:
    for each in shipped_exercises().values():
        words = words_of(each).split()
        assert ("prismatic" in words) == ("P" in (each.structure or ""))
        assert ("distal" in words) == ("standard" in each.conventions)
