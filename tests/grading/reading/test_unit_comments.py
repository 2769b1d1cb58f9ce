"""Read comments that name a unit of length."""

from collections.abc import Mapping

import pytest
from dh_grader.catalogue import Exercise
from dh_grader.grading import Verdict

from tests.grading.support.submitting import handed_in, part

POSE = "[1 0 0 400; 0 1 0 0; 0 0 1 300; 0 0 0 1]"
# An exercise, its part, and a text without a comment.
TEXTS = [
    ("puma-560", "home", f"T = {POSE};"),
    ("planar-rr-numbers", "position", "p = [300; 400]"),
    ("spatial-rrr", "links", f"A1 = {POSE};\nA2 = {POSE};\nA3 = {POSE};"),
]
each_text = pytest.mark.parametrize(("exercise", "answered", "text"), TEXTS)


@each_text
@pytest.mark.parametrize("comment", ["% lengths in mm", "# Längen in Millimetern, Winkel in Grad"])
def test_a_comment_with_another_unit_is_refused(
    exercise: str, answered: str, text: str, comment: str, catalogue: Mapping[str, Exercise]
) -> None:
    graded = part(handed_in(catalogue[exercise], {answered: f"{comment}\n{text}"}), answered)
    assert graded.verdict is Verdict.UNREADABLE
    assert [message.code for message in graded.feedback] == ["text_around"]


@each_text
@pytest.mark.parametrize("comment", ["% at the home pose", "% 2 mm of play", ""])
def test_other_comments_are_ignored(
    exercise: str, answered: str, text: str, comment: str, catalogue: Mapping[str, Exercise]
) -> None:
    graded = part(handed_in(catalogue[exercise], {answered: f"{comment}\n{text}"}), answered)
    assert graded.verdict not in {Verdict.UNREADABLE, Verdict.CORRECT}


def test_a_text_that_converts_its_lengths_is_read(catalogue: Mapping[str, Exercise]) -> None:
    text = "% mm\np = [300/1000; 400/1000]"
    graded = part(handed_in(catalogue["planar-rr-numbers"], {"position": text}), "position")
    assert "text_around" not in [message.code for message in graded.feedback]


def test_the_unit_of_the_exercise_is_ignored(catalogue: Mapping[str, Exercise]) -> None:
    text = f"% all lengths in metres\n{POSE}"
    graded = part(handed_in(catalogue["rrrp"], {"pose": text}), "pose")
    assert graded.verdict is not Verdict.UNREADABLE


def test_angles_have_no_unit_of_length(catalogue: Mapping[str, Exercise]) -> None:
    text = "% lengths in mm\nR = [1 0 0; 0 1 0; 0 0 1];"
    graded = part(handed_in(catalogue["fundamental-rotations"], {"about-x": text}), "about-x")
    assert graded.verdict is not Verdict.UNREADABLE
