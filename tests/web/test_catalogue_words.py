"""Test the words by which the search finds exercises."""

import pytest
from dh_grader.web.pages import words_of

from tests.shipped import shipped_exercises

SEVEN = ("franka-research-3", "kuka-lbr-iiwa-7", "kinova-gen3", "sawyer")
MODIFIED = {
    "planar-rrr", "planar-rrr-drawn", "planar-rrr-frames", "rrrp-proximal", "franka-research-3",
    "kuka-lbr-iiwa-7", "kinova-gen3", "puma-560-craig", "find-the-slip-stanford",
    "first-arm-modified", "planar-rrr-faded",
}  # fmt: skip


@pytest.mark.parametrize(
    ("query", "expected"),
    [
        ("proximal", MODIFIED),
        ("modified", MODIFIED),
        ("7dof", {"baxter-left-arm", *SEVEN}),
        ("7R", {"baxter-left-arm", *SEVEN}),
        ("puma", {"spatial-rrr", "spherical-wrist", "puma-560", "puma-560-craig"}),
        (
            "scara",
            {"scara", "rrrp", "rrrp-drawn", "rrrp-proximal", "adept-cobra-600", "vertical-axes"}
            | {"find-the-slip-scara", "scara-faded"},
        ),
        ("e-Series", {"ur3e", "ur5e", "ur10e", "ur16e"}),
        ("KUKA", {"kuka-kr-5-arc", "kuka-kr-10-r1100", "kuka-lbr-iiwa-7", "kuka-youbot-arm"}),
        ("gantry", {"abb-irb-6620lx", "three-link-cartesian"}),
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
