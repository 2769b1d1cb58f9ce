"""The form of every misconception, and the engine that finds the one that explains an answer.

A misconception is a function. It takes a wrong answer and yields hypotheses: numbers to compare
with the answer, each with the finding that names the misconception. ::

    def sign(case: WrongValue) -> Hypotheses:
        yield Written(-case.expected, Finding("sign", "The sign of this angle is wrong."))

A check is a function too. It takes a wrong answer and returns a finding or None, where there is
nothing to compare: a formula has no value, a frame is left-handed. Each file of ``diagnosis`` lists
its misconceptions and its checks in tuples; of several that fit, the first is taken.
"""

from collections.abc import Callable, Iterable, Iterator
from dataclasses import dataclass
from itertools import chain
from types import EllipsisType
from typing import Any, Generic, Protocol, TypeAlias, TypeVar

import numpy as np
from numpy.typing import NDArray

from service.grading.feedback import Finding
from service.time_slices import checkpoint

Answer = TypeVar("Answer")
Source = TypeVar("Source")
Index: TypeAlias = EllipsisType | tuple[slice, slice] | NDArray[np.bool_]


@dataclass(frozen=True, slots=True)
class Hypothesis(Generic[Answer]):
    """An answer that a misconception leads to, with the finding that names the misconception.

    ``finding`` may be a function, where it takes long to build or names two misconceptions at once.
    ``entries`` are the entries of the answer that the hypothesis explains.
    """

    answer: Answer
    finding: Finding | Callable[[], Finding | tuple[Finding, ...]]
    entries: Index = ...

    @property
    def findings(self) -> tuple[Finding, ...]:
        """The findings, one for each misconception."""
        found = self.finding if isinstance(self.finding, Finding) else self.finding()
        return (found,) if isinstance(found, Finding) else found


@dataclass(frozen=True, slots=True)
class Written(Hypothesis[Answer]):
    """What a student with the misconception writes: it explains an answer that is equal to it.

    ``tolerance`` is how far numbers may differ, where that is not the usual tolerance.
    """

    tolerance: float | None = None


@dataclass(frozen=True, slots=True)
class Repaired(Hypothesis[Answer]):
    """The student's answer without the misconception: it explains the answer if it is right."""


AnyHypothesis = TypeVar("AnyHypothesis", bound=Hypothesis[Any])


class WrongAnswer(Protocol):
    """An answer that is not right, with all that its diagnosis needs."""

    def explained_by(self, hypotheses: Iterable[AnyHypothesis]) -> Iterable[AnyHypothesis]:
        """Those hypotheses that explain the answer, in their order.

        A hypothesis that would change nothing explains nothing: a ``Written`` one that is right, a
        ``Repaired`` one that is what was written.
        """
        ...


def hypotheses_of(
    source: Source, misconceptions: Iterable[Callable[[Source], Iterable[AnyHypothesis]]]
) -> Iterator[AnyHypothesis]:
    """The hypotheses of all misconceptions; each is built when it is asked for."""
    return chain.from_iterable(misconception(source) for misconception in misconceptions)


def explanation(
    case: WrongAnswer,
    misconceptions: Iterable[Callable[[Any], Iterable[AnyHypothesis]]],
    source: object = None,
) -> AnyHypothesis | None:
    """The first hypothesis that explains ``case``, or None.

    Misconceptions are functions of ``case``, or of ``source`` where there is one: the links that a
    matrix is the product of, for example. Each is tried only if those before it explain nothing.
    """
    start = case if source is None else source
    for misconception in misconceptions:
        checkpoint()
        for hypothesis in case.explained_by(misconception(start)):
            return hypothesis
    return None


def diagnosed(
    case: WrongAnswer,
    misconceptions: Iterable[Callable[[Any], Iterable[Hypothesis[Any]]]],
    checks: Iterable[Callable[[Any], Finding | None]] = (),
) -> Finding | None:
    """The finding of the first check that fails, else of the first misconception that explains."""
    for check in checks:
        if (finding := check(case)) is not None:
            return finding
    found = explanation(case, misconceptions)
    return found.findings[0] if found else None
