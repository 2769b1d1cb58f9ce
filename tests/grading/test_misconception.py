"""Find the misconception that explains a wrong answer."""

from collections.abc import Iterable, Iterator
from dataclasses import dataclass, field
from typing import Any

import pytest
from dh_grader.grading import misconception as engine
from dh_grader.grading.misconception import (
    AnyHypothesis,
    Written,
    check,
    diagnosed,
    explanation,
    hypotheses_of,
    misconception,
    register,
    says,
)
from dh_grader.grading.report import Finding


@dataclass
class WrongNumber:
    """A wrong number that records the hypotheses compared with it."""

    actual: int
    tried: list[int] = field(default_factory=list)

    def explained_by(self, hypotheses: Iterable[AnyHypothesis]) -> Iterator[AnyHypothesis]:
        for hypothesis in hypotheses:
            self.tried.append(hypothesis.answer)
            if hypothesis.answer == self.actual:
                yield hypothesis


class Text(str):
    """A text for a misconception to explain."""


@pytest.fixture(autouse=True)
def records(monkeypatch: pytest.MonkeyPatch) -> Iterator[None]:
    monkeypatch.setattr(engine, "_RECORDS", [])
    engine.records_of.cache_clear()

    @misconception(of=WrongNumber, rank=20, code="large")
    def too_large(_case: object) -> Iterator[Written[int]]:
        yield Written(8, "Eight.")

    @misconception(of=WrongNumber, rank=10, code="small")
    def too_small(_case: object) -> Iterator[Written[int]]:
        yield Written(1, says("One.", "Add one."))
        yield Written(2, lambda: (Finding("two", "Two."), says("Small.")))

    @misconception(of=WrongNumber, rank=15, code="half", when=lambda case: case.actual > 100)
    def too_large_by_half(_case: object) -> Iterator[Written[int]]:
        yield Written(150, "Half.")

    @check(of=WrongNumber, rank=5, code="negative")
    def negative(case: WrongNumber) -> Finding | None:
        return says("Negative.") if case.actual < 0 else None

    @misconception(of=Text, rank=10, code="length")
    def of_text(text: Text) -> Iterator[Written[int]]:
        yield Written(len(text), str(text))

    yield
    engine.records_of.cache_clear()


def codes(found: Any) -> list[str]:
    assert found is not None
    return [finding.code for finding in found.findings]


def test_the_search_ends_at_the_first_explanation() -> None:
    case = WrongNumber(1)
    assert codes(explanation(case)) == ["small"]
    assert case.tried == [1]


def test_the_rank_decides_and_not_the_order_of_registration() -> None:
    case = WrongNumber(8)
    assert codes(explanation(case)) == ["large"]
    assert case.tried == [1, 2, 8]
    assert explanation(WrongNumber(5)) is None


def test_two_misconceptions_give_two_findings() -> None:
    assert codes(explanation(WrongNumber(2))) == ["two", "small"]


def test_a_correction_beside_the_hint() -> None:
    finding = diagnosed(WrongNumber(1))
    assert finding is not None
    assert (finding.code, finding.hint, finding.correction) == ("small", "One.", "Add one.")


def test_a_misconception_may_be_a_function_of_something_else() -> None:
    assert codes(explanation(WrongNumber(3), Text("abc"))) == ["length"]
    assert codes(explanation(WrongNumber(3), "abc", of=Text)) == ["length"]


def test_a_check_is_ranked_like_a_misconception() -> None:
    assert codes(explanation(WrongNumber(-1))) == ["negative"]


def test_a_misconception_that_does_not_concern_a_case_is_not_tried() -> None:
    few, many = WrongNumber(99), WrongNumber(150)
    assert explanation(few) is None
    assert 150 not in few.tried
    assert codes(explanation(many)) == ["half"]


def test_a_case_has_the_records_of_its_base_classes() -> None:
    class Special(WrongNumber):
        pass

    assert codes(explanation(Special(8))) == ["large"]


def test_a_record_that_is_registered_later_is_found() -> None:
    assert explanation(WrongNumber(7)) is None

    @misconception(of=WrongNumber, rank=1, code="seven")
    def seven(_case: object) -> Iterator[Written[int]]:
        yield Written(7, "Seven.")

    assert codes(explanation(WrongNumber(7))) == ["seven"]


def test_a_code_without_a_function_gives_its_finding() -> None:
    record = register(of=WrongNumber, code="other")
    assert record.finding("Look.", "Do.") == Finding("other", "Look.", "Do.")
    assert explanation(WrongNumber(5)) is None


def test_hypotheses_in_the_order_of_the_ranks() -> None:
    assert [each.answer for each in hypotheses_of(WrongNumber(0))] == [1, 2, 8]
