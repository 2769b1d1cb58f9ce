"""Read one cell as an entry with its values, and the pasted texts that hold cells.

This file knows a cell's quantity only from its callers: ``table.py``, ``matrices.py`` and
``lists.py`` know which place has which quantity. Nothing here is right or wrong, only readable.
"""

import re
import unicodedata
from collections.abc import Callable, Iterable, Iterator, Mapping, Sequence, Set
from dataclasses import dataclass, field, replace
from decimal import Decimal
from functools import lru_cache, reduce
from itertools import chain, islice, pairwise
from typing import Final, NamedTuple, Self, TypeAlias, TypeVar

import numpy as np

from dh_grader.catalogue import Exercise
from dh_grader.expressions import (
    LIMITS,
    AngleUnit,
    Expression,
    ExpressionError,
    Kind,
    LeftSide,
    Note,
    Symbol,
    Vocabulary,
    evaluate_all,
    left_side,
    read,
    reading_cost,
)
from dh_grader.expressions.characters import with_points
from dh_grader.grading.numbers import SAMPLES, Samples
from dh_grader.grading.reading.headers import ANGLE_UNITS, METRES, in_plain_words, read_header
from dh_grader.grading.report import (
    MAX_PASTED,
    MAX_PASTED_SIGNS,
    MAX_SYMBOLS,
    PASTED_WORK,
    SYMBOL_WORK,
    Finding,
    Verdict,
    WorkBudget,
    reading_error,
    reading_note,
)
from dh_grader.kinematics import Numbers
from dh_grader.pasting import (
    GRID_LIMITS,
    Grid,
    GridCell,
    GridError,
    NamedGrid,
    RobotTable,
    SourceText,
    read_grid,
    read_grids,
    read_robot,
    without_tuples,
)
from dh_grader.pasting.around import is_sentence
from dh_grader.pasting.remarks import may_change
from dh_grader.pasting.source import joined, line_number, remembering
from dh_grader.regex import regex
from dh_grader.slices import checkpoint
from dh_grader.translations import listed, say

R = TypeVar("R")


# --- Read a submitted cell as an entry, and evaluate entries at the samples


# Notes that a table does not show: textbooks mark every joint variable with a star, and six notes
# on that would hide the others.
EXPECTED_IN_TABLES = frozenset({"joint_marker"})

# The codes of errors on a name that may be an absent joint variable.
_UNKNOWN_NAMES = frozenset({"unknown_joint", "unknown_symbol"})

# The unit in "all lengths are in metres".
_IN_METRES = regex(r"(?<!\w)(?:in|en)\s(\w{4,12})(?!\w)")

# The largest absolute values. No robot is larger, and a larger angle has no precise digits left
# after whole turns are removed.
BOUNDS: Mapping[Kind, float] = {"angle": 1e6, "length": 1e9, "number": 1e9}


@dataclass(frozen=True, slots=True)
class Entry:
    """One cell as read: an expression, or the reason why it cannot be read.

    Without an expression, ``verdict`` is MISSING or UNREADABLE. With one, it is not known yet.
    """

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

    ``length_unit`` is the unit of all lengths of the exercise, or None if there are several. If no
    length has a letter, it is the unit that the statement names: "in metres". Copies with another
    angle unit share the work budget.
    """

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

        ``in_table`` is for cells of a DH table: there, a star may mark the joint variable, and an
        absent joint variable is wrong instead of unreadable.
        """
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
        finding = Finding(
            error.code, error.message, span=error.span, reading=True, suggestion=error.suggestion
        )
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
    units = units or _length_units(exercise.statement)
    [unit] = units if len(units) == 1 else [None]
    return unit


@lru_cache(maxsize=256)
def _length_units(statement: str) -> Set[str]:
    return METRES.keys() & _IN_METRES.findall(statement.lower())


@lru_cache(maxsize=256)
def _bounds(quantities: tuple[Kind, ...]) -> Numbers:
    return np.array([[BOUNDS[quantity]] for quantity in quantities])


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


_TOO_MUCH = reading_error(
    "too_long",
    say("The answers are too long. This place and all after it are not read."),
)


def from_note(note: Note) -> Finding:
    """Convert a note on how a text was read to a finding (a message in the report)."""
    return reading_note(note.code, note.message, note.span)


# --- Names of joint variables that a robot does not have, such as theta0
#
# A cell with such a name is wrong, but not unreadable. Students write them if they count the joints
# from 0, or revolute and prismatic joints separately. theta3 is absent if joint 3 slides.


_LETTERS: Final = "thetad"
# Larger than every joint number, so that no shorthand (such as c1) means an absent variable.
_FIRST_ABSENT_JOINT: Final = 1000


@lru_cache(maxsize=256)
def with_absent_variables(vocabulary: Vocabulary) -> Vocabulary:
    """Add the usual joint variables that the robot does not have, counted from 0, to a vocabulary.

    Names such as ``d2`` are added only if some joint slides; otherwise they are unknown lengths.
    """
    if not vocabulary.joints:
        return vocabulary
    indices = range(vocabulary.joints[-1] + 1)
    absent = [symbol for index in indices for symbol in _absent(index, vocabulary)]
    return Vocabulary([*vocabulary.symbols, *absent], decimal_comma=vocabulary.decimal_comma)


def _absent(index: int, vocabulary: Vocabulary) -> Iterator[Symbol]:
    known = vocabulary.by_name
    others = [name for name in (f"th{index}", f"q{index}") if name not in known]
    if f"theta{index}" not in known:
        joint = _FIRST_ABSENT_JOINT + 2 * index
        yield Symbol(f"theta{index}", "angle", tuple(others), joint=joint)
    if vocabulary.sliding and f"d{index}" not in known:
        yield Symbol(f"d{index}", "length", joint=_FIRST_ABSENT_JOINT + 2 * index + 1)


def joint_counted(name: str) -> int:
    """Return the joint number in the name of an absent joint variable: 3 for theta3."""
    return int(name.lstrip(_LETTERS))


# --- Convert a length with a unit to a number: 135 mm is 0.135 in metres


_LENGTH: Final = regex(
    r"(?P<sign>[-−–]?)\s{0,4}(?P<number>\d{1,12}(?:[.,]\d{1,12})?)\s{0,4}[(\[]?(?P<unit>[a-z]{1,12})"
    r"[)\]]?"
)
_SIUNITX: Final = regex(r"\\(?:SI|qty)\s{0,4}\{([^{}]{1,30})\}\s{0,4}\{([^{}]{1,30})\}")
# 1,350 mm is a metre and more, or a millimetre and more.
_THOUSANDS: Final = regex(r"[1-9]\d{0,2},\d{3}")


def converted(text: str, unit: str) -> str | None:
    """Return the number in ``unit`` for a length such as ``13.5 cm``; None for any other text."""
    plain = unicodedata.normalize("NFKC", _SIUNITX.sub(r"\1\2", text)).replace("\\", "")
    length = _LENGTH.fullmatch(plain.strip())
    if length is None or _THOUSANDS.fullmatch(length["number"]):
        return None
    if length["unit"] not in METRES or unit not in METRES:
        return None
    metres = Decimal(length["number"].replace(",", ".")) * Decimal(str(METRES[length["unit"]]))
    number = (metres / Decimal(str(METRES[unit]))).normalize()
    sign = "-" if length["sign"] and number else ""
    return f"{sign}{number:f}"


# --- Sort values by their names: ``y = 2, x = 1`` is x, then y. Report wrong names
#
# A name may belong to several places, because textbooks differ, or to no place. The values are
# reordered only if each value that is not empty names exactly one place, and no two values name the
# same place.


# The places that a name may have, counted from 0; None if the name does not imply a place.
Places: TypeAlias = tuple[int, ...] | None
# A function that returns the places of each of several names.
PlacesOf: TypeAlias = Callable[[Sequence[LeftSide | None], Vocabulary], list[Places]]


class Arrangement(NamedTuple):
    """The order of named values, or the findings on wrong names.

    ``order`` has, for each place, the index of its value. ``misnamed`` maps the index of a value
    with a wrong name to its finding; it is empty if reordering makes all names correct.
    """

    order: tuple[int, ...]
    misnamed: Mapping[int, Finding]

    @property
    def by_name(self) -> bool:
        """True if the values were reordered by their names."""
        return not self.misnamed


def name_of(value: object, vocabulary: Vocabulary) -> LeftSide | None:
    """Return the left side of a value such as ``y = l1 s1``; None if it is not an equation."""
    if not isinstance(value, str) or len(value) > LIMITS.characters:
        return None
    return left_side(value, vocabulary)


def arranged(
    values: Sequence[object], labels: Sequence[str], places_of: PlacesOf, vocabulary: Vocabulary
) -> Arrangement | None:
    """Return the arrangement of values by their names; None if no name is in a wrong place.

    ``labels`` are the expected names.
    """
    names = [name_of(value, vocabulary) for value in values]
    if not any(names):
        return None
    places = places_of(names, vocabulary)
    misnamed = {
        i: misnamed_value(name, labels[i])
        for i, (name, allowed) in enumerate(zip(names, places, strict=True))
        if name is not None and allowed is not None and i not in allowed
    }
    if not misnamed:
        return None
    order = _order(places, [_is_written(value) for value in values])
    return Arrangement(order, {}) if order else Arrangement((*range(len(values)),), misnamed)


def _order(places: Sequence[Places], written: Sequence[bool]) -> tuple[int, ...] | None:
    # Empty values get the places that are left. None if a value that is not empty does not name
    # exactly one free place.
    found: dict[int, int] = {}
    for i, is_written in enumerate(written):
        allowed = places[i]
        if is_written:
            if allowed is None or len(allowed) != 1 or allowed[0] in found:
                return None
            found[allowed[0]] = i
    left = iter([i for i, is_written in enumerate(written) if not is_written])
    return tuple(found[place] if place in found else next(left) for place in range(len(places)))


def _is_written(value: object) -> bool:
    return bool(value.strip()) if isinstance(value, str) else value is not None


def misnamed_value(name: LeftSide, asked: str) -> Finding:
    """Return the finding that a value does not have the expected name."""
    message = say(
        "This is named {name}, but {asked} is asked for here.", name=quoted(name.name), asked=asked
    )
    return reading_error("misnamed_value", message, name.span)


def with_order_note(entries: Sequence[Entry], message: str) -> tuple[Entry, ...]:
    """Return sorted entries with the note ``message`` on their order, instead of on equations."""
    # The note has no span, so that the report shows it once for all entries.
    note = reading_note("ordered_by_names", message)
    return tuple(
        replace(
            entry,
            findings=(*(each for each in entry.findings if each.code != "equation"), note),
        )
        for entry in entries
    )


# --- Replace letters by the numbers that a script gives them, as in ``d1 = 0.1625``
#
# The numbers count only if the exercise has no lengths as letters: otherwise letters are its
# symbols.


_NUMBER: Final = regex(
    r"(?:^|[;,\n])[ \t]*([A-Za-z]\w{0,20})[ \t]*=[ \t]*([-+]?(?:\d{1,9}\.?\d{0,12}|\.\d{1,12}))"
    r"[ \t\r]*(?=[;,\n%#]|\Z)"
)
_ASSIGNED: Final = regex(r"(?<![\w.])(\w{1,21})[ \t]{0,40}[-+*/]?=(?!=)")
# The last letter of an assignment to several letters, whose value may be another number.
_LAST: Final = regex(r"(?<![\w.])[A-Za-z]\w{0,20}\s{0,9},\s{0,9}([A-Za-z]\w{0,20})\s{0,9}=(?!=)")
# A letter in a value. The z of the cell ``z = 0`` is the name of a value in a list.
_NAME: Final = regex(r"(?<![\w.\\])[A-Za-z]\w*(?![\w(\[]|[ \t]*=(?!=))")
_MOST_GIVEN: Final = 40


def with_given_letters(grid: Grid, text: str, reader: Reader) -> Grid:
    """Replace letters that a text defines by their numbers; return the grid and a note."""
    given = _given_letters(text, reader)
    used: dict[str, None] = {}
    rows = tuple(tuple(_with_numbers(cell, given, used) for cell in row) for row in grid.rows)
    if not used:
        return grid
    message = say(
        "The numbers that the text gives to {letters} were used.", letters=", ".join(used)
    )
    notes = [note for note in grid.notes if note.code != "given_numbers"]
    return replace(grid, rows=rows, notes=(*notes, Note("used_numbers", message, (0, len(text)))))


def _given_letters(text: str, reader: Reader) -> dict[str, str]:
    # Letters that the text sets once and the exercise does not know.
    slides = reader.vocabulary.sliding.values()
    if any(each.kind == "length" and each not in slides for each in reader.vocabulary.symbols):
        return {}
    text = without_tuples(text)
    names = _ASSIGNED.findall(text) + _LAST.findall(text)
    return {
        each[1]: each[2]
        for each in islice(_NUMBER.finditer(text), _MOST_GIVEN)
        if names.count(each[1]) == 1 and not reader.read(each[1], "number").readable
    }


def _with_numbers(cell: GridCell, given: dict[str, str], used: dict[str, None]) -> GridCell:
    names = [name for name in _NAME.finditer(cell.text) if name[0] in given]
    if not names or read_header(cell.text):
        return cell
    pieces, start = [], 0
    for name in names:
        used[name[0]] = None
        value = given[name[0]] if name[0] == cell.text else f"({given[name[0]]})"
        pieces += [cell.cut(start, name.start()), cell.cut(*name.span()).spelled(value)]
        start = name.end()
    return joined([*pieces, cell.cut(start, len(cell.text))], cell.at)


# --- Read the grids (tables and matrices) in pasted texts, and report errors in them


# An index in square brackets: theta[1], l[2].
_INDEX: Final = regex(r"((?<![^\W\d])[^\W\d_]{1,6}_?)\[(\s?[0-9]{1,2}\s?)\]")
_IN_UNIT: Final = regex(
    r"(?<![^\W\d_])(?:in|en|and|und|y|et) ([^\W\d_]{1,12})(?![^\W\d_])", re.IGNORECASE
)
# A unit in a header: a [mm], alpha (deg).
_HEADED_UNIT: Final = regex(r"[\[(]\s?([^\W\d_]{1,12}|°)\s?[\])]")
_MOST_UNITS: Final = 40
# The codes of errors whose messages say "this bracket" or "this row".
_AT_A_PLACE: Final = frozenset(
    {"unclosed_quote", "stray_quote", "unbalanced_bracket", "unbalanced_environment"}
    | {"unclosed_tag", "unread_tag", "mixed_separators"}
)
_JOINT_VARIABLES: Final = frozenset({"q", "th", "theta", "θ", "ϑ"})


def pasted_grid(text: str, reader: Reader, *, of_table: bool = False) -> Grid:
    """Return the table or matrix in a pasted text.

    Raises GridError if there is none, or if the pasted texts of a submission are too long.
    """

    def read() -> Grid:
        grid = read_grid(_prepared(text, reader), of_table=of_table)
        return with_given_letters(grid, text, reader)

    return _cut("table" if of_table else "grid", text, reader, read)


def pasted_robot(text: str, reader: Reader) -> RobotTable | None:
    """Return the DH table of the robot that a pasted script describes; None for any other text.

    Raises GridError if the script's table is ambiguous, or if the pasted texts are too long.
    """

    def read() -> RobotTable | None:
        robot = read_robot(_without_own_units(text, reader))
        if robot is None:
            return None
        return replace(robot, grid=with_given_letters(robot.grid, text, reader))

    return _cut("robot", text, reader, read)


def pasted_grids(text: str, reader: Reader) -> tuple[NamedGrid, ...]:
    """Return the matrices in a pasted text, with their names. May raise GridError."""
    return _cut("grids", text, reader, lambda: read_grids(_prepared(text, reader)))


def grids_as_written(text: str, reader: Reader) -> tuple[NamedGrid, ...]:
    """Return the matrices in a pasted text with its indices, of which none is ambiguous here.

    May raise GridError.
    """
    return _cut("grids as written", text, reader, lambda: read_grids(text))


def _cut(way: str, text: str, reader: Reader, read: Callable[[], R]) -> R:
    # Raises GridError if the text may not be cut.
    _charge(text, reader)
    with remembering(reader.budget.searched):
        return once(way, text, reader, read)


def once(way: str, text: str, reader: Reader, read: Callable[[], R]) -> R:
    """Read a text in one way, and remember what is found; raise its GridError again and again."""
    # A text may stand in several places of a submission, and several parts of the grader read it.
    checkpoint()
    found = reader.budget.found
    key = way, text, reader.angle_unit, reader.length_unit
    if key not in found:
        try:
            found[key] = read()
        except GridError as error:
            found[key] = error
    result = found[key]
    if isinstance(result, GridError):
        raise GridError(result.code, result.message, result.span)
    again: R = result
    return again


def stated_units(text: str) -> set[str]:
    """Return the units in sentences and comments such as "all lengths in mm", in small letters."""
    found = {unit[1].lower() for unit in islice(_IN_UNIT.finditer(text), _MOST_UNITS)}
    return found & (ANGLE_UNITS.keys() | METRES.keys())


def _prepared(text: str, reader: Reader) -> str:
    # Decimal points for decimal commas, and unambiguous indices.
    if reader.vocabulary.decimal_comma:
        text = with_points(text)
    return _with_indices_from_one(_without_own_units(text, reader), reader)


def _charge(text: str, reader: Reader) -> None:
    """Charge the cutting of a text. Raises GridError if it may not be cut."""
    if len(text) > GRID_LIMITS.characters or reader.budget.charge_pasted(text):
        # A text that is too long is not cut.
        return
    message = say("The pasted texts have more than {most:,} characters together.", most=MAX_PASTED)
    if reader.budget.pasted >= 0:
        message = say(
            "The pasted texts have more than {most:,} brackets and quotation marks together.",
            most=MAX_PASTED_SIGNS,
        )
    raise GridError("too_long", message, (0, len(text)))


def _without_own_units(text: str, reader: Reader) -> str:
    # "in radians" in "all angles in radians" becomes blanks if that is the unit. Every character
    # keeps its place. Another unit stays, and such a sentence is refused; so is a sentence that
    # contradicts a header with another unit.
    length = METRES.get(reader.length_unit or "", 0)
    headed = {unit[1].lower() for unit in islice(_HEADED_UNIT.finditer(text), _MOST_UNITS)}
    own: set[str] = set()
    for units, wanted in ((ANGLE_UNITS, reader.angle_unit), (METRES, length)):
        if all(units.get(unit, wanted) == wanted for unit in headed):
            own.update(unit for unit, meant in units.items() if meant == wanted)

    def without_unit(found: re.Match[str]) -> str:
        return " " * len(found[0]) if found[1].lower() in own else found[0]

    return _IN_UNIT.sub(without_unit, text)


def _with_indices_from_one(text: str, reader: Reader) -> str:
    # theta[1] becomes theta(1) if its indices count from 1, as in Maple. They count from 0 if a
    # joint variable has the index 0, and from 1 if one has the number of the last joint as its
    # index. Other indices are ambiguous. Every character keeps its place.
    found = [each for each in _INDEX.finditer(text) if each[1].rstrip("_") in _JOINT_VARIABLES]
    numbers = {int(each[2]) for each in found}
    joints = reader.vocabulary.joints
    if not numbers or 0 in numbers or not joints:
        return text
    if joints[-1] not in numbers:
        name, index = found[0][1].rstrip("_"), int(found[0][2])
        raise GridError(
            "ambiguous_index",
            say(
                "`{name}[{index}]` is joint {next} in Python and joint {index} in Maple. "
                "Write {name}{next} or {name}{index}.",
                name=name,
                index=index,
                next=index + 1,
            ),
            found[0].span(),
        )
    return _INDEX.sub(r"\1(\2)", text)


def from_grid_error(error: GridError, text: str = "") -> Finding:
    """Return the finding that a pasted text is not a table or matrix.

    If the error is about one place in several lines of ``text``, the message names its line.
    """
    code = "wrong_shape" if error.code == "no_grid" else error.code
    message = error.message
    if code in _AT_A_PLACE and line_number(text, len(text)) > 1:
        line = line_number(text, error.span[0])
        message = say("Line {line}: {message}", line=line, message=message)
    return Finding(code, message, span=error.span, reading=True)


def placed(entry: Entry, cell: GridCell) -> Entry:
    """Return the entry with its spans counted in the whole pasted text instead of in the cell."""
    if not entry.findings:
        return entry
    findings = tuple(
        replace(finding, span=cell.span(*finding.span) if finding.span else cell.whole)
        for finding in entry.findings
    )
    return replace(entry, findings=findings)


def place_of(cells: Sequence[GridCell]) -> tuple[int, int]:
    """Return the span (start and end) of neighbouring cells in the whole text."""
    return cells[0].whole[0], max(cells[0].whole[1], cells[-1].whole[1])


def quoted(text: str) -> str:
    """Return a cell's text, shortened and in quotes, for use in a message."""
    shown = "".join(filter(str.isprintable, text.replace("\t", " ")))
    short = shown if len(shown) <= 30 else shown[:29] + "…"
    if "\t" in text:
        # Translators: the text of a cell, as a part of other sentences.
        return say("`{text}` (with a tab character in it)", text=short)
    if shown == text:
        return f"`{short}`"
    # Translators: the text of a cell, as a part of other sentences.
    return say("`{text}` (with an invisible character in it)", text=short)


def side_by_side(names: Sequence[str]) -> str:
    """Return quoted names with commas between them."""
    return reduce(lambda first, second: say("{first}, {second}", first=first, second=second), names)


# --- Find comments and captions in a pasted text, and the units that they name


_COMMENT: Final = regex(r"(?:[%#]{1,3}|//|[(/]\*)[ \t]{0,40}((?:(?!\*[)/])[^\n%#]){2,300})")
_CAPTION: Final = regex(
    r"\\caption\s{0,4}\{([^{}]{2,200})\}|<caption[^<>]{0,80}>([^<>]{2,200})</caption>",
    re.IGNORECASE,
)
_MOST_COMMENTS: Final = 40
_WORD: Final = regex(r"[^\W\d_]+|°")
_DIGIT: Final = regex(r"\d")
# A script that converts numbers leaves none in millimetres.
CONVERTS_LENGTHS: Final = regex(r"/\s?1000?(?!\d)|\de-[23]")
# In a sentence, these are also other words.
_NO_UNITS: Final = frozenset({"m", "in", "foot"})


def refuse_other_lengths(text: str, kinds: Iterable[Kind], reader: Reader) -> None:
    """Raise GridError if a comment or a caption gives lengths a unit that is not the exercise's.

    ``kinds`` are the quantities of the entries. Without lengths, all comments are accepted.
    """
    if "length" in kinds:
        once("lengths", text, reader, lambda: _refuse_other_lengths(text, reader))


def _refuse_other_lengths(text: str, reader: Reader) -> None:
    refuse_corrections(text)
    if CONVERTS_LENGTHS.search(text):
        return
    for comment in comments_and_captions(text):
        _, lengths = units_in(comment[comment.lastindex or 0])
        if lengths - {METRES.get(reader.length_unit or "")}:
            message = say(
                "Line {line} names a unit of length. Delete the line, and write lengths as the "
                "exercise does.",
                line=line_number(text, comment.start()),
            )
            raise GridError("text_around", message, comment.span())


def refuse_corrections(text: str) -> None:
    """Raise GridError if a comment says that the table or matrix is wrong."""
    for comment in comments(text):
        if may_change(comment[1], of_cell=is_beside_code(text, comment.start())):
            message = say(
                "The sentence in line {line} may correct the table. Write the correction into the "
                "table, and delete the sentence.",
                line=line_number(text, comment.start()),
            )
            raise GridError("text_around", message, comment.span())


def is_beside_code(text: str, start: int) -> bool:
    """True if a comment that begins at ``start`` is on a line with a row or a statement."""
    return text[text.rfind("\n", 0, start) + 1 : start].strip(" \t%#/") != ""


def comments(text: str) -> Iterator[re.Match[str]]:
    """Yield the comments; the last group of each match is the text of the comment."""
    return islice(_COMMENT.finditer(text), _MOST_COMMENTS)


def comments_and_captions(text: str) -> Iterator[re.Match[str]]:
    """Yield the comments and captions that contain no digit."""
    captions = islice(_CAPTION.finditer(text), _MOST_COMMENTS)
    for found in chain(comments(text), captions):
        if not _DIGIT.search(found[found.lastindex or 0]):
            yield found


def units_in(comment: str) -> tuple[set[AngleUnit], set[float]]:
    """Return the units of angles and of lengths in a comment."""
    words = {*_WORD.findall(in_plain_words(comment))} - _NO_UNITS
    angles = {ANGLE_UNITS[word] for word in words if word in ANGLE_UNITS}
    return angles, {METRES[word] for word in words if word in METRES}


# --- Read a text that has several answers only once, if they are equal


_MOST_ANSWERS: Final = 4
# A reading searches a text for names, units and comments, which costs twice as much as cutting it.
_READING: Final = 3
_FEWEST_LINES: Final = 2
_MOST_LINES: Final = 200
# Programs print numbers with as few as five digits.
_ROUNDED: Final = 1e-4
# The beginning of an answer that has a name or a command: DH = [, T = Matrix(, \begin{tabular}.
_BEGINS: Final = regex(
    r"\s*[A-Za-z]\w{0,40}\s{0,4}:?=\s{0,4}(?:[\w.]{1,40}\(\s{0,4})?[\[{(]"
    r"|.{0,80}\\begin\{(?:tabular[x*]?|longtable|array|tblr|NiceTabular|[pbBvV]?matrix)\}"
)
_ENDS: Final = regex(r".{0,200}\\end\{")
# The first row of a table whose rows have numbers.
_FIRST_ROW: Final = regex(r"[\s|│]*(?:[^\W\d_]{1,12}[ _.]?)?1(?![\w.(*/^+])")
# A line that is no cell: a comment, a rule, a fence, or the title of another try.
_NO_ROW: Final = regex(r"\s*(?:[%#`~].*|[-=_|:+*\s]*|[^\W\d_]{2,20}[\w ]{0,40}[.:]\s*)")


@dataclass(frozen=True, slots=True)
class FoundAnswer:
    """One of several answers in a text: the texts of its cells, row by row, and their entries.

    ``is_whole`` is true if no row is missing.
    """

    texts: tuple[str, ...]
    entries: tuple[Entry, ...]
    quantities: Sequence[Kind]
    is_whole: bool
    is_table: bool = False


# A function that returns the answer in a piece of a text, or None. It may raise GridError.
Find = Callable[[str, Reader], FoundAnswer | None]


def read_once(
    text: str, read: Callable[[str], R], is_one: Callable[[R], bool], find: Find, reader: Reader
) -> tuple[R, tuple[Note, ...]]:
    """Read a text, or only the first of its answers if all are equal; then there is a note.

    ``is_one`` is False if what was read may be several answers. Raises GridError if the text cannot
    be read, or if its answers differ.
    """
    try:
        found = read(text)
    except GridError:
        if first := _first_of_equals(text, find, reader):
            return read(first[0]), (first[1],)
        raise
    if not is_one(found) and (first := _first_of_equals(text, find, reader)):
        return read(first[0]), (first[1],)
    return found, ()


def _first_of_equals(text: str, find: Find, reader: Reader) -> tuple[str, Note] | None:
    # The text up to the end of its first answer, and a note, if equal answers follow; None if the
    # text has only one answer. Raises GridError if the answers differ.
    if len(text) > GRID_LIMITS.characters or not reader.budget.charge_pasted(text):
        # A text that was not cut is not read in pieces either.
        return None
    if not _FEWEST_LINES <= len(text.splitlines()) <= _MOST_LINES:
        return None
    # The first reading cost as much as each of these, and PASTED_WORK is only a part of it.
    work = _READING * PASTED_WORK * len(text)
    if not reader.budget.affords_search(work):
        return None
    lines = SourceText.of(text).lines()
    own = replace(reader, budget=WorkBudget(MAX_SYMBOLS, repairs=0, pasted=4 * MAX_PASTED))
    try:
        for starts in _starts(lines):
            if not reader.budget.affords_search(work):
                return None
            pieces = [lines[a:b] for a, b in pairwise([*starts, len(lines)])]
            answers = _all_found(pieces, find, own)
            if answers is not None and _are_alternatives(answers, own):
                return _first(pieces, answers, own)
    finally:
        reader.budget.charge_search(SYMBOL_WORK * (MAX_SYMBOLS - max(own.budget.symbols, 0)))
    return None


def _first(
    pieces: Sequence[Sequence[SourceText]], answers: Sequence[FoundAnswer], reader: Reader
) -> tuple[str, Note]:
    content = [[line for line in piece if _is_row(line)] for piece in pieces]
    spans = [(rows[0].whole[0], rows[-1].whole[1]) for rows in content]
    places = [_lines(rows[0].line_number, rows[-1].line_number) for rows in content]
    if not all(_are_equal(answers[0], other, reader) for other in answers[1:]):
        message = say(
            "This text has {number} answers that differ, in the lines {places}. Delete all but "
            "the one that counts.",
            number=len(answers),
            places=listed(places),
        )
        raise GridError("several_answers", message, (spans[0][0], spans[-1][1]))
    message = say(
        "The same answer is in the lines {places}. It was read once.", places=listed(places)
    )
    end = pieces[0][-1].whole[1]
    return content[0][0].typed[:end], Note("answer_repeated", message, spans[1])


def _lines(first: int, last: int) -> str:
    return str(first) if first == last else f"{first}-{last}"


def _all_found(
    pieces: Sequence[Sequence[SourceText]], find: Find, reader: Reader
) -> list[FoundAnswer] | None:
    answers = []
    for piece in pieces:
        if (answer := _found(piece, find, reader)) is None:
            return None
        answers.append(answer)
    return answers


def _found(piece: Sequence[SourceText], find: Find, reader: Reader) -> FoundAnswer | None:
    text = piece[0].typed[piece[0].whole[0] : piece[-1].whole[1]]
    try:
        return find(text, reader)
    except GridError:
        return None


def _are_alternatives(answers: Sequence[FoundAnswer], reader: Reader) -> bool:
    # A part of an answer is no alternative. The rows of one table do not repeat the variable of a
    # joint; a matrix may have none.
    if not any(answer.is_whole for answer in answers):
        return False
    joints = [_joints(answer, reader) for answer in answers]
    if not any(joints):
        return not any(answer.is_table for answer in answers)
    return bool(set.intersection(*joints))


def _joints(answer: FoundAnswer, reader: Reader) -> set[str]:
    known = reader.vocabulary.by_name
    expressions = [each.expression for each in answer.entries if each.expression]
    names = set[str]().union(*(each.symbols for each in expressions))
    return {name for name in names if name in known and known[name].joint is not None}


def _are_equal(one: FoundAnswer, other: FoundAnswer, reader: Reader) -> bool:
    if one.texts == other.texts:
        return True
    if len(one.entries) != len(other.entries):
        return False
    unread = [each for each in (*one.entries, *other.entries) if not each.readable]
    return not unread and np.allclose(
        _values(one, reader), _values(other, reader), rtol=_ROUNDED, atol=_ROUNDED, equal_nan=True
    )


def _values(answer: FoundAnswer, reader: Reader) -> Numbers:
    samples = reader.samples
    if absent := samples.absent_names(each.expression for each in answer.entries):
        samples = samples.with_names(absent)
    return entry_values(answer.entries, answer.quantities, samples)


def _is_row(line: SourceText) -> bool:
    return _NO_ROW.fullmatch(line.text) is None and not is_sentence(line.text)


def _starts(lines: Sequence[SourceText]) -> Iterator[list[int]]:
    """Yield ways to divide the lines into pieces, as the first line of each piece."""
    rows = [i for i, line in enumerate(lines) if _is_row(line)]
    if len(rows) < _FEWEST_LINES:
        return
    texts = {i: " ".join(lines[i].text.split()) for i in rows}
    named = [i for i in rows if _BEGINS.match(lines[i].text)]
    after_end = [b for a, b in pairwise(rows) if _ENDS.match(lines[a].text)]
    numbered = [i for i in rows if _FIRST_ROW.match(lines[i].text)]
    first = rows[0]
    ways = [
        named,
        after_end,
        [b for a, b in pairwise(rows) if any(lines[i].text.strip() for i in range(a + 1, b))],
        [i for i in rows if texts[i] == texts[first]],
        [b for a, b in pairwise(rows) if b > a + 1],
        numbered,
        *(rows[:: len(rows) // n] for n in range(2, _MOST_ANSWERS + 1) if len(rows) % n == 0),
    ]
    tried = set()
    for way in ways:
        # What is before the first piece belongs to it, and so do titles above another piece.
        inner = [max(row for row in rows if row < i) + 1 for i in way if i > first]
        starts = [0, *inner]
        if 2 <= len(starts) <= _MOST_ANSWERS and (key := tuple(starts)) not in tried:
            tried.add(key)
            yield starts
