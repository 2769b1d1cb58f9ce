"""Scripts for robotics toolboxes: one link, the values of names, then the DH table of the robot.

Tables of dictionaries, and what toolboxes print, are in ``named_columns.py``.
"""

import re
from collections.abc import Callable, Mapping, Sequence, Sized
from dataclasses import dataclass, field
from enum import StrEnum
from typing import Final

from dh_grader.expressions.errors import Note
from dh_grader.pasting.around import GivenValue, given_numbers_note
from dh_grader.pasting.matrices import rows_in_matlab
from dh_grader.pasting.program import (
    arguments,
    excerpt,
    split_call,
    statements,
    unquoted,
    unread_script,
)
from dh_grader.pasting.source import (
    CLOSES,
    GRID_LIMITS,
    GridError,
    RobotTable,
    SourceText,
    grid,
    split,
    strict_pairs,
    too_many_rows,
)
from dh_grader.regex import regex
from dh_grader.translations import say, say_count

# --- Read one link of a robotics toolbox as a row of four DH parameters
#
# The links are ``Link``, ``Revolute`` and ``Prismatic`` (Robotics Toolbox for MATLAB), ``DHLink``,
# ``RevoluteDH`` and similar classes (Robotics Toolbox for Python), and vectors (both of MATLAB's
# toolboxes).


PARAMETERS: Final = ("a", "alpha", "d", "theta")


class JointType(StrEnum):
    """How the joint of a link moves; a fixed joint does not move."""

    REVOLUTE = "revolute"
    PRISMATIC = "prismatic"
    FIXED = "fixed"


@dataclass(slots=True)
class RobotLink:
    """A robot link as a script writes it. ``cells`` maps names of parameters to their texts."""

    # If ``joint`` is None, one of the cells contains the joint variable.

    source: SourceText
    joint: JointType | None
    modified: bool
    cells: dict[str, SourceText] = field(default_factory=dict)
    flip: bool = False


# The joint type of each class, True if its convention is the modified one, and the order of its
# arguments in Python; () if the arguments have names.
_OF_REVOLUTE: Final = ("d", "a", "alpha", "offset", "qlim", "flip")
_OF_PRISMATIC: Final = ("theta", "a", "alpha", "offset", "qlim", "flip")
_CLASSES: Final[Mapping[str, tuple[JointType | None, bool, tuple[str, ...]]]] = {
    "Link": (None, False, ()),
    "DHLink": (
        None, False,
        ("d", "alpha", "theta", "a", "sigma", "mdh", "offset", "flip", "qlim"),
    ),
    "Revolute": (JointType.REVOLUTE, False, ()),
    "Prismatic": (JointType.PRISMATIC, False, ()),
    "RevoluteDH": (JointType.REVOLUTE, False, _OF_REVOLUTE),
    "PrismaticDH": (JointType.PRISMATIC, False, _OF_PRISMATIC),
    "RevoluteMDH": (JointType.REVOLUTE, True, _OF_REVOLUTE),
    "PrismaticMDH": (JointType.PRISMATIC, True, _OF_PRISMATIC),
}  # fmt: skip
LINK_CLASSES: Final = frozenset(_CLASSES)
# The values in the vector of Link, and in the vector of setFixedTransform.
_OF_VECTOR: Final = ("theta", "d", "a", "alpha", "sigma", "offset")
_OF_TRANSFORM: Final = ("a", "alpha", "d", "theta")
_WORDS: Final = frozenset({"revolute", "prismatic", "standard", "modified", "sym"})
_KNOWN: Final = frozenset({*PARAMETERS, "offset", "sigma", "mdh", "flip"})
# Limits, masses, friction and names are not in a DH table.
_IGNORED: Final = frozenset(
    {"qlim", "I", "r", "m", "G", "B", "Jm", "Tc", "name", "mesh", "symbolic", "parent"}
)
_KEYWORD: Final = regex(r"([A-Za-z_]\w{0,20})\s*=(?!=)\s*")
_ZERO: Final = regex(r"[-+]?0{1,20}(?:\.0{0,20})?")
_TRUE: Final = frozenset({"1", "True", "true"})
_FALSE: Final = frozenset({"0", "False", "false"})
_NAME: Final = regex(r"[^\W\d]\w*")
# The names of constants and of functions of numbers are not joint variables.
_CONSTANTS: Final = frozenset(
    {"pi", "Pi", "PI", "np", "numpy", "math", "sp", "sympy", "deg", "rad", "deg2rad", "radians"}
    | {"sym", "Rational", "sqrt", "S", "e", "E", "π"}
)
# In d, only a name such as q1 is a joint variable.
_JOINT_LENGTH: Final = regex(r"(?<!\w)q_?\d")
_SHOWN: Final = {"d": "d", "theta": "θ"}
_ALONE: Final = regex(r"[^\W\d][\w.]*(?:[({\[]\d{1,2}[)}\]])?")

# Returns the values of a row in brackets or of a named row; None for any other text.
Vector = Callable[[SourceText], Sequence[SourceText] | None]


def read_link(source: SourceText, vector: Vector) -> RobotLink | None:
    """Return the link that a call such as ``Revolute(…)`` makes; None for any other text.

    Raises GridError if the link's row is not certain.
    """
    # ``vector`` finds the values of a row, in brackets or by its name.
    call = split_call(source)
    if call is None or call[0] not in _CLASSES:
        return None
    name, inside = call
    joint, modified, order = _CLASSES[name]
    given = _Given.of(arguments(inside), order, vector)
    return _link(given, joint, source, modified=modified)


def vector_link(values: Sequence[SourceText], source: SourceText, *, modified: bool) -> RobotLink:
    """Return the link of the values [θ d a α], [θ d a α σ] or [θ d a α σ offset].

    Raises GridError for another number of values.
    """
    return _link(_Given.of_vector(values, source), None, source, modified=modified)


def _link(
    given: "_Given", joint: JointType | None, source: SourceText, *, modified: bool
) -> RobotLink:
    named = given.named
    modified = modified or "modified" in given.words or _truth(named, "mdh")
    cells = {key: value for key, value in named.items() if key in (*PARAMETERS, "offset")}
    flip = _truth(named, "flip")
    return RobotLink(source, joint or _joint(given, source), modified, cells, flip)


@dataclass(slots=True)
class _Given:
    # The arguments of a link: values by name, and words without a value, such as 'modified'.
    # ``in_python`` is True if arguments are written ``name=value`` or by position.
    named: dict[str, SourceText] = field(default_factory=dict)
    words: set[str] = field(default_factory=set)
    in_python: bool = False
    has_vector: bool = False

    @staticmethod
    def of(given: Sequence[SourceText], order: Sequence[str], vector: Vector) -> "_Given":
        values = vector(given[0]) if given and not order else None
        found = _Given() if values is None else _Given.of_vector(values, given[0])
        at = 0 if values is None else 1
        while at < len(given):
            at += found._take(given[at : at + 2], order[at : at + 1])
        return found

    @staticmethod
    def of_vector(values: Sequence[SourceText], source: SourceText) -> "_Given":
        if not len(PARAMETERS) <= len(values) <= len(_OF_VECTOR):
            raise unread_script(
                say_count(
                    "`{text}` has one value. A link is [theta d a alpha], with 0 or 1 for the "
                    "joint type and an offset behind them.",
                    "`{text}` has {count} values. A link is [theta d a alpha], with 0 or 1 for the "
                    "joint type and an offset behind them.",
                    count=len(values),
                    text=excerpt(source),
                ),
                source,
            )
        return _Given(dict(zip(_OF_VECTOR, values, strict=False)), has_vector=True)

    def _take(self, pair: Sequence[SourceText], place: Sequence[str]) -> int:
        first = pair[0]
        if keyword := _KEYWORD.match(first.text):
            self.in_python = True
            self._put(keyword[1], first.cut(keyword.end(), len(first.text)), first)
            return 1
        word = unquoted(first).text
        if word == first.text and place:
            self.in_python = True
            self._put(place[0], first, first)
            return 1
        if word != first.text and word in _WORDS:
            self.words.add(word)
            return 1
        if word == first.text or len(pair) < 2:
            raise _unknown(first)
        self._put(word, pair[1], first)
        return 2

    def _put(self, name: str, value: SourceText, at: SourceText) -> None:
        if name in _IGNORED:
            return
        if name not in _KNOWN or name in self.named:
            raise _unknown(at)
        self.named[name] = value


def _joint(given: _Given, link: SourceText) -> JointType:
    named = given.named
    types = {JointType(word) for word in given.words & {"revolute", "prismatic"}}
    if "sigma" in named:
        types.add(JointType.PRISMATIC if _truth(named, "sigma") else JointType.REVOLUTE)
    by_name = not given.has_vector and not given.in_python
    if not types and by_name:
        # In MATLAB, the one of d and theta that is given is constant; the other is the variable.
        types = {
            joint
            for name, joint in (("d", JointType.REVOLUTE), ("theta", JointType.PRISMATIC))
            if name in named
        }
    if len(types) > 1 or (not types and by_name and (named or given.words)):
        raise unread_script(
            say(
                "`{text}` leaves open whether the joint is revolute or prismatic. Write "
                "`Revolute(…)` or `Prismatic(…)`.",
                text=excerpt(link),
            ),
            link,
        )
    return types.pop() if types else JointType.REVOLUTE


def _truth(named: Mapping[str, SourceText], name: str) -> bool:
    value = named.get(name)
    if value is None or value.text in _FALSE:
        return False
    if value.text not in _TRUE:
        raise _unknown(value)
    return True


def _unknown(source: SourceText) -> GridError:
    return unread_script(
        say(
            "`{text}` is not understood here. Write a, alpha, d, theta and offset of each link, "
            "each once.",
            text=excerpt(source),
        ),
        source,
    )


def transform_link(
    values: Sequence[SourceText], joint: JointType | None, source: SourceText, *, modified: bool
) -> RobotLink:
    """Return the link of ``setFixedTransform(joint, [a alpha d theta], 'dh')``.

    Raises GridError unless there are four values.
    """
    # If the type of the joint is not known, one value must contain the joint variable.
    if len(values) != len(_OF_TRANSFORM):
        raise unread_script(
            say_count(
                "`{text}` has one value. setFixedTransform takes [a alpha d theta].",
                "`{text}` has {count} values. setFixedTransform takes [a alpha d theta].",
                count=len(values),
                text=excerpt(source),
            ),
            source,
        )
    cells = dict(zip(_OF_TRANSFORM, values, strict=True))
    is_written = has_variable(cells["theta"].text) or _JOINT_LENGTH.search(cells["d"].text)
    if joint is None and not is_written:
        raise unread_script(
            say(
                "`{text}` holds no joint variable. Paste the line with the type of this joint, "
                "too: `rigidBodyJoint('jnt1', 'revolute')`.",
                text=excerpt(source),
            ),
            source,
        )
    return RobotLink(source, joint, modified, cells)


@dataclass(frozen=True, slots=True)
class LinkRow:
    """The cells a, α, d, θ of a link, and the name that was given to its joint variable."""

    cells: tuple[SourceText, ...]
    added: str = ""


def row_of(link: RobotLink, number: int) -> LinkRow:
    """Return the table row of a link; ``number`` is the number of its joint.

    Raises GridError if the toolbox ignores a value in the row.
    """
    # A joint variable that the script only implies is named ``q`` with the number. The value that
    # the toolbox ignores is in the cell of the variable.
    if not all(cell.text for cell in link.cells.values()):
        raise _unknown(link.source)
    zero = link.source.spelled("0")
    cells = {name: link.cells.get(name, zero) for name in PARAMETERS}
    added = ""
    if link.joint in (JointType.REVOLUTE, JointType.PRISMATIC):
        column = "d" if link.joint is JointType.PRISMATIC else "theta"
        if _is_zero(cells[column]):
            added = f"q{number}"
            cells[column] = link.source.spelled(added)
        cells[column] = _moved(link, cells[column], column)
    return LinkRow(tuple(cells[name] for name in PARAMETERS), added)


def _moved(link: RobotLink, variable: SourceText, column: str) -> SourceText:
    offset = link.cells.get("offset")
    if offset is not None and _is_zero(offset):
        offset = None
    changed = offset is not None or link.flip
    if not has_variable(variable.text) or (changed and not _ALONE.fullmatch(variable.text)):
        raise unread_script(
            say(
                "The toolbox ignores `{text}`, for {parameter} is the variable of this joint. "
                "Write 0 there, and a constant as offset.",
                text=excerpt(variable),
                parameter=_SHOWN[column],
            ),
            variable,
        )
    if not changed:
        return variable
    text = f"-{variable.text}" if link.flip else variable.text
    if offset is None:
        return variable.spelled(text)
    signed = offset.text[0] in "+-"
    sign, size = (offset.text[0], offset.text[1:].strip()) if signed else ("+", offset.text)
    return offset.spelled(f"{text} {sign} {size}")


def has_variable(text: str) -> bool:
    """True if a text contains a name that is not the name of a constant."""
    return any(name not in _CONSTANTS for name in _NAME.findall(text))


def _is_zero(value: SourceText) -> bool:
    return _ZERO.fullmatch(value.text) is not None


# --- The values of names in a script for a robot: links, matrices and numbers


# A name, one of its elements, or all of them: L, L(2), L{2}, L[1], L(:), DH(2,:).
NAMED: Final = regex(
    r"(?P<name>[A-Za-z_]\w{0,60})(?:\s?(?P<bracket>[({\[])\s?(?P<index>:|\d{1,2})"
    r"\s?(?P<columns>,\s?:)?\s?[)}\]])?"
)
NUMBERED: Final = regex(r"(.*?)(\d{1,2})[)}\]]?")
_MOST_ROWS: Final = GRID_LIMITS.rows - 1
# The same link may have a name of its own and be in lists, too.
_MOST_LINKS: Final = 4 * _MOST_ROWS

Links = dict[int, RobotLink]


@dataclass(slots=True)
class ScriptNames:
    """The values that a script gives to names.

    ``links`` maps the name of a list to its robot links, by number.
    """

    # Other values are stored by name, or by name and number.

    links: dict[str, Links] = field(default_factory=dict)
    notes: list[Note] = field(default_factory=list)
    _count: int = 0
    _elements: dict[tuple[str, int], SourceText | None] = field(default_factory=dict)
    _values: dict[str, SourceText] = field(default_factory=dict)
    _matrices: dict[str, list[list[SourceText]]] = field(default_factory=dict)

    def name_value(self, name: str, value: SourceText) -> None:
        """Store a value that is not a robot link under its name."""
        self._values[name] = value
        self._matrices.pop(name, None)

    def name_element(self, name: str, number: int, value: SourceText) -> None:
        """Store the value of an element of a list: ``d(2) = 0.4``."""
        known = self._elements.setdefault((name, number), value)
        if known is None or known.text != value.text:
            self._elements[name, number] = None

    def element(self, cell: SourceText) -> SourceText:
        """Return the value that the script gives to a cell such as ``d(2)``, or the cell itself.

        Raises GridError if it has two values.
        """
        named = NAMED.fullmatch(cell.text)
        if not named or not (named["index"] or "").isdigit() or named["columns"]:
            return cell
        name, number = named["name"], int(named["index"]) + (named["bracket"] == "[")
        if (name, number) in self._elements:
            value = self._elements[name, number]
            if value is None:
                raise unread_script(
                    say(
                        "The script gives `{name}` two values. Write its value here.",
                        name=excerpt(cell),
                    ),
                    cell,
                )
            return value
        rows = self._matrix(cell.cut(0, len(name))) if name in self._values else None
        if rows and len(rows) == 1 and 1 <= number <= len(rows[0]):
            return rows[0][number - 1]
        return cell

    def name_links(
        self, statement: SourceText, name: str, number: int | None, links: list[RobotLink]
    ) -> None:
        """Store links as the list ``name``, or one link as the list's element ``number``."""
        # The number 0 means the element after the last one.
        known = self.links.setdefault(name, {})
        first = len(known) + 1 if number == 0 else number or 1
        if known if number is None else first in known or len(links) > 1:
            raise unread_script(
                say(
                    "`{text}` gives a link a second value. Keep the one that counts.",
                    text=excerpt(statement),
                ),
                statement,
            )
        known.update(enumerate(links, first))
        check_count(known, statement)
        self._count += len(links)
        if self._count > _MOST_LINKS:
            raise too_many_rows(statement.whole)

    def links_of(self, source: SourceText) -> list[RobotLink] | None:
        """Return the robot links that an expression lists, or None."""
        link = read_link(source, self.vector)
        if link is not None:
            return [link]
        if named := NAMED.fullmatch(source.text):
            known = self.links.get(named["name"])
            if known is None or named["columns"]:
                return None
            if named["index"] in (None, ":"):
                return in_order(known, source)
            one = known.get(int(named["index"]) + (named["bracket"] == "["))
            return [one] if one else None
        if source.text[:1] not in CLOSES or strict_pairs(source)[0] != len(source.text):
            return None
        inside = source.cut(1, len(source.text) - 1)
        pieces = [piece for piece in split(inside, ",; \t\n\r") if piece.text]
        links: list[RobotLink] = []
        for piece in pieces[: _MOST_ROWS + 1]:
            found = self.links_of(piece) if piece.text[0] not in CLOSES else None
            if found is None:
                return None
            links += found
        check_count(links, source)
        return links or None

    def vector(self, source: SourceText) -> list[SourceText] | None:
        """Return the values of a row in brackets or of a row of a named matrix, or None."""
        named = NAMED.fullmatch(source.text)
        if named and named["columns"] and named["index"] != ":":
            rows = self._matrix(source.cut(*named.span("name")))
            number = int(named["index"])
            return rows[number - 1] if rows and 1 <= number <= len(rows) else None
        rows = self._matrix(source)
        return rows[0] if rows and len(rows) == 1 else None

    def _matrix(self, source: SourceText) -> list[list[SourceText]] | None:
        name = source.text
        if name in self._matrices:
            return self._matrices[name]
        source = self._values.get(name, source)
        if source.text[:1] != "[" or strict_pairs(source)[0] != len(source.text):
            return None
        rows, notes = rows_in_matlab(source.cut(1, len(source.text) - 1))
        self.notes += notes
        stripped = [[cell.strip() for cell in row] for row in rows]
        if name in self._values:
            self._matrices[name] = stripped
        return stripped

    def links_of_matrix(self, source: SourceText, *, modified: bool) -> list[RobotLink] | None:
        """Return the robot links that ``SerialLink([theta d a alpha; …])`` makes, or None."""
        # None if there is no matrix, or if it lists links that are not all known.
        rows = self._matrix(source)
        if not rows or any(map(self._lists_links, rows)):
            return None
        check_count(rows, source)
        return [vector_link(row, _line_of(row), modified=modified) for row in rows]

    def _lists_links(self, row: list[SourceText]) -> bool:
        """True if the cells of a row are links (L1 L2 L3 L4), and not values."""
        named = [NAMED.fullmatch(cell.text) for cell in row]
        if any(each["name"] in self.links for each in named if each):
            return True
        if any((call := split_call(cell)) and call[0] in LINK_CLASSES for cell in row):
            return True
        stems = {(each := NUMBERED.fullmatch(cell.text)) and each[1] for cell in row}
        return all(named) and len(stems) == 1 < len(row) and None not in stems


def by_numbers(named: dict[str, Links], source: SourceText) -> list[RobotLink]:
    """Return the links L1, L2, … in order. Raises GridError for any other name."""
    found: Links = {}
    stems = set()
    for name, links in named.items():
        numbered = NUMBERED.fullmatch(name)
        if numbered is None or len(links) > 1:
            raise too_many_robots(source)
        stems.add(numbered[1])
        found[int(numbered[2])] = links[1]
    first = min(found)
    if len(stems) > 1 or len(found) < len(named) or first > 1:
        raise too_many_robots(source)
    return in_order({number - first + 1: link for number, link in found.items()}, source)


def in_order(links: Links, source: SourceText) -> list[RobotLink]:
    """Return the links in the order of their numbers. Raises GridError if a number is missing."""
    for number in range(1, len(links) + 1):
        if number not in links:
            raise unread_script(
                say("Link {number} is not in this text. Add it.", number=number), source
            )
    return [links[number] for number in range(1, len(links) + 1)]


def _line_of(row: list[SourceText]) -> SourceText:
    text = " ".join(cell.text for cell in row)
    start, end = row[0].whole[0], max(row[0].whole[1], row[-1].whole[1])
    return SourceText(text, (start,) * len(text), (end,) * len(text), start, row[0].typed)


def check_count(links: Sized, source: SourceText) -> None:
    """Raise GridError if a robot has too many links."""
    if len(links) > _MOST_ROWS:
        raise too_many_rows(source.whole)


def too_many_robots(source: SourceText) -> GridError:
    """Return the error for a script that may describe several robots."""
    return unread_script(
        say("This may be more than one robot. Paste one, and write its links in one list."), source
    )


# --- Read a script for a robotics toolbox as the DH table of its robot
#
# The script may use ``SerialLink`` and links in MATLAB, ``DHRobot`` and links in Python, or joints
# with ``setFixedTransform``. Nothing is run. A script whose table is not certain is refused.
#
# Lines that only show or move the robot are ignored.
#
# Sources: P. Corke, Robotics Toolbox for
# MATLAB, ``Link`` and ``SerialLink``; Robotics Toolbox for Python, ``DHRobot``; MathWorks, Robotics
# System Toolbox, ``rigidBodyJoint/setFixedTransform``.


_ROBOTS: Final = frozenset({"SerialLink", "DHRobot"})
_TRANSFORM: Final = "setFixedTransform"
_JOINT: Final = "rigidBodyJoint"
_CALLS: Final = "|".join(sorted({*LINK_CLASSES, *_ROBOTS, _TRANSFORM}, key=len, reverse=True))
# Calls that occur only in a script for a robot. ``Link (i)`` may be the header of a table.
_SCRIPT: Final = regex(
    r"(?<!\w)(?:(?:DHLink|(?:Revolute|Prismatic)M?DH|SerialLink|DHRobot|setFixedTransform)\("
    r"|(?:Link|Revolute|Prismatic)\s?\((?=[\['\")]|\w{1,20}\s?=|\w{1,20}\(|\w{1,20}\s?,\s?['\"]))"
)
_WORD: Final = regex(rf"(?<!\w)(?:{_CALLS})\s?\(")
_SIGNS_OF_A_SCRIPT: Final = ("Link", "Revolute", "Prismatic", "DHRobot", _TRANSFORM)

_CONTROL: Final = regex(
    r"(?:for|parfor|while|if|elif|elseif|else|switch|case|function|def|class|try|with)(?!\w)"
)
_ASSIGNMENT: Final = regex(
    r"(?P<name>[A-Za-z_]\w{0,60})(?:\s?(?P<bracket>[({\[])\s?(?P<index>\d{1,2}|end\s?\+\s?1)\s?[)}\]])?"
    r"(?:\.(?P<property>\w{1,30}))?\s*=(?!=)\s*"
)
_APPENDED: Final = regex(r"(?P<name>[A-Za-z_]\w{0,60})\.append\s?\(")
# Statements that change a list of links, or multiply a parameter and so on.
_ALTERED: Final = regex(
    r"(?:del\s{1,9}(?P<deleted>[A-Za-z_]\w{0,60})|(?P<name>[A-Za-z_]\w{0,60})"
    r"(?:\.(?:reverse|pop|insert|remove|clear|sort|extend)\s?\(|[^=]{0,40}?[-+*/]=(?!=)))"
)
_LINKS: Final = regex(r"links\s?=(?!=)\s*")
_SHOWS: Final = frozenset({"print", "disp", "display"})
_DECLARES: Final = regex(r"(?:\w{1,20}\.)?(?:symbols|Symbol|sym|syms|var)\s?\(")
_LETTERS: Final = regex(r"[A-Za-z]\w*")
# Properties that change a link or the robot; the others are limits, masses, plots.
_CELLS: Final = frozenset({"a", "alpha", "d", "theta", "offset"})
_FRAMES: Final = frozenset({"base", "tool"})
_CHANGE: Final = regex(
    r"[^=]{0,80}\.\s?(?:a|alpha|d|theta|offset|base|tool|sigma|mdh|flip|jointtype|JointAxis|links)"
    r"\s?(?:[(\[{][^=]{0,20})?=(?!=)"
)
# A link as MATLAB shows it, once it is made.
_PRINTED: Final = regex(r"(?:Revolute|Prismatic)\((?:std|mod)\)")
_MOST_NAMES: Final = 12


def describes_robot(text: str) -> bool:
    """True if a text seems to be a script that builds a robot from links."""
    return any(map(text.__contains__, _SIGNS_OF_A_SCRIPT)) and _SCRIPT.search(text) is not None


def read_script(source: SourceText) -> RobotTable | None:
    """Return the DH table of the robot in a script, or None.

    Raises GridError for several robots, or if the table is not certain.
    """
    # None if only comments name a link.
    script = _Script()
    found = statements(source)
    if not any(_WORD.search(statement.text) for statement in found):
        return None
    for statement in found:
        script.take(statement)
    links = script.robot_links(source)
    rows, added, number = [], [], 0
    for link in links:
        link.cells = {column: script.names.element(cell) for column, cell in link.cells.items()}
        number += link.joint is not JointType.FIXED
        row = row_of(link, number)
        rows.append(row.cells)
        added += [row.added] * bool(row.added)
    if len({link.modified for link in links}) > 1:
        raise unread_script(
            say("Some links are standard and some modified. Write all of them in one convention."),
            source,
        )
    read = {name for row in rows for cell in row for name in _LETTERS.findall(cell.text)}
    notes = [
        _note(links, added),
        *script.names.notes[:1],
        *given_numbers_note([each for each in script.given if each.name in read], read),
    ]
    convention = "modified" if links[0].modified else "standard"
    return RobotTable(grid("script", rows, source.whole, notes), convention)


def _note(links: list[RobotLink], added: list[str]) -> Note:
    message = say("Each link of the script was read as a row.")
    if added:
        message = say_count(
            "Each link of the script was read as a row, with the joint variable {names}.",
            "Each link of the script was read as a row, with the joint variables {names}.",
            count=len(added),
            names=", ".join(added[:_MOST_NAMES]),
        )
    first, last = links[0].source.whole, links[-1].source.whole
    return Note("script_rows", message, (min(first[0], last[0]), max(first[1], last[1])))


@dataclass(slots=True)
class _Script:
    names: ScriptNames = field(default_factory=ScriptNames)
    unnamed: list[RobotLink] = field(default_factory=list)
    placed: list[RobotLink] = field(default_factory=list)
    robot: list[RobotLink] | None = None
    joints: dict[str, JointType | None] = field(default_factory=dict)
    given: list[GivenValue] = field(default_factory=list)
    controlled: bool = False
    last_number: int = 0

    def take(self, statement: SourceText) -> None:
        """Process one statement.

        Raises GridError for a statement that may change the table in an unknown way.
        """
        text = statement.text
        has_call = _WORD.search(text) is not None
        if _CONTROL.match(text):
            self.controlled = True
        if _PRINTED.match(text):
            return
        changes = _CHANGE.match(text)
        if self.controlled and (has_call or changes):
            raise unread_script(
                say(
                    "Loops, conditions and functions are not run. "
                    "Write one `Link(…)` for each link."
                ),
                statement,
            )
        found = _ASSIGNMENT.match(text)
        if self._alters(text):
            raise _unclear(statement)
        if changes:
            self._change(statement, found)
        elif found:
            self._assign(statement, found, statement.cut(found.end(), len(text)), has_call=has_call)
        elif has_call:
            self._call(statement)

    def _assign(
        self, statement: SourceText, found: re.Match[str], value: SourceText, *, has_call: bool
    ) -> None:
        name = found["name"]
        call = split_call(value) if "(" in value.text else None
        if call and call[0] == _JOINT:
            self.joints[_squeezed(found[0].rstrip("= \t"))] = _joint_type(call[1])
            return
        links = self.names.links_of(value) if has_call or self.names.links else None
        if links is not None and not found["property"]:
            self.names.name_links(statement, name, _number(found), links)
        elif has_call and not self._makes_robot(value):
            raise _unclear(statement)
        elif has_call or found["property"]:
            return
        elif name in self.names.links and self.robot is None and value.text:
            raise _unclear(statement)
        elif number := _number(found):
            self.names.name_element(name, number, value)
        elif number is None:
            self.names.name_value(name, value)
            if not _is_declared(name, value.text):
                self.given.append(GivenValue(name, value.text, statement))

    def _alters(self, text: str) -> bool:
        found = _ALTERED.match(text)
        return found is not None and (found["name"] or found["deleted"]) in self.names.links

    def _change(self, statement: SourceText, found: re.Match[str] | None) -> None:
        """Process a statement that sets a parameter of a link: ``L(2).offset = pi/2``."""
        changed = found["property"] if found else None
        if changed in _FRAMES:
            raise _has_frames(statement)
        known = self.names.links.get(found["name"], {}) if found else {}
        number = _number(found) if found else None
        link = known.get(number or 1)
        if found is None or link is None or changed not in _CELLS or number == 0:
            raise _unclear(statement)
        if number is None and len(known) > 1:
            raise _unclear(statement)
        link.cells[changed] = statement.cut(found.end(), len(statement.text))

    def _call(self, statement: SourceText) -> None:
        if appended := _APPENDED.match(statement.text):
            links = self.names.links_of(statement.cut(appended.end(), len(statement.text) - 1))
            if links is None or not statement.text.endswith(")"):
                raise _unclear(statement)
            self.names.name_links(statement, appended["name"], 0, links)
            return
        call = split_call(statement)
        if call and call[0] in _SHOWS:
            statement = call[1].strip()
            call = split_call(statement)
        if call and call[0] == _TRANSFORM:
            self._place(statement, arguments(call[1]))
            return
        if self._makes_robot(statement):
            return
        links = self.names.links_of(statement)
        if links is None:
            raise _unclear(statement)
        self.unnamed += links
        check_count(self.unnamed, statement)

    def _makes_robot(self, source: SourceText) -> bool:
        call = split_call(source)
        if call is None or call[0] not in _ROBOTS:
            return False
        given = arguments(call[1]) or [call[1]]
        first, *rest = sorted(given, key=lambda each: _LINKS.match(each.text) is None)
        if keyword := _LINKS.match(first.text):
            first = first.cut(keyword.end(), len(first.text))
        words = {unquoted(each).text for each in rest}
        names = {each.text.partition("=")[0].strip() for each in rest if "=" in each.text}
        for each in rest:
            if unquoted(each).text.partition("=")[0].strip() in _FRAMES:
                raise _has_frames(each)
        if "offset" in words | names:
            raise _unclear(source)
        links = self.names.links_of(first)
        if links is None:
            links = self.names.links_of_matrix(first, modified="modified" in words)
        if links is None:
            raise unread_script(
                say(
                    "The links `{text}` are not in this text. Paste the lines that make them, too.",
                    text=excerpt(first),
                ),
                first,
            )
        if self.robot is not None and list(map(id, self.robot)) != list(map(id, links)):
            raise too_many_robots(source)
        self.robot = links
        return True

    def _place(self, statement: SourceText, given: list[SourceText]) -> None:
        """Process ``setFixedTransform(jnt1, [a alpha d theta], 'dh')``."""
        kind = unquoted(given[2]).text if len(given) == 3 else ""
        values = self.names.vector(given[1]) if kind in {"dh", "mdh"} else None
        if values is None:
            raise unread_script(
                say("setFixedTransform is read with [a alpha d theta] and 'dh' or 'mdh'."),
                statement,
            )
        joint = _squeezed(given[0].text)
        if numbered := NUMBERED.fullmatch(joint):
            number = int(numbered[2])
            if number <= self.last_number:
                raise unread_script(
                    say(
                        "The joints are not in the order of their numbers. "
                        "Put their lines in order."
                    ),
                    statement,
                )
            self.last_number = number
        self.placed.append(
            transform_link(values, self.joints.get(joint), statement, modified=kind == "mdh")
        )
        check_count(self.placed, statement)

    def robot_links(self, source: SourceText) -> list[RobotLink]:
        """Return the robot's links in order. Raises GridError if their order is not certain."""
        if self.placed:
            if self.robot or self.names.links or self.unnamed:
                raise too_many_robots(source)
            return self.placed
        if self.robot is not None:
            return self.robot
        named = [in_order(links, source) for links in self.names.links.values()]
        if self.unnamed or not named:
            if named or not self.unnamed:
                raise _unclear(source)
            return self.unnamed
        longest = max(named, key=len)
        others = {id(link) for links in named for link in links}
        if others == set(map(id, longest)):
            return longest
        return by_numbers(self.names.links, source)


def _number(found: re.Match[str]) -> int | None:
    # Return the number of the link, from 1, in ``L(2) = ``.
    # Return None without brackets, and 0 if the index is not a number (the link is the next one).
    index = found["index"]
    if index is None:
        return None
    return int(index) + (found["bracket"] == "[") if index.isdigit() else 0


def _joint_type(inside: SourceText) -> JointType | None:
    given = arguments(inside)
    if len(given) < 2:
        return JointType.FIXED
    named = unquoted(given[1]).text
    return JointType(named) if named in set(JointType) else None


def _squeezed(name: str) -> str:
    return "".join(name.split())


def _is_declared(name: str, value: str) -> bool:
    """True if the value declares the letter as a symbol: ``a1 = symbols('a1 a2')``."""
    return _DECLARES.match(value) is not None and name in _LETTERS.findall(value)


def _has_frames(source: SourceText) -> GridError:
    return unread_script(
        say(
            "`{text}` is no link. Delete it, or paste the DH table with a row for it.",
            text=excerpt(source),
        ),
        source,
    )


def _unclear(source: SourceText) -> GridError:
    return unread_script(
        say(
            "`{text}` is not understood here. Write each link as `L(1) = Link(…)`, and the robot "
            "as `SerialLink(L)`.",
            text=excerpt(source),
        ),
        source,
    )
