"""The list of exercise files that the tests have checked."""

from dh_grader.catalogue.load import checked_digests

from tests.catalogue.checked import digests


def test_the_list_has_the_shipped_exercises_as_they_are() -> None:
    assert dict(checked_digests()) == digests(), "an exercise has changed; run make pages"
