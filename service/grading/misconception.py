"""The list of all misconceptions, and the search for the one that explains a wrong answer.

A misconception is a function and its description (record). The function takes a wrong answer and
yields hypotheses: numbers to compare with the answer, each with its message. ::

    @misconception(
        of=WrongPosition,
        rank=20,
        code="reversed_position",
        rule="position_vector",
        means="all signs are wrong: the vector leads from the point to the origin",
        example=("planar-rr", "position", "[-a1 c1 - a2 c12, -a1 s1 - a2 s12]"),
        unlike="[a1 c1 + a2 c12, -a1 s1 - a2 s12]",
    )
    def reversed_position(case: WrongPosition) -> Hypotheses:
        yield Written(-case.expected, "Every coordinate has the wrong sign.")

A check is a similar function, which returns a finding (a message) or None.
"""

# A check is for a slip without numbers to compare, such as a formula without a value or a
# left-handed frame. If several records explain an answer, the record of the lowest rank counts; the
# order of imports has no effect. The pages of docs that list codes are generated from the records.
# tests/grading/diagnosis/test_diagnosis.py submits the examples.

from collections.abc import Callable, Iterable, Iterator
from dataclasses import dataclass, field, replace
from functools import cache, partial
from types import EllipsisType
from typing import Any, Final, Generic, Protocol, TypeAlias, TypeVar

import numpy as np
from numpy.typing import NDArray

from service.grading.feedback import Finding
from service.grading.report import RuleName, Severity
from service.time_slices import checkpoint

Answer = TypeVar("Answer")
Source = TypeVar("Source")
AnyFunction = TypeVar("AnyFunction", bound=Callable[..., Any])
Index: TypeAlias = EllipsisType | tuple[slice, slice] | NDArray[np.bool_]

# Exercise, part and answer; then "degrees" if bare numbers are degrees.
Example: TypeAlias = tuple[str, str, Any] | tuple[str, str, Any, str]


@dataclass(frozen=True, slots=True, kw_only=True, eq=False)
class Record:
    """A misconception or a check: its function, and the description for docs and tests."""

    # The record is tried on answers of this class that meet ``when``.
    of: type
    # Records are tried in the order of their ranks.
    rank: int
    # Findings have the first code, unless they name another. A record without a code passes on the
    # findings of other records.
    codes: tuple[str, ...] = ()
    # The text in the docs: one text for all codes, or one for each code.
    means: str | tuple[str, ...] = ""
    # The rule of DH or of kinematics that the hints explain.
    rule: RuleName | None = None
    # An answer that the record explains: what a student sends, or the changed cells of the model
    # answer, {"2/alpha": "0"}.
    example: Example | None = None
    # An answer to the same part that the record does not explain, in the same form.
    unlike: Any = None
    when: Callable[[Any], bool] | None = None
    function: Callable[[Any], Any] | None = None
    is_check: bool = False
    name: str = ""

    @property
    def code(self) -> str:
        """The first code of the misconception."""
        return self.codes[0]

    def meaning(self, code: str) -> str:
        """Return the description of a code for the docs."""
        return self.means if isinstance(self.means, str) else self.means[self.codes.index(code)]

    def finding(
        self, hint: str, correction: str = "", severity: Severity = Severity.ERROR
    ) -> Finding:
        """Return a finding with the code of this misconception."""
        # For a record without a function.
        return Finding(self.code, hint, correction, severity, rule=self.rule)

    def hypotheses(self, source: object) -> Iterable["Hypothesis[Any]"]:
        """Return the hypotheses (possible mistakes) about a wrong answer."""
        if self.function is None or self.is_check or (self.when and not self.when(source)):
            return ()
        found: Iterable[Hypothesis[Any]] = self.function(source)
        return found

    def verdict(self, source: object) -> "Hypothesis[Any] | None":
        """Return the finding of a check, or None if the answer passes the check."""
        found = None
        if self.function and (self.when is None or self.when(source)):
            found = self.function(source)
        return found if found is None or isinstance(found, Hypothesis) else Hypothesis(None, found)


_RECORDS: Final[list[Record]] = []


def register(
    *,
    of: type,
    rank: int = 0,
    code: str | tuple[str, ...] = (),
    name: str = "",
    **known: Any,
) -> Record:
    """Add a misconception or a check to the list of all records, and return its record.

    ``known`` has values for more fields of the record.
    """
    # Without a function, the record only documents a code; other functions make findings with this
    # code.
    codes = (code,) if isinstance(code, str) else code
    record = Record(of=of, rank=rank, codes=codes, name=name or codes[0], **known)
    _RECORDS.append(record)
    records_of.cache_clear()
    return record


def misconception(
    *, of: type, rank: int, code: str | tuple[str, ...] = (), **known: Any
) -> Callable[[AnyFunction], AnyFunction]:
    """Decorate a function that yields hypotheses, and register it as a misconception."""
    # The arguments are the fields of its Record.
    add = partial(register, of=of, rank=rank, code=code, **known)

    def registered(function: AnyFunction) -> AnyFunction:
        name = f"{function.__module__.rpartition('.')[2]}.{function.__name__}"
        add(name=name, function=function)
        return function

    return registered


def check(
    *, of: type, rank: int, code: str | tuple[str, ...] = (), **known: Any
) -> Callable[[AnyFunction], AnyFunction]:
    """Decorate a function that returns a finding or None, and register it as a check."""
    # The arguments are the fields of its Record.
    return misconception(of=of, rank=rank, code=code, is_check=True, **known)


@cache
def records_of(kind: type) -> tuple[Record, ...]:
    """Return the misconceptions about a class of wrong answers, sorted by rank."""
    found = (each for each in _RECORDS if each.function and each.of in kind.__mro__)
    return tuple(sorted(found, key=lambda record: (record.rank, record.name)))


def all_records() -> tuple[Record, ...]:
    """Return all registered misconceptions and checks."""
    return tuple(_RECORDS)


def says(hint: str, correction: str = "") -> Finding:
    """Return a finding with this hint."""
    # The engine adds the code of the misconception.
    return Finding("", hint, correction)


@dataclass(slots=True)
class Hypothesis(Generic[Answer]):
    """A possible mistake: the answer that it leads to, and the message about it."""

    answer: Answer
    # A function if it is slow to build or names two misconceptions at once.
    finding: str | Finding | Callable[[], Finding | tuple[Finding, ...]]
    # The entries of the answer that the hypothesis explains.
    entries: Index = ...
    # The engine sets it to the record of the misconception.
    record: Record | None = field(default=None, kw_only=True)

    @property
    def findings(self) -> tuple[Finding, ...]:
        """The findings, one for each misconception."""
        found = self.finding() if callable(self.finding) else self.finding
        if isinstance(found, str):
            found = says(found)
        several = (found,) if isinstance(found, Finding) else found
        if self.record is None or not self.record.codes:
            return several
        record = self.record
        coded = (each if each.code else replace(each, code=record.code) for each in several)
        return tuple(replace(each, rule=each.rule or record.rule) for each in coded)


@dataclass(slots=True)
class Written(Hypothesis[Answer]):
    """The answer that a misconception leads to.

    The misconception explains every submitted answer that is equal to this answer.
    """

    # Replaces the usual tolerance of the comparison.
    tolerance: float | None = None


@dataclass(slots=True)
class Repaired(Hypothesis[Answer]):
    """The student's answer with a possible mistake corrected.

    The mistake explains the answer if the corrected answer is right.
    """


Explained: TypeAlias = Hypothesis[Any]
AnyHypothesis = TypeVar("AnyHypothesis", bound=Hypothesis[Any])


class WrongAnswer(Protocol):
    """A wrong answer, with the data for its diagnosis."""

    def explained_by(self, hypotheses: Iterable[AnyHypothesis]) -> Iterable[AnyHypothesis]:
        """Return the hypotheses (possible mistakes) that explain the answer."""
        # A Written hypothesis that is equal to the correct answer explains nothing. Nor does a
        # Repaired hypothesis that is equal to the student's answer.
        ...


def hypotheses_of(source: object, of: type | None = None) -> Iterator[Explained]:
    """Yield the hypotheses (possible mistakes) of all misconceptions about ``source``."""
    return each_hypothesis(records_of(of or type(source)), source)


def each_hypothesis(records: Iterable[Record], source: object) -> Iterator[Explained]:
    """Yield the hypotheses (possible mistakes) of these misconceptions."""
    for record in records:
        for hypothesis in record.hypotheses(source):
            hypothesis.record = hypothesis.record or record
            yield hypothesis


def explanation(
    case: WrongAnswer, source: object = None, of: type | None = None
) -> Explained | None:
    """Return the first hypothesis (possible mistake) that explains ``case``, or None.

    The functions of misconceptions get ``source``, by default ``case``.
    """
    # For example, source are the links whose product a matrix is. Only misconceptions about the
    # class of are tried, by default the class of source.
    start = case if source is None else source
    for record in records_of(of or type(start)):
        checkpoint()
        if (found := explained_by_one(record, case, start)) is not None:
            return found
    return None


def explained_by_one(record: Record, case: WrongAnswer, source: object) -> Explained | None:
    """Return the hypothesis (possible mistake) of this misconception that explains ``case``."""
    found: Explained | None
    if record.is_check:
        found = record.verdict(source)
    else:
        found = next(iter(case.explained_by(record.hypotheses(source))), None)
    if found is not None:
        found.record = found.record or record
    return found


def diagnosed(case: WrongAnswer, source: object = None, of: type | None = None) -> Finding | None:
    """Return the finding of the first misconception that explains ``case``, or None."""
    found = explanation(case, source, of)
    return found.findings[0] if found else None
