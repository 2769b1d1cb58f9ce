"""A pasted DH table as a robot: what the text says, and what its author must be asked."""

import math
import re
from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass, field, replace
from itertools import permutations
from typing import Final, Literal

import numpy as np

from dh_grader.expressions import AngleUnit, Expression, Symbol, Vocabulary, characters
from dh_grader.expressions.vocabulary import normal_form
from dh_grader.grading.numbers import SAMPLES, Samples
from dh_grader.grading.reading.entries import Entry, Reader, stated_units
from dh_grader.grading.reading.headers import ANGLE_UNITS, METRES, read_header
from dh_grader.grading.reading.pasted_table import PastedTable, entries_of, read_pasted_table
from dh_grader.grading.report import WorkBudget
from dh_grader.importing.exercise_text import (
    HomeRobot,
    Snaps,
    angle_text,
    decimals_of,
    exact_text,
    is_multiple,
    sum_text,
)
from dh_grader.kinematics import ALPHA, COLUMNS, THETA, A, Convention, D, Numbers, Row, Table
from dh_grader.pasting import GridError
from dh_grader.regex import regex
from dh_grader.translations import Sentence, joined, listed, say

# --- The rows of an imported DH table, and the robot that they describe
#
# A table is a chain of factors X_0 Z_1 X_1 … Z_n X_n. Z and X are turned over and joined here
# without solving any equation, so the poses stay the same.


_MEAN_LENGTHS = {A: 0.5, D: 0.3}


@dataclass(frozen=True, slots=True)
class CellSum:
    """The sum of a number, of letters with their factors, and of the joint variable.

    ``motion`` is the factor of the joint variable: 1, -1, or 0.
    """

    number: float = 0.0
    letters: Mapping[str, float] = field(default_factory=dict)
    motion: int = 0

    def __add__(self, other: "CellSum") -> "CellSum":
        names = [*self.letters, *(name for name in other.letters if name not in self.letters)]
        sums = {name: self.letters.get(name, 0) + other.letters.get(name, 0) for name in names}
        letters = {name: factor for name, factor in sums.items() if factor}
        return CellSum(self.number + other.number, letters, self.motion + other.motion)

    def __neg__(self) -> "CellSum":
        letters = {name: -factor for name, factor in self.letters.items()}
        return CellSum(-self.number, letters, -self.motion)

    def __bool__(self) -> bool:
        return bool(self.number or self.letters or self.motion)

    def turned(self) -> "CellSum":
        """Return the cell of a constant angle plus half a turn, at most half a turn."""
        angle = self.number + math.pi
        return replace(self, number=angle - math.tau if angle > math.pi + 1e-9 else angle)


@dataclass(frozen=True, slots=True)
class _Factor:
    # Z has d and θ of a row, X has a and α. ``row`` is the index of the row.
    is_z: bool
    length: CellSum
    angle: CellSum
    row: int

    @property
    def motion(self) -> int:
        return self.length.motion or self.angle.motion

    def joined(self, other: "_Factor") -> "_Factor":
        return replace(self, length=self.length + other.length, angle=self.angle + other.angle)


class UnusableRowError(ValueError):
    """The row with the index ``row`` does not fit into the table of an exercise."""

    def __init__(self, row: int) -> None:
        super().__init__(row)
        self.row = row


class FixedRowError(UnusableRowError):
    """A fixed row cannot be joined with the rows beside it."""


class FirstAxisError(UnusableRowError):
    """Frame 0 of a standard table is not on the axis of joint 1."""


class FirstDirectionError(UnusableRowError):
    """Joint 1 of a standard table turns or slides opposite to z0."""


@dataclass(frozen=True, slots=True)
class TableRobot:
    """The robot of a table.

    ``turned`` has the joints whose axes were turned over, so that they count +q instead of -q;
    ``joined`` has the rows, from 1, that became part of the rows beside them.
    """

    robot: HomeRobot
    turned: tuple[int, ...]
    joined: tuple[int, ...]


def robot_of_rows(rows: Sequence[Row[CellSum]], convention: Convention) -> TableRobot:
    """Return the robot of the rows of a table in this convention.

    Raises UnusableRowError.
    """
    factors = list(_factors(rows, convention))
    fixed = [i for i, row in enumerate(rows) if not any(cell.motion for cell in row)]
    joined = tuple(i + 1 for i in fixed if i != len(rows) - 1)
    if joined:
        factors = _joined(factors)
    xs, zs = _alternating(factors, len(rows))
    for z in zs[:-1]:
        if not z.motion:
            raise FixedRowError(z.row)
    turned = tuple(i for i, z in enumerate(zs) if z.motion < 0)
    for i in turned:
        zs[i] = replace(zs[i], length=-zs[i].length, angle=-zs[i].angle)
        for j in (i, i + 1):
            xs[j] = replace(xs[j], angle=xs[j].angle.turned())
    if convention is Convention.STANDARD and (xs[0].length or xs[0].angle):
        raise FirstDirectionError(zs[0].row) if 0 in turned else FirstAxisError(zs[0].row)
    table = [(x.length, x.angle, z.length, z.angle) for x, z in zip(xs[1:], zs, strict=True)]
    return TableRobot(_home_robot(table, xs[0]), tuple(i + 1 for i in turned), joined)


def typed_rows(rows: Sequence[Row[CellSum]], variables: Sequence[str]) -> list[Row[str]]:
    """Return the texts of the cells; the joint variables of the moving rows are ``variables``."""
    names = iter(variables)
    typed = []
    for row in rows:
        name = next(names) if any(cell.motion for cell in row) else ""
        texts = [
            sum_text(
                {name: cell.motion, **cell.letters} if cell.motion else cell.letters,
                exact_text(cell.number) if j in (A, D) else angle_text(cell.number),
            )
            for j, cell in enumerate(row)
        ]
        typed.append((texts[0], texts[1], texts[2], texts[3]))
    return typed


def _factors(rows: Sequence[Row[CellSum]], convention: Convention) -> Iterator[_Factor]:
    for i, (a, alpha, d, theta) in enumerate(rows):
        z, x = _Factor(True, d, theta, i), _Factor(False, a, alpha, i)
        yield from (z, x) if convention is Convention.STANDARD else (x, z)


def _joined(factors: Sequence[_Factor]) -> list[_Factor]:
    # Neighbours along the same axis are one factor, but two joints are not.
    found: list[_Factor] = []
    for factor in factors:
        if not (factor.length or factor.angle):
            continue
        last = found[-1] if found else None
        if last and last.is_z == factor.is_z and not (last.motion and factor.motion):
            moving = factor if factor.motion else last
            found[-1] = replace(last.joined(factor), row=moving.row)
        else:
            found.append(factor)
    return found


def _alternating(factors: Sequence[_Factor], end: int) -> tuple[list[_Factor], list[_Factor]]:
    """Return the factors X_0 … X_n and Z_1 … Z_n; missing ones are the identity."""
    xs: list[_Factor] = []
    zs: list[_Factor] = []
    for factor in factors:
        if factor.is_z:
            if len(xs) == len(zs):
                xs.append(_Factor(False, CellSum(), CellSum(), factor.row))
            zs.append(factor)
        elif len(xs) > len(zs):
            xs[-1] = xs[-1].joined(factor)
        else:
            xs.append(factor)
    if len(xs) == len(zs):
        xs.append(_Factor(False, CellSum(), CellSum(), end - 1))
    return xs, zs


def _home_robot(rows: Sequence[Row[CellSum]], start: _Factor) -> HomeRobot:
    table = np.array([[cell.number for cell in row] for row in rows])
    letters = {
        (i, j): cell.letters
        for i, row in enumerate(rows)
        for j, cell in enumerate(row)
        if cell.letters
    }
    if start.length.letters:
        letters[-1, A] = start.length.letters
    lengths: dict[str, float] = {}
    for (_, j), names in letters.items():
        for name in names:
            lengths.setdefault(name, _MEAN_LENGTHS[j])
    joints = [row for row in rows if any(cell.motion for cell in row)]
    structure = "".join("P" if row[D].motion else "R" for row in joints)
    begins = start.length.number, start.angle.number
    return HomeRobot(table, structure, letters, lengths, begins)


# The table is read as in grading, but in the names that the text itself uses.


_MOST_JOINTS: Final = 10
# A cell that adds up more letters is refused.
_MOST_ROUNDS: Final = 6
_NAME: Final = regex(r"[A-Za-z][A-Za-z0-9]*(?:_[A-Za-z0-9]+)*")
# The letter O is often a zero, and a unit is no letter.
_NO_LETTERS: Final = frozenset({"o", "O", *METRES})
_UNKNOWN: Final = frozenset({"unknown_symbol", "unknown_joint", "letter_case"})
_JOINT_NAME: Final = regex(r"(?:q|th|theta|θ)i?\d*")
_SLIDE_NAME: Final = regex(r"d\d+")
# Names of the joint variable of their row, without its number.
_OWN: Final = ("q", "qi", "th", "thi", "theta", "thetai")
_OWN_SLIDE: Final = frozenset({"d", "di", "d_i"})
# Every joint may turn or slide: its variable is theta3 in the formulas, also if it is written q3.
_VARIABLES: Final = (
    *(Symbol(f"theta{i}", "angle", (f"q{i}", f"th{i}"), joint=i) for i in range(1, 12)),
    *(Symbol(name, "angle") for name in _OWN),
)
# The index of a variable of a sliding joint with a star, beside that of a turning joint.
_STARRED: Final = 100
_STAR: Final = regex(r"[\s})]*(?:\^\s*\{?\s*)?(?:\*|\\ast|\\star)")
_LITERAL: Final = regex(r"(?<![\w.}])(\d+\.?\d*|\.\d+)(?=\s*rad|(?![\w.°]))")
_PI: Final = regex(r"π|(?<![a-z])pi(?![a-z])", re.IGNORECASE)
_ANGLE: Final = regex(r"°|π|circ|(?<![a-z_])(?:pi|deg|degrees|rad)(?![a-z])", re.IGNORECASE)
_JOINT_TYPES: Final = {
    "R": regex(r"r|rev\w*|rot\w*|dreh\w*|gir\w*|.*转动.*|.*旋转.*", re.IGNORECASE),
    "P": regex(r"p|pris\w*|trans\w*|lin\w*|slid\w*|schub\w*|.*移动.*", re.IGNORECASE),
}
_MODIFIED: Final = regex(r"modifi|proximal|craig|khalil|改进", re.IGNORECASE)
# A larger angle is in degrees, whatever the text says.
_LARGEST_ANGLE: Final = 2 * math.tau
# A number of degrees is rarely less than 1, and a number of radians is rarely whole.
_LEAST_DEGREE: Final = 1.0
_UNITS: Final = ("m", "cm", "mm", "in", "ft")
_USUAL: Final = 5


class UnusableTableError(ValueError):
    """The table cannot become an exercise; the message says why."""


@dataclass(frozen=True, slots=True, kw_only=True)
class TableChoices:
    """What the author says about a table. An empty text means that nothing is said."""

    order: str = ""
    unit: str = ""
    angles: Literal["", AngleUnit] = ""
    convention: Convention | None = None


@dataclass(frozen=True, slots=True)
class Question:
    """A question to the author about a table; ``name`` is the field of TableChoices.

    The ``usual`` ones are the first of the ``choices``.
    """

    name: Literal["order", "unit", "angles", "convention"]
    text: str
    choices: tuple[str, ...]

    @property
    def usual(self) -> tuple[str, ...]:
        """The choices that are common, at most five."""
        return self.choices[:_USUAL]


class OpenQuestionsError(Exception):
    """The text does not say everything; ``questions`` are for its author."""

    def __init__(self, questions: Sequence[Question]) -> None:
        super().__init__(questions)
        self.questions = tuple(questions)


@dataclass(frozen=True)
class TextTable:
    """A table as read: its formulas, and the numbers in which its robot differs from them.

    ``own`` has the names of the joint variable in each row, ``metres`` the unit of lengths in each
    column, and ``snaps`` what was added to each cell.
    """

    convention: Convention
    formulas: Sequence[Sequence[Expression]]
    own: Sequence[frozenset[str]]
    metres: Sequence[float]
    snaps: Table

    def values(self, lengths: Mapping[str, Numbers], motions: Sequence[Numbers]) -> Table:
        """Return the numbers ``(rows, 4, samples)`` in metres and radians, after all snaps.

        ``motions`` has the values of the joint variable of each row.
        """
        table = np.empty((len(self.formulas), len(COLUMNS), len(motions[0])))
        for i, row in enumerate(self.formulas):
            values = {**lengths, **dict.fromkeys(self.own[i], motions[i])}
            for j, formula in enumerate(row):
                # The letters mean metres, the numbers the unit of the text.
                unit = self.metres[j]
                known = {name: values[name] / unit for name in formula.symbols}
                table[i, j] = unit * np.asarray(formula.evaluate(known)) + self.snaps[i, j]
        return table


@dataclass(frozen=True)
class PastedRobot:
    """The robot of a pasted table, the table as read, and remarks for its author.

    ``typed`` has the cells of the text if the table of the robot has an axis turned over.
    """

    made: TableRobot
    table: TextTable
    typed: Sequence[Row[str]]
    remarks: Sequence[str]


def pasted_robot(text: str, choices: TableChoices) -> PastedRobot:
    """Return the robot of a table in any format that students may paste.

    Raises OpenQuestionsError if the text does not say everything, and UnusableTableError.
    """
    if choices.unit not in ("", *METRES):
        raise UnusableTableError(
            say(
                "the unit {unit} is not known; use one of {known}",
                unit=choices.unit,
                known=listed(_UNITS),
            )
        )
    reading = _Reading.of(text, choices)
    _formulas(reading)
    _own_variables(reading)
    convention = _convention(reading, choices)
    angles = _angle_unit(reading, choices)
    asked = (convention, _unit(reading), angles)
    questions = [each for each in asked if isinstance(each, Question)]
    if questions:
        raise OpenQuestionsError(questions)
    assert isinstance(convention, Convention)
    assert isinstance(angles, str)
    reading = replace(reading, angle_unit=angles).again()
    return _robot(reading, convention)


_NOTHING: Final = PastedTable((), ())


@dataclass(frozen=True)
class _Reading:
    """A text read in the names that it uses; ``lengths`` are the names of lengths in it."""

    text: str
    order: Sequence[str]
    angle_unit: AngleUnit
    length_unit: str
    lengths: Mapping[str, Symbol] = field(default_factory=dict)
    table: PastedTable = _NOTHING
    entries: Sequence[Sequence[Entry]] = ()

    @classmethod
    def of(cls, text: str, choices: TableChoices) -> "_Reading":
        units = stated_units(text)
        angle = {ANGLE_UNITS[unit] for unit in units if unit in ANGLE_UNITS}
        length = {unit for unit in units if unit in METRES}
        reading = cls(
            text,
            _order(choices.order),
            choices.angles or (angle.pop() if len(angle) == 1 else "radians"),
            choices.unit or (length.pop() if len(length) == 1 else ""),
        ).again()
        if not (reading.table.is_named or choices.order):
            raise OpenQuestionsError([_ORDER])
        for _ in range(_MOST_ROUNDS):
            found = dict(reading._new_lengths())
            if not found:
                break
            reading = replace(reading, lengths={**reading.lengths, **found}).again()
        return reading

    def again(self) -> "_Reading":
        """Return the text, read with these names and units."""
        try:
            vocabulary = Vocabulary([*_VARIABLES, *self.lengths.values()], of_books=True)
        except ValueError as error:
            raise UnusableTableError(error.args[0]) from error
        samples = Samples({symbol.name: np.full(SAMPLES, 0.5) for symbol in vocabulary.symbols})
        reader = Reader(vocabulary, samples, self.angle_unit, self.length_unit or "m", WorkBudget())
        try:
            table = read_pasted_table(self.text, reader, self.order)
        except GridError as error:
            raise UnusableTableError(error.message) from None
        # Numbers stay in the unit of their header: only the letters of an exercise have another.
        bare = tuple(
            header if header.angle_unit else replace(header, unit="") for header in table.headers
        )
        entries = entries_of(replace(table, headers=bare), reader)
        return replace(self, table=table, entries=entries)

    def metres(self, j: int) -> float:
        """The unit of the lengths in column ``j``, in metres."""
        return self.table.headers[j].metres or METRES[self.length_unit or "m"]

    def _new_lengths(self) -> Iterator[tuple[str, Symbol]]:
        # A name that the reader does not know, in a column of lengths, is the name of a length. A
        # star after it marks the variable of a sliding joint. L1 is another letter than l1.
        known = {normal_form(name) for name in self.lengths}
        for entry in (row[j] for row in self.entries for j in (A, D)):
            for name, is_variable in self._unknown(entry):
                plain, ascii_name = normal_form(name), _ascii(name)
                if plain in known | _NO_LETTERS or ascii_name is None:
                    continue
                known.add(plain)
                index = re.search(r"\d+$", plain)
                joint = _STARRED + int(index[0]) if is_variable and index else None
                yield ascii_name, Symbol(ascii_name, "length", joint=joint)

    def _unknown(self, entry: Entry) -> Iterator[tuple[str, bool]]:
        for finding in entry.findings:
            if finding.code not in _UNKNOWN or not finding.span:
                continue
            start, end = finding.span
            if not _JOINT_NAME.fullmatch(normal_form(self.text[start:end]).lower()):
                yield self.text[start:end], _STAR.match(self.text[end : end + 12]) is not None
        if entry.expression is not None:
            # The reader knows the names of sliding joints that a robot does not have.
            for name in entry.expression.symbols - self.lengths.keys():
                if _SLIDE_NAME.fullmatch(name):
                    typed = rf"(d_?(?:\{{\s*{name[1:]}\s*\}}|{name[1:]}))({_STAR.pattern})?"
                    found = re.search(typed, entry.expression.source)
                    yield (found[1], bool(found[2])) if found else (name, False)


def _ascii(name: str) -> str | None:
    """Return the name of a letter in an exercise file, such as l_arm for l_{arm}, or None."""
    plain = name.strip().replace("\\ell", "l").replace("ℓ", "l").replace("\\", "")
    plain = re.sub(r"_\{\s*([^{}]*?)\s*\}", r"_\1", plain)
    plain = "".join(characters.VARIANTS.get(each, each) for each in plain)
    plain = "".join(characters.NAMES.get(each, each) for each in plain)
    if "_" not in plain:
        plain = normal_form(plain)
    return plain if _NAME.fullmatch(plain) else None


def _order(written: str) -> Sequence[str]:
    """Return the order of the columns in a text such as "alpha a d theta"."""
    if not written:
        return COLUMNS
    headers = [read_header(word) for word in re.split(r"[\s,;|]+", written.strip())]
    order = [header.column for header in headers if header]
    if sorted(order) != sorted(COLUMNS):
        raise UnusableTableError(
            say("an order names a, alpha, d and theta once each: {example}", example=_ORDERS[0])
        )
    return order


_COMMON_ORDERS: Final = (
    "a alpha d theta", "alpha a d theta", "alpha a theta d", "theta d a alpha", "d theta a alpha",
)  # fmt: skip
_ORDERS: Final = (
    *_COMMON_ORDERS,
    *(each for each in map(" ".join, permutations(COLUMNS)) if each not in _COMMON_ORDERS),
)
_ORDER: Final = Question(
    "order",
    say("The columns have no headers. What is their order?"),
    _ORDERS,
)


def _convention(reading: _Reading, choices: TableChoices) -> Convention | Question:
    table = reading.table
    named = Convention(table.convention) if table.convention else None
    if named and choices.convention not in (None, named):
        raise UnusableTableError(
            say("the script makes a table of the {convention} convention", convention=named.value)
        )
    if choices.convention or named:
        return Convention(choices.convention or named or "")
    if any(header.shifted for header in table.headers) or _MODIFIED.search(reading.text):
        text = say(
            "A header such as a_(i-1) or a word in the text suggests the modified convention. "
            "Which convention does the table have?"
        )
        return Question("convention", text, tuple(each.value for each in Convention))
    return Convention.STANDARD


def _unit(reading: _Reading) -> Question | None:
    """Return the question for the unit of the numbers, if the text has none.

    Raises UnusableTableError if an angle is in the place of a length.
    """
    question = None
    for i, row in enumerate(reading.entries):
        for j in (A, D):
            expression = row[j].expression
            if expression is None:
                continue
            if _ANGLE.search(expression.source):
                reason = say("this is an angle, but the column has lengths")
                raise _unusable(i, j, reason)
            number = _value(expression, {})
            is_said = reading.length_unit or reading.table.headers[j].metres
            if not number or is_said or question:
                continue
            text = say(
                "The table has no unit of length. In which unit is the number {number} in row "
                "{row}, column {column}?",
                number=f"{number:g}",
                row=i + 1,
                column=COLUMNS[j],
            )
            question = Question("unit", text, _UNITS)
    return question


def _angle_unit(reading: _Reading, choices: TableChoices) -> AngleUnit | Question:
    """Return the unit of angles without a unit, or a question."""
    if choices.angles or reading.angle_unit == "degrees":
        return choices.angles or "degrees"
    degrees = replace(reading, angle_unit="degrees").again()
    bare = []
    is_radians = _PI.search(reading.text) is not None
    for i, (row, other) in enumerate(zip(reading.entries, degrees.entries, strict=True)):
        for j in (ALPHA, THETA):
            first, second = row[j].expression, other[j].expression
            if first is None or second is None:
                continue
            # A number without a unit is what differs between both readings.
            number = (_value(first, {}) - _value(second, {})) / (1 - math.radians(1))
            if abs(number) < 1e-12:
                continue
            if is_multiple(number, decimals_of(_literal(first, number))):
                is_radians = True
            else:
                bare.append((i, j, number))
    for i, j, number in bare:
        is_whole = abs(number - round(number)) < 1e-9
        if is_whole or abs(number) > math.tau or (abs(number) >= _LEAST_DEGREE and not is_radians):
            text = say(
                "The table has no unit of angles. Is the number {number} in row {row}, column "
                "{column}, in degrees or in radians?",
                number=f"{number:g}",
                row=i + 1,
                column=COLUMNS[j],
            )
            return Question("angles", text, ("degrees", "radians"))
    return "radians"


def _value(formula: Expression, known: Mapping[str, float]) -> float:
    """Return the value of a formula if all names that are not ``known`` are 0."""
    values = {name: np.array([known.get(name, 0.0)]) for name in formula.symbols}
    return float(np.asarray(formula.evaluate(values)).ravel()[0])


def _literal(formula: Expression, number: float) -> str:
    """Return the text of the only number in the formula, if it is ``number``, else ""."""
    found = _LITERAL.findall(formula.source)
    if len(found) != 1 or not math.isclose(float(found[0]), abs(number), rel_tol=1e-12):
        return ""
    return f"-{found[0]}" if number < 0 else str(found[0])


def _robot(reading: _Reading, convention: Convention) -> PastedRobot:
    formulas = _formulas(reading)
    own = _own_variables(reading)
    metres = [reading.metres(j) if j in (A, D) else 1.0 for j in range(len(COLUMNS))]
    snaps = Snaps()
    rows, changes = [], np.zeros((len(formulas), len(COLUMNS)))
    for i, row_formulas in enumerate(formulas):
        cells = []
        for j, formula in enumerate(row_formulas):
            cell = _cell(i, j, formula, own[i], frozenset().union(*own))
            number = cell.number * metres[j]
            if j in (ALPHA, THETA):
                place = say("row {row}, column {column}", row=i + 1, column=COLUMNS[j])
                number = snaps.angle(place, cell.number, _literal(formula, cell.number))
                changes[i, j] = number - cell.number
            cells.append(replace(cell, number=number))
        rows.append((cells[A], cells[ALPHA], cells[D], cells[THETA]))
    made = _made(rows, convention)
    typed = typed_rows(rows, made.robot.variables) if made.turned and not made.joined else ()
    remarks = [*_notes(reading), *snaps.remarks, *_changes(made, own)]
    return PastedRobot(made, TextTable(convention, formulas, own, metres, changes), typed, remarks)


def _formulas(reading: _Reading) -> list[list[Expression]]:
    """Return the formulas of all cells. Raises UnusableTableError if one cannot be read."""
    formulas: list[list[Expression]] = []
    for i, row in enumerate(reading.entries):
        formulas.append([])
        for j, entry in enumerate(row):
            if entry.expression is None:
                reason = say("nothing is written here")
                raise _unusable(i, j, entry.findings[0].hint if entry.findings else reason)
            formulas[i].append(entry.expression)
    return formulas


def _unusable(i: int, j: int, reason: str) -> UnusableTableError:
    place = say("row {row}, column {column}", row=i + 1, column=COLUMNS[j])
    return UnusableTableError(joined(": ", [place, reason]))


def _own_variables(reading: _Reading) -> list[frozenset[str]]:
    """Return the names of the joint variable in each row, none for a fixed row."""
    found: list[frozenset[str]] = []
    joint = 1
    for i, row in enumerate(reading.entries):
        names = _variable(i, row, joint, reading.lengths)
        types = {_joint_type(text) for text in reading.table.rows[i].aside} - {""}
        symbols = {name for entry in row if entry.expression for name in entry.expression.symbols}
        # A row with the variable of a later joint, or with a type, is no fixed row.
        skipped = any(name.startswith("theta") for name in symbols) or (
            f"d{i + 1}" in symbols and joint <= i
        )
        theta = row[THETA].expression
        turns = theta is not None and names & theta.symbols
        fixed = [k for k, each in enumerate(found) if not each]
        if skipped and not names:
            raise _without_variable(fixed[-1], joint) if fixed else _misnumbered(i, joint)
        if types - ({"R" if turns else "P"} if names else set()):
            raise _without_variable(i, joint)
        found.append(names)
        joint += bool(names)
    if joint == 1:
        raise _without_variable(0, 1)
    if joint > _MOST_JOINTS + 1:
        raise UnusableTableError(say("the table has more than {most} joints", most=_MOST_JOINTS))
    return found


def _joint_type(text: str) -> str:
    """Return R or P for the name of a joint type, "" for any other text."""
    return next((kind for kind, names in _JOINT_TYPES.items() if names.fullmatch(text)), "")


def _misnumbered(i: int, joint: int) -> UnusableTableError:
    return UnusableTableError(
        say(
            "row {row} has the variable of another joint; its own is q{joint}: number the joints "
            "from 1, in the order of the rows",
            row=i + 1,
            joint=joint,
        )
    )


def _without_variable(i: int, joint: int) -> UnusableTableError:
    return UnusableTableError(
        say(
            "row {row} has no joint variable; write q{joint} into its column theta if the joint "
            "turns, or into its column d if it slides",
            row=i + 1,
            joint=joint,
        )
    )


def _variable(
    i: int, row: Sequence[Entry], joint: int, lengths: Mapping[str, Symbol]
) -> frozenset[str]:
    # The variable of joint 3 is theta3 or q3 in the column θ, or q3 or d3* in the column d. A plain
    # d3 is the variable only if the row has no other.
    d, theta = (row[j].expression for j in (D, THETA))
    names = {f"theta{joint}", *_OWN}
    slides = {f"d{joint}", f"d_{joint}", *_OWN_SLIDE}
    in_d = d.symbols if d else frozenset[str]()
    turning = names & theta.symbols if theta else set()
    sliding = names & in_d or {
        name for name in slides & in_d if name in lengths and lengths[name].joint is not None
    }
    if turning and sliding:
        raise _unusable(i, D, say("this row also has a joint variable in theta"))
    return frozenset(turning or sliding or slides & in_d)


def _cell(
    i: int, j: int, formula: Expression, own: frozenset[str], variables: frozenset[str]
) -> CellSum:
    """Return the sum of a number, letters and the joint variable ``own`` that the formula is."""
    number = _value(formula, {})
    if j in (ALPHA, THETA) and abs(number) > _LARGEST_ANGLE:
        raise _unusable(i, j, say("the angle is more than two turns; is it in degrees?"))
    factors = {name: _value(formula, {name: 1.0}) - number for name in sorted(formula.symbols)}
    at = {name: 0.3 + 0.17 * k for k, name in enumerate(factors)}
    expected = number + sum(factors[name] * at[name] for name in factors)
    if not math.isclose(_value(formula, at), expected, rel_tol=1e-9, abs_tol=1e-9):
        raise _unusable(i, j, say("write a sum of numbers, letters and the joint variable"))
    motion = sum(factors.pop(name) for name in own & factors.keys())
    for name in factors:
        if name in variables or name.startswith("theta") or name in _OWN:
            raise _unusable(i, j, say("this is the joint variable of another row"))
        if j in (ALPHA, THETA):
            raise _unusable(i, j, say("this is the letter of a length; write an angle"))
    is_place = j in (D, THETA) or not motion
    if not is_place or abs(abs(motion) - round(abs(motion))) > 1e-9 or abs(motion) > 1.5:
        raise _unusable(i, j, say("write the joint variable once, in theta or d"))
    letters = {name: float(f"{factor:.12g}") for name, factor in factors.items() if factor}
    return CellSum(number, letters, round(motion))


def _made(rows: Sequence[Row[CellSum]], convention: Convention) -> TableRobot:
    try:
        return robot_of_rows(rows, convention)
    except FixedRowError as error:
        reason = say(
            "row {row} has no joint variable, and cannot be joined with the rows beside it; a "
            "fixed row must be the last one",
            row=error.row + 1,
        )
    except FirstDirectionError as error:
        reason = say(
            "row {row} counts the joint variable negative: joint 1 moves opposite to z0, but in an "
            "exercise it counts positive along z0; write the variable without its minus sign, or "
            "turn frame {{0}} over",
            row=error.row + 1,
        )
    except FirstAxisError:
        reason = say("a and alpha before joint 1 must be 0: frame {{0}} lies on its axis")
    raise UnusableTableError(reason)


def _notes(reading: _Reading) -> Iterator[str]:
    """Yield the notes of the reader, as in grading."""
    notes = [finding.hint for finding in reading.table.findings]
    for j in (A, D):
        numbers = [row[j].expression for row in reading.entries]
        if any(formula and _value(formula, {}) for formula in numbers):
            unit = reading.table.headers[j].unit or reading.length_unit
            notes.append(
                say("The numbers of column {column} are in {unit}.", column=COLUMNS[j], unit=unit)
            )
    if any(_is_bare(reading, row[j], j) for row in reading.entries for j in (ALPHA, THETA)):
        degrees = say("Angles without a unit are in degrees.")
        radians = say("Angles without a unit are in radians.")
        notes.append(degrees if reading.angle_unit == "degrees" else radians)
    for i, row in enumerate(reading.entries):
        for column, entry in zip(COLUMNS, row, strict=True):
            place = say("row {row}, column {column}", row=i + 1, column=column)
            notes += [joined(": ", [place, finding.hint]) for finding in entry.findings]
    yield from dict.fromkeys(notes)


def _is_bare(reading: _Reading, entry: Entry, j: int) -> bool:
    formula, unit = entry.expression, reading.table.headers[j].angle_unit
    if formula is None or unit or _ANGLE.search(formula.source):
        return False
    return _value(formula, {}) != 0


def _changes(made: TableRobot, own: Sequence[frozenset[str]]) -> Iterator[Sentence]:
    for joint in made.turned:
        yield say(
            "The text has -q{joint} for joint {joint}. The file turns the axis of the joint over, "
            "so that it counts +q{joint}. Two values of alpha and signs of d and theta change, but "
            "the robot does not.",
            joint=joint,
        )
    for row in made.joined:
        yield say(
            "Row {row} has no joint variable. The file joins it with the rows beside it; the robot "
            "does not change.",
            row=row,
        )
    if not own[-1]:
        yield say("Row {row} has no joint variable: it is the row of the tool.", row=len(own))
