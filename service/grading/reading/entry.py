"""From what was handed in for one cell to the numbers that it gives at the samples."""

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from functools import lru_cache

import numpy as np

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
)
from service.grading.feedback import Finding
from service.grading.report import Severity, Verdict
from service.grading.samples import HALF, SAMPLES, Samples
from service.kinematics.transforms import Numbers

# Textbooks mark the joint variable so in every table; six notes about it would bury the others.
EXPECTED_NOTES = frozenset({"joint_marker"})

# What changes by less than this when the joints move does not move.
MOVES = 1e-9

# A 4×4 matrix of a six-joint arm, multiplied out and not simplified, takes a third of it.
MAX_CHARACTERS = 12_000

# Of so many unreadable cells of a submission a repaired text is looked for; that costs most.
REPAIRED = 12

# Beyond these nobody measures a robot, and an angle has lost its digits to whole turns.
BOUNDS: Mapping[Kind, float] = {"angle": 1e6, "length": 1e9, "number": 1e9}


@dataclass(frozen=True, slots=True)
class Entry:
    """One cell as read: an expression, or why there is none.

    Where nothing could be read, ``verdict`` says why; else it is yet to be found.
    """

    expression: Expression | None
    verdict: Verdict = Verdict.CORRECT
    findings: tuple[Finding, ...] = ()

    @property
    def readable(self) -> bool:
        """Whether there is an expression to be judged."""
        return self.expression is not None

    @property
    def may_be_rounded(self) -> bool:
        """Whether a decimal number was written: then, and only then, can something be rounded."""
        return self.expression is not None and self.expression.has_decimal


@dataclass(slots=True)
class Reader:
    """Reads the cells of one submission.

    Together they may hold so many characters and no more (``left``): reading is what costs time.
    ``moving`` says whether any value met so far changes with the joints, ``unread`` how many texts
    could not be read.
    """

    vocabulary: Vocabulary
    samples: Samples
    angle_unit: AngleUnit
    left: int = MAX_CHARACTERS
    moving: bool = False
    unread: int = 0

    def read(self, raw: object, quantity: Kind) -> Entry:
        """The entry for a JSON value. Whatever it is, the worst that comes back is unreadable."""
        if isinstance(raw, str):
            if not raw.strip():
                return MISSING
            if len(raw) <= LIMITS.characters:
                self.left -= len(raw)
        elif raw is None:
            return MISSING
        elif isinstance(raw, bool) or not isinstance(raw, int | float):
            return unreadable(_wrong_type(raw))
        if self.left < 0:
            return unreadable(_TOO_MUCH)
        try:
            expression = read(
                raw,
                self.vocabulary,
                quantity=quantity,
                angle_unit=self.angle_unit,
                repairs=self.unread < REPAIRED,
            )
        except ExpressionError as error:
            self.unread += 1
            return unreadable(_from_error(error))
        if not expression.notes:
            return Entry(expression)
        notes = (note for note in expression.notes if note.code not in EXPECTED_NOTES)
        return Entry(expression, findings=tuple(map(_from_note, notes)))

    def numbers(self, entries: Sequence[Entry], quantities: Sequence[Kind]) -> Numbers:
        """The values of entries at the samples, ``(entries, SAMPLES)``.

        NaN where an entry has none: nothing could be read, or it is undefined or beyond all bounds
        there.
        """
        expressions = [entry.expression for entry in entries]
        found = evaluate_all(expressions, self.samples.values, self.samples.memo)
        numbers = np.empty((len(entries), SAMPLES))
        for i, values in enumerate(found):
            numbers[i] = values
        numbers[np.abs(numbers) > _bounds(tuple(quantities))] = np.nan
        if not self.moving:
            change = np.abs(numbers[:, :HALF] - numbers[:, HALF:])
            self.moving = bool((change > MOVES).any())
        return numbers


@lru_cache(maxsize=256)
def _bounds(quantities: tuple[Kind, ...]) -> Numbers:
    """What the values of these may be at most, ``(quantities, 1)``."""
    return np.array([[BOUNDS[quantity]] for quantity in quantities])


_TOO_MUCH = Finding(
    "too_long",
    f"The answers hold more than {MAX_CHARACTERS} characters together; what follows is not read.",
    reading=True,
)

MISSING = Entry(
    None,
    Verdict.MISSING,
    (Finding("missing", "Nothing is written here; if the value is zero, write 0.", reading=True),),
)


def unreadable(finding: Finding) -> Entry:
    """The entry for something that cannot be read, and why."""
    return Entry(None, Verdict.UNREADABLE, (finding,))


def _wrong_type(raw: object) -> Finding:
    names = {bool: "true or false", list: "a list", dict: "an object"}
    found = names.get(type(raw), "neither")
    return Finding(
        "wrong_type",
        f"A cell holds one number or one formula as text; this is {found}.",
        reading=True,
    )


def _from_error(error: ExpressionError) -> Finding:
    suggestion = f"Did you mean {error.suggestion}?" if error.suggestion else ""
    if suggestion in error.message:
        suggestion = ""
    return Finding(error.code, error.message, suggestion, span=error.span, reading=True)


def _from_note(note: Note) -> Finding:
    return Finding(note.code, note.message, severity=Severity.INFO, span=note.span, reading=True)
