"""Read a script for a robotics toolbox as the DH table of its robot.

The script may use ``SerialLink`` and links in MATLAB, ``DHRobot`` and links in Python, or joints
with ``setFixedTransform``. Nothing is run. A script whose table is not certain is refused.
"""

# Lines that only show or move the robot are ignored. Sources: P. Corke, Robotics Toolbox for
# MATLAB, ``Link`` and ``SerialLink``; Robotics Toolbox for Python, ``DHRobot``; MathWorks, Robotics
# System Toolbox, ``rigidBodyJoint/setFixedTransform``.

import re
from dataclasses import dataclass, field
from typing import Final

from service.expressions.errors import Note
from service.grids.cutting.grid import GridError, grid
from service.grids.cutting.source_text import SourceText
from service.grids.matrices.lists import unquoted
from service.grids.scripts.given_values import GivenValue, given_numbers_note
from service.grids.scripts.robot_links import (
    LINK_CLASSES,
    JointType,
    RobotLink,
    row_of,
    transform_link,
)
from service.grids.scripts.script import (
    RobotTable,
    arguments,
    excerpt,
    split_call,
    statements,
    unread_script,
)
from service.grids.scripts.script_names import (
    NUMBERED,
    ScriptNames,
    by_numbers,
    check_count,
    in_order,
    too_many_robots,
)
from service.regex import regex
from service.translations import say, say_count

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
_NAME: Final = regex(r"[A-Za-z]\w*")
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
    read = {name for row in rows for cell in row for name in _NAME.findall(cell.text)}
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
        """Process one statement. Raises GridError for a statement that may change the table."""
        # That is, in a way that this class cannot tell.
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
        if frames := [each for each in rest if _names_frame(each)]:
            raise _has_frames(frames[0])
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


def _names_frame(argument: SourceText) -> bool:
    return unquoted(argument).text.partition("=")[0].strip() in _FRAMES


def _squeezed(name: str) -> str:
    return "".join(name.split())


def _is_declared(name: str, value: str) -> bool:
    """True if the value declares the letter as a symbol: ``a1 = symbols('a1 a2')``."""
    return _DECLARES.match(value) is not None and name in _NAME.findall(value)


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
