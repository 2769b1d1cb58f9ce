import pytest
from dh_grader.catalogue import FeedbackLevel
from dh_grader.store import Outcome
from dh_grader.store.regrades import MemoizedReports, WrittenReport

HINTS, SCORE = FeedbackLevel.HINTS, FeedbackLevel.SCORE


def report(text: str) -> WrittenReport:
    return WrittenReport(text, 1.0, 2.0, {}, Outcome("scara", "{}"), "v1")


def graded_again() -> WrittenReport:
    pytest.fail("It was graded again.")


def test_the_same_answers_at_the_same_level_are_graded_once() -> None:
    memoized = MemoizedReports()
    first = memoized.get("answers", HINTS, lambda: report("hints"))
    assert memoized.get("answers", HINTS, graded_again) is first
    assert memoized.get("answers", SCORE, lambda: report("score")).text == "score"
    assert memoized.get("others", HINTS, lambda: report("of others")).text == "of others"


def test_the_least_recently_used_report_is_dropped_first() -> None:
    memoized = MemoizedReports(most_bytes=100_000)
    for name in "abc":
        memoized.get(name, HINTS, lambda: report("x" * 20_000))
    memoized.get("a", HINTS, graded_again)
    # Four reports of this length fit; 40,000 more bytes displace two.
    memoized.get("d" * 20_000, HINTS, lambda: report("x" * 20_000))
    memoized.get("a", HINTS, graded_again)
    memoized.get("c", HINTS, graded_again)
    assert memoized.get("b", HINTS, lambda: report("new")).text == "new"


def test_a_report_over_the_limit_is_not_memoized() -> None:
    memoized = MemoizedReports(most_bytes=10_000)
    assert memoized.get("answers", HINTS, lambda: report("x" * 20_000)).text[0] == "x"
    assert memoized.get("answers", HINTS, lambda: report("y" * 20_000)).text[0] == "y"
