"""Read a submitted cell as an entry, and evaluate entries at the samples."""

from collections.abc import Mapping, Sequence, Set
from dataclasses import dataclass, field, replace
from functools import lru_cache
from typing import Self

import numpy as np

from service.catalogue import Exercise
from service.expressions import (
    LIMITS,
    AngleUnit,
    Expression,
    ExpressionError,
    Kind,
    Note,
    Vocabulary,
    evaluate_all,
    read,
    reading_cost,
)
from service.grading.feedback import Finding, reading_error, reading_note
from service.grading.numerics.samples import SAMPLES, Samples
from service.grading.reading.absent_variables import with_absent_variables
from service.grading.reading.converted_lengths import converted
from service.grading.reading.tables.words import METRES
from service.grading.report import Verdict
from service.grading.work_budget import WorkBudget
from service.kinematics.transforms import Numbers
from service.regex import regex
from service.translations import say

# Notes that a table does not show: textbooks mark every joint variable with a star, and six notes
# on that would hide the others.
EXPECTED_IN_TABLES = frozenset({"joint_marker"})

# The codes of errors on a name that may be an absent joint variable (``absent_variables``).
_UNKNOWN_NAMES = frozenset({"unknown_joint", "unknown_symbol"})

# The unit in "all lengths are in metres".
_STATED = regex(r"(?<!\w)(?:in|en)\s(\w{4,12})(?!\w)")

# The largest absolute values. No robot is larger, and a larger angle has no precise digits left
# after whole turns are removed.
BOUNDS: Mapping[Kind, float] = {"angle": 1e6, "length": 1e9, "number": 1e9}


@dataclass(frozen=True, slots=True)
class Entry:
    """One cell as read: an expression, or the reason why it cannot be read.

    Without an expression, ``verdict`` is MISSING or UNREADABLE.
    """

    # With an expression, the verdict is not known yet.
    expression: Expression | None
    verdict: Verdict = Verdict.CORRECT
    findings: tuple[Finding, ...] = ()

    @property
    def readable(self) -> bool:
        """True if the cell has an expression."""
        return self.expression is not None


@dataclass(frozen=True, slots=True)
class Reader:
    """Reads the cells of one submission.

    ``length_unit`` is the unit of all lengths of the exercise, or None if there are several.
    """

    # Copies with another angle unit share the work budget. If no length has a letter,
    # ``length_unit`` is the unit that the statement names: "in metres".
    vocabulary: Vocabulary
    samples: Samples
    angle_unit: AngleUnit
    length_unit: str | None
    budget: WorkBudget = field(default_factory=WorkBudget)

    @classmethod
    def of(
        cls,
        exercise: Exercise,
        samples: Samples,
        angle_unit: AngleUnit,
        budget: WorkBudget | None = None,
    ) -> Self:
        """Return a reader for a submission to an exercise."""
        unit = length_unit_of(exercise)
        return cls(exercise.vocabulary, samples, angle_unit, unit, budget or WorkBudget())

    def read(self, raw: object, quantity: Kind, *, in_table: bool = False) -> Entry:
        """Return the entry for a JSON value. Never raises: any bad value is an unreadable entry.

        ``in_table`` is for cells of a DH table.
        """
        # In a table, a star may mark the joint variable, and an absent joint variable is wrong
        # instead of unreadable.
        budget = self.budget
        symbols = 1
        if isinstance(raw, str):
            if not raw.strip():
                return MISSING
            if budget.symbols >= 0 and len(raw) <= LIMITS.characters:
                symbols = reading_cost(raw)
        elif raw is None:
            return MISSING
        elif isinstance(raw, bool) or not isinstance(raw, int | float):
            return unreadable(_wrong_type(raw))
        if not budget.charge_reading(symbols):
            return unreadable(_TOO_MUCH)
        try:
            expression = read(
                raw,
                self.vocabulary,
                quantity=quantity,
                angle_unit=self.angle_unit,
                repairs=budget.repairs > 0,
            )
        except ExpressionError as error:
            budget.charge_repair(raw, error.tried)
            is_unknown = in_table and error.code in _UNKNOWN_NAMES
            # The second reading is charged too.
            is_unknown = is_unknown and budget.charge_reading(symbols)
            absent = self._in_absent_variables(raw, quantity) if is_unknown else None
            if absent is None:
                return unreadable(self._finding(error, raw))
            expression = absent
        if not expression.notes:
            return Entry(expression)
        hidden = self._hidden_notes(expression) if in_table else frozenset()
        shown = (note for note in expression.notes if note.code not in hidden)
        return Entry(expression, findings=tuple(map(from_note, shown)))

    def _finding(self, error: ExpressionError, raw: str | int | float) -> Finding:
        finding = _from_error(error)
        if error.code == "length_unit" and self.length_unit:
            in_metres = converted("1 m", self.length_unit) == "1"
            kept = error.suggestion if in_metres else None
            return replace(finding, suggestion=converted(str(raw), self.length_unit) or kept)
        return finding

    def _in_absent_variables(self, raw: str | int | float, quantity: Kind) -> Expression | None:
        vocabulary = with_absent_variables(self.vocabulary)
        try:
            return read(
                raw, vocabulary, quantity=quantity, angle_unit=self.angle_unit, repairs=False
            )
        except ExpressionError:
            return None

    def _hidden_notes(self, expression: Expression) -> frozenset[str]:
        known = with_absent_variables(self.vocabulary).by_name
        joints = [known[name].joint for name in expression.symbols]
        return EXPECTED_IN_TABLES if len(joints) - joints.count(None) < 2 else frozenset()


def entry_values(entries: Sequence[Entry], quantities: Sequence[Kind], samples: Samples) -> Numbers:
    """Return the values of entries at the samples, ``(entries, SAMPLES)``.

    A value is NaN if it is unreadable, undefined or out of bounds.
    """
    expressions = [entry.expression for entry in entries]
    found = evaluate_all(expressions, samples.values, samples.memo)
    numbers = np.empty((len(entries), SAMPLES))
    for i, values in enumerate(found):
        numbers[i] = values
    numbers[np.abs(numbers) > _bounds(tuple(quantities))] = np.nan
    return numbers


def length_unit_of(exercise: Exercise) -> str | None:
    """Return the unit of all lengths of an exercise, or None if there are several."""
    lengths = [each for each in exercise.variables if each.kind == "length"]
    units: Set[str] = {length.unit for length in lengths}
    units = units or _stated_units(exercise.statement)
    [unit] = units if len(units) == 1 else [None]
    return unit


@lru_cache(maxsize=256)
def _stated_units(statement: str) -> Set[str]:
    return METRES.keys() & _STATED.findall(statement.lower())


@lru_cache(maxsize=256)
def _bounds(quantities: tuple[Kind, ...]) -> Numbers:
    return np.array([[BOUNDS[quantity]] for quantity in quantities])


_TOO_MUCH = reading_error(
    "too_long",
    say("The answers are too long. This place and all after it are not read."),
)

MISSING = Entry(
    None,
    Verdict.MISSING,
    (reading_error("missing", say("Nothing is written here; if the value is zero, write 0.")),),
)

# Several entries may be unreadable for one reason: the first has the message, the others are this.
UNREADABLE = Entry(None, Verdict.UNREADABLE)


def unreadable(finding: Finding) -> Entry:
    """Return an unreadable entry with its reason."""
    return Entry(None, Verdict.UNREADABLE, (finding,))


def _wrong_type(raw: object) -> Finding:
    message = say("Write one number or one formula here.")
    if isinstance(raw, bool):
        message = say(
            "The word {word} stands here. Write a number or a formula.", word=str(raw).lower()
        )
    return reading_error("wrong_type", message)


def _from_error(error: ExpressionError) -> Finding:
    return Finding(
        error.code,
        error.message,
        span=error.span,
        reading=True,
        suggestion=error.suggestion,
    )


def from_note(note: Note) -> Finding:
    """Convert a note on how a text was read to a finding (a message in the report)."""
    return reading_note(note.code, note.message, note.span)
