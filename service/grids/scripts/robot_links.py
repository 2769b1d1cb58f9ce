"""Read one link of a robotics toolbox as a row of four DH parameters.

The links are ``Link``, ``Revolute`` and ``Prismatic`` (Robotics Toolbox for MATLAB), ``DHLink``,
``RevoluteDH`` and similar classes (Robotics Toolbox for Python), and vectors (both of MATLAB's
toolboxes).
"""

from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass, field
from enum import StrEnum
from typing import Final

from service.grids.cutting.grid import GridError
from service.grids.cutting.source_text import SourceText
from service.grids.matrices.lists import unquoted
from service.grids.scripts.script import arguments, excerpt, split_call, unread_script
from service.regex import regex
from service.translations import say, say_count

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
# A name. The names of constants and of functions of numbers are not joint variables.
_NAME: Final = regex(r"[^\W\d]\w*")
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
