"""The engine that finds the misconception behind a wrong answer."""

from collections.abc import Iterable, Iterator
from dataclasses import dataclass, field

from service.grading.feedback import Finding
from service.grading.misconception import (
    AnyHypothesis,
    Written,
    diagnosed,
    explanation,
    hypotheses_of,
)


@dataclass
class WrongNumber:
    """A number; ``tried`` collects the hypotheses that it was compared with."""

    actual: int
    tried: list[int] = field(default_factory=list)

    def explained_by(self, hypotheses: Iterable[AnyHypothesis]) -> Iterator[AnyHypothesis]:
        for hypothesis in hypotheses:
            self.tried.append(hypothesis.answer)
            if hypothesis.answer == self.actual:
                yield hypothesis


def too_small(_case: object) -> Iterator[Written[int]]:
    yield Written(1, Finding("one", "One."))
    yield Written(2, lambda: (Finding("two", "Two."), Finding("small", "Small.")))


def too_large(_case: object) -> Iterator[Written[int]]:
    yield Written(8, Finding("eight", "Eight."))


def negative(case: WrongNumber) -> Finding | None:
    return Finding("negative", "Negative.") if case.actual < 0 else None


def test_the_search_ends_at_the_first_explanation() -> None:
    case = WrongNumber(1)
    found = explanation(case, (too_small, too_large))
    assert found is not None
    assert [finding.code for finding in found.findings] == ["one"]
    assert case.tried == [1]


def test_each_misconception_is_tried_until_one_explains() -> None:
    case = WrongNumber(8)
    assert explanation(case, (too_small, too_large)) is not None
    assert case.tried == [1, 2, 8]
    assert explanation(WrongNumber(5), (too_small, too_large)) is None


def test_two_misconceptions_give_two_findings() -> None:
    found = explanation(WrongNumber(2), (too_small,))
    assert found is not None
    assert [finding.code for finding in found.findings] == ["two", "small"]


def test_a_misconception_may_be_a_function_of_something_else() -> None:
    def of_text(text: str) -> Iterator[Written[int]]:
        yield Written(len(text), Finding("length", text))

    assert explanation(WrongNumber(3), (of_text,), "abc") is not None


def test_checks_are_tried_first() -> None:
    def code(case: WrongNumber) -> str | None:
        finding = diagnosed(case, (too_small,), (negative,))
        return finding.code if finding else None

    assert [code(WrongNumber(n)) for n in (-1, 1, 5)] == ["negative", "one", None]


def test_hypotheses_are_tried_in_the_order_of_the_list() -> None:
    assert [each.answer for each in hypotheses_of(0, (too_large, too_small))] == [8, 1, 2]
