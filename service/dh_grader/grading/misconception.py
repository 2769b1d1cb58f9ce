"""The list of all misconceptions, and the search for the one that explains a wrong answer.

The misconceptions themselves are in ``diagnosis``; they only say which numbers a slip would give.

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

A check is a similar function, which returns a finding (a message) or None. It is for a slip without
numbers to compare, such as a formula without a value or a left-handed frame.
"""

import math
from collections.abc import Callable, Iterable, Iterator, Mapping
from dataclasses import dataclass, field, replace
from fractions import Fraction
from functools import cache, cached_property, partial
from types import EllipsisType
from typing import Any, ClassVar, Final, Generic, Protocol, TypeAlias, TypeVar

import numpy as np
from numpy.typing import ArrayLike, NDArray

from dh_grader.catalogue import Exercise, Joint
from dh_grader.expressions import Expression
from dh_grader.expressions.printing import PLAIN, Spelling, to_latex, to_text
from dh_grader.expressions.vocabulary import Binary, Negation, Node, Number, Pi, SymbolNode, Unit
from dh_grader.grading.numbers import (
    CONSTANT,
    HALF,
    PRINTED_NUMBER,
    WHOLE_MULTIPLE,
    Samples,
    coefficients,
    difference,
    nearly_equal,
    rounding_slack,
    same,
)
from dh_grader.grading.report import EXPECTED, YOURS, Correction, Finding, RuleName, Severity
from dh_grader.kinematics import ALPHA, THETA, Numbers
from dh_grader.slices import checkpoint
from dh_grader.translations import Sentence, listed, say

# --- Phrases that several kinds of messages contain


# The symbol of each table column, and the axis along or about which it is measured.
SYMBOLS = ("a", "α", "d", "θ")
AXES = ("x", "x", "z", "z")
# Lengths in another unit are too large by one of these factors.
UNIT_FACTORS: Final = (1000.0, 100.0, 10.0, 0.1, 0.01, 0.001)


def axes_of_row(axis: str, label: str, last: int) -> str:
    """Return the names of the two x or z axes that the row ``label`` connects.

    ``axis`` is "x" or "z", and ``last`` is the number of the last joint. For some fixed rows the
    axes have no numbers; then the result is "the two z axes".
    """
    if label.isdecimal() and label != "0":
        return listed([f"{axis}{int(label) - 1}", f"{axis}{label}"])
    if label == "e":
        return say("{first} and the last {axis} axis", first=f"{axis}{last}", axis=axis)
    return say("the two {axis} axes", axis=axis)


def wrong_throughout(column: int) -> Sentence:
    """Return the message that a column of a table has the wrong sign in all rows."""
    symbol, axis = SYMBOLS[column], AXES[column]
    if column in (ALPHA, THETA):
        return say(
            "{symbol} has the wrong sign throughout: it is measured about {axis}, positive by the "
            "right-hand rule.",
            symbol=symbol,
            axis=axis,
        )
    return say(
        "{symbol} has the wrong sign throughout: it is measured along {axis}, positive in the "
        "direction of the axis.",
        symbol=symbol,
        axis=axis,
    )


def change_every_sign(column: int) -> Sentence:
    """Return the correction for a column in which every sign is wrong."""
    return say("Change the sign of every {symbol}.", symbol=SYMBOLS[column])


def other_length_unit(times: float) -> Finding:
    """Return the message that all lengths are wrong by the factor ``times``."""
    if times > 1:
        return says(
            say(
                "The lengths are {factor} times too large: in which unit does the exercise give "
                "them?",
                factor=round(times),
            ),
            say("Divide each length by {factor}.", factor=round(times)),
        )
    return says(
        say(
            "The lengths are {factor} times too small: in which unit does the exercise give them?",
            factor=round(1 / times),
        ),
        say("Multiply each length by {factor}.", factor=round(1 / times)),
    )


# --- The records of all misconceptions and checks, and the search among them
#
# If several records explain an answer, the record of the lowest rank counts; the order of imports
# has no effect. The pages of docs that list codes are generated from the records, and
# tests/grading/diagnosis/test_diagnosis.py submits the examples.


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
        """Return a finding with the code of this misconception, for a record without a function."""
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

    ``known`` has values for more fields of the record. Without a function, the record only
    documents a code; other functions make findings with this code.
    """
    codes = (code,) if isinstance(code, str) else code
    record = Record(of=of, rank=rank, codes=codes, name=name or codes[0], **known)
    _RECORDS.append(record)
    records_of.cache_clear()
    return record


def misconception(
    *, of: type, rank: int, code: str | tuple[str, ...] = (), **known: Any
) -> Callable[[AnyFunction], AnyFunction]:
    """Decorate a function that yields hypotheses, and register it as a misconception.

    The arguments are the fields of its Record.
    """
    add = partial(register, of=of, rank=rank, code=code, **known)

    def registered(function: AnyFunction) -> AnyFunction:
        name = f"{function.__module__.rpartition('.')[2]}.{function.__name__}"
        add(name=name, function=function)
        return function

    return registered


def check(
    *, of: type, rank: int, code: str | tuple[str, ...] = (), **known: Any
) -> Callable[[AnyFunction], AnyFunction]:
    """Decorate a function that returns a finding or None, and register it as a check.

    The arguments are the fields of its Record.
    """
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
    """Return a finding with this hint; its code is that of the misconception that yields it."""
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
        """Return the hypotheses (possible mistakes) that explain the answer.

        A Written hypothesis that is equal to the correct answer explains nothing. Nor does a
        Repaired hypothesis that is equal to the student's answer.
        """
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

    The functions of misconceptions get ``source``, by default ``case``: for example the links whose
    product a matrix is. Only misconceptions about the class ``of`` are tried, by default the class
    of ``source``.
    """
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


# --- Wrong values, table cells and arrays, and how misconceptions explain them


Mask = NDArray[np.bool_]
Hypotheses = Iterator[Hypothesis[Numbers]]


@dataclass(frozen=True, kw_only=True)
class WrongValue:
    """A submitted value that differs from the expected value."""

    expression: Expression
    # (SAMPLES,), like expected; angles in radians.
    actual: Numbers
    expected: Numbers
    samples: Samples
    scale: float
    angle: bool
    # The correct answer as the student would write it, or None if no formula is known.
    correction: Correction | None = None
    # If False, the report must not contain corrections.
    corrects: bool = True
    spelling: Spelling = PLAIN

    @property
    def constants(self) -> tuple[Numbers, Numbers]:
        """The actual and the expected value."""
        return self.actual, self.expected

    @cached_property
    def slack(self) -> float:
        """The largest error that rounding can cause in the value."""
        return rounding_slack(self.expression, self.samples)

    def equal(self, one: Numbers, other: Numbers) -> bool:
        """True if two values are equal within rounding."""
        return same(one, other, self.scale, self.angle, self.slack)

    def explained_by(self, hypotheses: Iterable[AnyHypothesis]) -> Iterator[AnyHypothesis]:
        """Return the misconceptions that explain the value."""
        return filter(self._is_explained_by, hypotheses)

    def _is_explained_by(self, hypothesis: Hypothesis[Any]) -> bool:
        actual, expected = self.constants
        answer = hypothesis.answer
        if isinstance(hypothesis, Repaired):
            return self.equal(answer, expected) and not self.equal(answer, actual)
        if isinstance(hypothesis, Written) and hypothesis.tolerance is not None:
            error = difference(actual, answer, self.angle)
            return bool(np.abs(error).max() <= hypothesis.tolerance)
        # Compare as plain numbers, so that −180° for 180° has the wrong sign.
        return self.equal(actual, answer) and not same(
            expected, answer, self.scale, slack=self.slack
        )


def finding_on(
    case: WrongValue,
    hint: str,
    values: dict[str, float | str] | None = None,
    *,
    otherwise: str = "",
) -> Finding:
    """Return a finding with a hint and the correction of the value, or else ``otherwise``."""
    return Finding("", hint, case.correction or otherwise, values=values)


@dataclass(frozen=True, kw_only=True)
class WrongCell(WrongValue):
    """A wrong cell of a DH table."""

    column: int
    # The joint of the row, or None in a fixed row.
    joint: Joint | None
    # The factor of each joint's variable in the student's cell, or None if the cell is not linear
    # in the variables.
    contained: Mapping[Joint, int] | None
    # The factor of each joint's variable in the expected cell.
    required: Mapping[Joint, int]
    # True if the joint's axis is parallel to a neighbouring axis, so that offsets along both axes
    # add up.
    shared: bool = False
    # All joints of the robot.
    joints: tuple[Joint, ...] = ()
    # "" if there is only one row.
    label: str = ""

    @property
    def symbol(self) -> str:
        """The parameter in the cell: a, α, d or θ."""
        return SYMBOLS[self.column]

    @property
    def axis(self) -> str:
        """The axis along or about which the cell is measured: x or z."""
        return AXES[self.column]

    def name(self, joint: Joint) -> str:
        """Return the joint's variable as the student writes it."""
        return self.spelling.names.get(joint.variable, joint.variable)

    @property
    def same_motion(self) -> bool:
        """True if only the constant of the cell is wrong, not its joint variables."""
        return self.contained == self.required

    @property
    def contained_alone(self) -> tuple[Joint, int] | tuple[None, int]:
        """The only joint variable in the cell and its factor, or ``(None, 0)``."""
        contained = self.contained or {}
        return next(iter(contained.items())) if len(contained) == 1 else (None, 0)

    @cached_property
    def constants(self) -> tuple[Numbers, Numbers]:
        """The actual and the expected value without the joint variables that the cell needs."""
        values = self.samples.values
        motion = sum(count * values[joint.variable] for joint, count in self.required.items())
        return self.actual - motion, self.expected - motion

    def explained_by(self, hypotheses: Iterable[AnyHypothesis]) -> Iterator[AnyHypothesis]:
        """Return the misconceptions that explain the constant of the cell.

        None of them does if the joint variables differ.
        """
        return super().explained_by(hypotheses if self.same_motion else ())


@dataclass(frozen=True)
class WrongNumbers:
    """Submitted numbers that differ from the expected numbers, ``(..., SAMPLES)`` each."""

    actual: Numbers
    expected: Numbers
    # The size (...) that the error of each number is compared with.
    scale: ArrayLike
    angle: ClassVar[ArrayLike] = False

    def agree(self, one: Numbers, other: Numbers, entries: Index = ...) -> Mask:
        """Return a mask ``(...)`` of the numbers that are equal within rounding."""
        scale = np.asarray(self.scale)[entries]
        return nearly_equal(one, other, scale, self.angle)

    def explained_by(self, hypotheses: Iterable[AnyHypothesis]) -> list[AnyHypothesis]:
        """Return the misconceptions that explain the numbers.

        All hypotheses must be about the same entries, because they are compared at once.
        """
        tried = list(hypotheses)
        if not tried:
            return []
        entries = tried[0].entries
        answers = np.array([hypothesis.answer for hypothesis in tried])
        inner = tuple(range(1, answers.ndim - 1))
        explains = self.agree(self.actual[entries], answers, entries).all(axis=inner)
        if not explains.any():
            return []
        explains &= ~self.agree(self.expected[entries], answers, entries).all(axis=inner)
        return [tried[i] for i in np.flatnonzero(explains)]


# The code of a wrong value that no known misconception explains.
UNEXPLAINED = "value"


@check(
    of=WrongValue,
    rank=10,
    code="undefined",
    rule="dependence",
    means="the formula has no value: it divides by zero, takes the root of a negative number, "
    "or is too large",
    example=("stanford-arm", "table", {"2/d": "d2/0"}),
    unlike={"6/d": "0"},
)
def undefined(case: WrongValue) -> Finding | None:
    """The formula has no value at some pose, for example 1/0 or √−1."""
    bad = np.flatnonzero(~np.isfinite(case.actual))
    if not bad.size:
        return None
    at = case.samples.at(int(bad[0]), case.expression.symbols)
    formula = case.expression.text()
    values = ", ".join(f"{name} = {number:g}" for name, number in at.items())
    hint = say(
        "{formula} has no value: check for a division by zero, a root of a negative number, or a "
        "number that is too large.",
        formula=formula,
    )
    if values:
        hint = say(
            "{formula} has no value at {values}: check for a division by zero, a root of a "
            "negative number, or a number that is too large.",
            formula=formula,
            values=values,
        )
    return finding_on(case, hint, {**at})


def differs(case: WrongValue, hint: str) -> Finding:
    """Return a finding with a hint and a counterexample."""
    return finding_on(case, hint, _counterexample(case))


def _counterexample(case: WrongValue) -> dict[str, float | str] | None:
    # The counterexample is computed from the printed numbers, so that a pocket calculator agrees.
    # A right number without its formula can be checked only with the values of all symbols.
    alone = case.corrects and case.correction is None
    symbols = case.samples.values.keys() if alone else case.expression.symbols
    for i, expected in enumerate(case.expected):
        values: dict[str, float | str] = {**case.samples.at(i, symbols)}
        if not values:
            return None
        values[YOURS] = _printed(case, _at_printed(case, i))
        if not case.corrects:
            return values
        values[EXPECTED] = _printed(case, float(expected))
        # Two numbers that look the same show no mistake.
        if values[YOURS] != values[EXPECTED]:
            return values
    return None


def _at_printed(case: WrongValue, sample: int) -> float:
    samples, names = case.samples, case.expression.symbols
    printed = {
        name: np.array([math.radians(number) if name in samples.in_degrees else number])
        for name, number in samples.at(sample, names).items()
    }
    return float(np.ravel(case.expression.evaluate(printed))[0])


def _printed(case: WrongValue, value: float) -> float:
    number = math.degrees(value) if case.angle and case.samples.in_degrees else value
    return 0.0 if abs(number) < PRINTED_NUMBER else float(f"{number:.4g}")


# --- Find the formula that a student would write for given numbers


# A term of a sum and its sign.
_Term = tuple[int, Node]


def spelled(formula: Node, spelling: Spelling) -> Correction:
    """Return a correct formula as the student would write it."""
    return Correction(to_text(formula, spelling), to_latex(spelling.renamed(formula)))


def value_formula(
    values: Numbers, angle: bool, exercise: Exercise, samples: Samples, spelling: Spelling
) -> Correction | None:
    """Return ``values`` ``(SAMPLES,)`` as a formula such as ``theta2 + pi/2``.

    The formula is a constant plus whole multiples of symbols, as in table cells. Return None if the
    values are not such a sum.
    """
    (counts,) = coefficients(values[None], exercise.joints, samples, np.array([angle]))
    return sum_formula(values, counts, angle, exercise, samples, spelling)


def sum_formula(
    values: Numbers,
    counts: tuple[int, ...] | None,
    angle: bool,
    exercise: Exercise,
    samples: Samples,
    spelling: Spelling,
) -> Correction | None:
    """Return ``values`` as a formula with joint variables, or None if there is no such formula.

    ``counts`` has the factor of each joint variable; without it, there is no formula.
    """
    if counts is None:
        return None
    moving = [joint.variable for joint in exercise.joints]
    motion = sum(n * samples.values[name] for n, name in zip(counts, moving, strict=True) if n)
    found = multiples((values - motion)[:HALF], angle, exercise, samples)
    if found is None:
        return None
    shares, remainder = found
    symbols = exercise.vocabulary.by_name
    terms = [
        _multiple(count, SymbolNode(symbols[name]))
        for count, name in (*zip(counts, moving, strict=True), *shares)
        if count
    ]
    constant = _angle(remainder, spelling) if angle else _length(remainder)
    return spelled(_sum([*terms, constant] if constant else terms), spelling)


def multiples(
    constant: Numbers, angle: bool, exercise: Exercise, samples: Samples
) -> tuple[list[tuple[int, str]], float] | None:
    """Split a constant ``(HALF,)`` into whole multiples of letters and a remaining number.

    Letters with the multiple 0 are left out. Return None if there is no such sum.
    """
    first = constant[0]
    if np.abs(difference(constant, np.full_like(constant, first), angle)).max() < CONSTANT:
        return [], float(first)
    kind = "angle" if angle else "length"
    letters = [v.name for v in exercise.variables if v.joint is None and v.kind == kind]
    if not letters:
        return None

    def basis_and_inverse() -> tuple[Numbers, Numbers]:
        basis = np.array([*(samples.values[name][:HALF] for name in letters), np.ones(HALF)])
        return basis, np.asarray(np.linalg.pinv(basis), dtype=np.float64)

    # The letters' values and a constant, ``(letters + 1, HALF)``.
    basis, solver = samples.cached(("letters", kind), basis_and_inverse)
    shares = np.round(constant @ solver)[:-1]
    rest = constant - shares @ basis[:-1]
    if np.ptp(rest) > WHOLE_MULTIPLE:
        return None
    found = zip(shares.astype(np.int_).tolist(), letters, strict=True)
    return [(share, letter) for share, letter in found if share], float(rest.mean())


def number_formula(values: Numbers, figures: int = 4) -> Correction | None:
    """Return ``values`` ``(SAMPLES,)`` as a plain number, or None if they vary."""
    if np.ptp(values) > PRINTED_NUMBER:
        return None
    value = float(values[0])
    node = _sum([] if abs(value) < PRINTED_NUMBER else [_number(value, figures)])
    return Correction(to_text(node), to_latex(node))


def _sum(terms: list[_Term]) -> Node:
    total: Node | None = None
    for sign, term in terms:
        if total is None:
            total = term if sign > 0 else _negated(term)
        else:
            total = Binary("+" if sign > 0 else "-", total, term)
    return Number(0.0, "0") if total is None else total


def _negated(term: Node) -> Node:
    # The minus sign is before the first factor: -2*l1, -3*pi/4.
    if isinstance(term, Binary):
        return Binary(term.operator, _negated(term.left), term.right)
    return Negation(term)


def _multiple(count: int, factor: Node) -> _Term:
    times = abs(count)
    product = factor if times == 1 else Binary("*", Number(float(times), str(times)), factor)
    return (1 if count > 0 else -1), product


def _number(value: float, figures: int) -> _Term:
    return (1 if value >= 0 else -1), Number(abs(value), f"{abs(value):.{figures}g}")


def _length(value: float) -> _Term | None:
    return None if abs(value) < WHOLE_MULTIPLE else _number(value, 6)


def _angle(value: float, spelling: Spelling) -> _Term | None:
    # In degrees or as a fraction of π. An angle that is not a multiple of π/12 is always in
    # degrees.
    turned = float(difference(np.array(value), np.array(0.0), angle=True))
    if abs(turned) < WHOLE_MULTIPLE:
        return None
    share = Fraction(turned / np.pi).limit_denominator(12)
    if share == -1:
        share, turned = Fraction(1), -turned
    if spelling.in_degrees or abs(float(share) * np.pi - turned) > WHOLE_MULTIPLE:
        sign, number = _number(float(np.degrees(turned)), 6)
        return sign, Unit(number, "deg")
    sign, turn = _multiple(share.numerator, Pi())
    below = share.denominator
    return sign, turn if below == 1 else Binary("/", turn, Number(float(below), str(below)))
