import pytest

from service.attempts.outcome import Outcome
from service.attempts.regrades.memoized_reports import KeptReports, WrittenReport
from service.catalogue import FeedbackLevel

HINTS, SCORE = FeedbackLevel.HINTS, FeedbackLevel.SCORE


def report(text: str) -> WrittenReport:
    return WrittenReport(text, 1.0, 2.0, {}, Outcome("scara", "{}"))


def graded_again() -> WrittenReport:
    pytest.fail("It was graded again.")


def test_the_same_answers_at_the_same_level_are_graded_once() -> None:
    kept = KeptReports()
    first = kept.of("answers", HINTS, lambda: report("hints"))
    assert kept.of("answers", HINTS, graded_again) is first
    assert kept.of("answers", SCORE, lambda: report("score")).text == "score"
    assert kept.of("others", HINTS, lambda: report("of others")).text == "of others"


def test_what_was_asked_for_longest_ago_goes_first_and_long_reports_count_for_more() -> None:
    kept = KeptReports(most_bytes=100_000)
    for name in "abc":
        kept.of(name, HINTS, lambda: report("x" * 20_000))
    kept.of("a", HINTS, graded_again)
    # There is room for four of this length; another 40,000 bytes take the place of two.
    kept.of("d" * 20_000, HINTS, lambda: report("x" * 20_000))
    kept.of("a", HINTS, graded_again)
    kept.of("c", HINTS, graded_again)
    assert kept.of("b", HINTS, lambda: report("anew")).text == "anew"


def test_a_report_that_is_too_long_is_given_and_not_kept() -> None:
    kept = KeptReports(most_bytes=10_000)
    assert kept.of("answers", HINTS, lambda: report("x" * 20_000)).text[0] == "x"
    assert kept.of("answers", HINTS, lambda: report("y" * 20_000)).text[0] == "y"
