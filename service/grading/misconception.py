"""The records of all misconceptions, and the engine that finds the one that explains an answer.

A misconception is a function with its record. The function takes a wrong answer and yields
hypotheses: numbers to compare with the answer, each with the words of its message. ::

    @misconception(
        of=WrongPosition,
        rank=20,
        code="reversed_position",
        means="all signs are wrong: the vector leads from the point to the origin",
        example=("planar-rr", "position", "[-a1 c1 - a2 c12, -a1 s1 - a2 s12]"),
        unlike="[a1 c1 + a2 c12, -a1 s1 - a2 s12]",
    )
    def reversed_position(case: WrongPosition) -> Hypotheses:
        yield Written(-case.expected, "Every coordinate has the wrong sign.")

A check has a record, too. It returns a finding or None, where there is nothing to compare: a
formula has no value, a frame is left-handed. Of several that fit, the one of the lowest rank
explains the answer, however files are imported. The pages of docs that list codes are made from the
records, and ``tests/grading/diagnosis/test_diagnosis.py`` hands the examples in.
"""

from collections.abc import Callable, Iterable, Iterator
from dataclasses import dataclass, field, replace
from functools import cache, partial
from types import EllipsisType
from typing import Any, Final, Generic, Protocol, TypeAlias, TypeVar

import numpy as np
from numpy.typing import NDArray

from service.grading.feedback import Finding
from service.grading.report import Severity
from service.time_slices import checkpoint

Answer = TypeVar("Answer")
Source = TypeVar("Source")
AnyFunction = TypeVar("AnyFunction", bound=Callable[..., Any])
Index: TypeAlias = EllipsisType | tuple[slice, slice] | NDArray[np.bool_]

# Exercise and part, then the answer; "degrees" behind it, if numbers are degrees.
Example: TypeAlias = tuple[str, str, Any] | tuple[str, str, Any, str]


@dataclass(frozen=True, slots=True, kw_only=True, eq=False)
class Record:
    """A misconception or a check.

    It is asked about each answer that is a case ``of`` that class and meets ``when``, in the order
    of ``rank``. It gives the first of ``codes``, unless its finding has another of them. ``means``
    says in docs what the code means, or what each of several codes does. ``example`` is an answer
    that it explains, ``unlike`` an answer to the same part that it leaves alone. An answer is what
    a student sends, or a mapping of cells ("2/alpha") to what is written there in the model answer.
    A record without a code passes on the findings of others.
    """

    of: type
    rank: int
    codes: tuple[str, ...] = ()
    means: str | tuple[str, ...] = ""
    example: Example | None = None
    unlike: Any = None
    when: Callable[[Any], bool] | None = None
    function: Callable[[Any], Any] | None = None
    is_check: bool = False
    name: str = ""

    @property
    def code(self) -> str:
        """The code of a finding that has no other."""
        return self.codes[0]

    def meaning(self, code: str) -> str:
        """Return the meaning of one of the codes."""
        return self.means if isinstance(self.means, str) else self.means[self.codes.index(code)]

    def finding(
        self, hint: str, correction: str = "", severity: Severity = Severity.ERROR
    ) -> Finding:
        """Return a finding with the code, for a record without a function."""
        return Finding(self.code, hint, correction, severity)

    def hypotheses(self, source: object) -> Iterable["Hypothesis[Any]"]:
        """The hypotheses about a wrong answer; each is built when it is asked for."""
        if self.function is None or self.is_check or (self.when and not self.when(source)):
            return ()
        found: Iterable[Hypothesis[Any]] = self.function(source)
        return found

    def verdict(self, source: object) -> "Hypothesis[Any] | None":
        """Return the finding of a check, or None if the answer passes it."""
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
    """Add a record; ``code`` may be several, and ``known`` are other fields of Record.

    A record without a function is for a code that the engine does not give.
    """
    codes = (code,) if isinstance(code, str) else code
    record = Record(of=of, rank=rank, codes=codes, name=name or codes[0], **known)
    _RECORDS.append(record)
    records_of.cache_clear()
    return record


def misconception(
    *, of: type, rank: int, code: str | tuple[str, ...] = (), **known: Any
) -> Callable[[AnyFunction], AnyFunction]:
    """Register a function that yields hypotheses, with the fields of its Record."""
    add = partial(register, of=of, rank=rank, code=code, **known)

    def registered(function: AnyFunction) -> AnyFunction:
        name = f"{function.__module__.rpartition('.')[2]}.{function.__name__}"
        add(name=name, function=function)
        return function

    return registered


def check(
    *, of: type, rank: int, code: str | tuple[str, ...] = (), **known: Any
) -> Callable[[AnyFunction], AnyFunction]:
    """Register a function that returns a finding or None, with the fields of its Record."""
    return misconception(of=of, rank=rank, code=code, is_check=True, **known)


@cache
def records_of(kind: type) -> tuple[Record, ...]:
    """The records of a kind of case and of its base classes, in the order of their ranks."""
    found = (each for each in _RECORDS if each.function and each.of in kind.__mro__)
    return tuple(sorted(found, key=lambda record: (record.rank, record.name)))


def all_records() -> tuple[Record, ...]:
    """The records of all files that are imported."""
    return tuple(_RECORDS)


def says(hint: str, correction: str = "") -> Finding:
    """Return the words of a message; the engine adds the code of the record."""
    return Finding("", hint, correction)


@dataclass(slots=True)
class Hypothesis(Generic[Answer]):
    """An answer that a misconception leads to, with the words of its message.

    ``finding`` may be a function, where it takes long to build or names two misconceptions at once.
    ``entries`` are the entries of the answer that the hypothesis explains. ``record`` is that of
    the misconception; the engine fills it in.
    """

    answer: Answer
    finding: str | Finding | Callable[[], Finding | tuple[Finding, ...]]
    entries: Index = ...
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
        return tuple(each if each.code else replace(each, code=record.code) for each in several)


@dataclass(slots=True)
class Written(Hypothesis[Answer]):
    """What a student with the misconception writes: it explains an answer that is equal to it.

    ``tolerance`` is how far numbers may differ, where that is not the usual tolerance.
    """

    tolerance: float | None = None


@dataclass(slots=True)
class Repaired(Hypothesis[Answer]):
    """The student's answer without the misconception: it explains the answer if it is right."""


Explained: TypeAlias = Hypothesis[Any]
AnyHypothesis = TypeVar("AnyHypothesis", bound=Hypothesis[Any])


class WrongAnswer(Protocol):
    """An answer that is not right, with all that its diagnosis needs."""

    def explained_by(self, hypotheses: Iterable[AnyHypothesis]) -> Iterable[AnyHypothesis]:
        """Those hypotheses that explain the answer, in their order.

        A hypothesis that would change nothing explains nothing: a ``Written`` one that is right, a
        ``Repaired`` one that is what was written.
        """
        ...


def hypotheses_of(source: object, of: type | None = None) -> Iterator[Explained]:
    """The hypotheses of all misconceptions; each is built when it is asked for."""
    return each_hypothesis(records_of(of or type(source)), source)


def each_hypothesis(records: Iterable[Record], source: object) -> Iterator[Explained]:
    """The hypotheses of these records; each is built when it is asked for."""
    for record in records:
        for hypothesis in record.hypotheses(source):
            hypothesis.record = hypothesis.record or record
            yield hypothesis


def explanation(
    case: WrongAnswer, source: object = None, of: type | None = None
) -> Explained | None:
    """The hypothesis of the lowest rank that explains ``case``, or None.

    Misconceptions are functions of ``case``, or of ``source`` where there is one: the links that a
    matrix is the product of, for example. Their records are those of its class, or of the kind
    ``of`` case. Each is tried only if those before it explain nothing.
    """
    start = case if source is None else source
    for record in records_of(of or type(start)):
        checkpoint()
        if (found := explained_by_one(record, case, start)) is not None:
            return found
    return None


def explained_by_one(record: Record, case: WrongAnswer, source: object) -> Explained | None:
    """The hypothesis of this record that explains ``case``, or None."""
    found: Explained | None
    if record.is_check:
        found = record.verdict(source)
    else:
        found = next(iter(case.explained_by(record.hypotheses(source))), None)
    if found is not None:
        found.record = found.record or record
    return found


def diagnosed(case: WrongAnswer, source: object = None, of: type | None = None) -> Finding | None:
    """The finding of the record of the lowest rank that explains ``case``, or None."""
    found = explanation(case, source, of)
    return found.findings[0] if found else None
