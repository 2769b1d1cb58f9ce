"""The values of names in a script for a robot: links, matrices and numbers."""

from collections.abc import Sized
from dataclasses import dataclass, field
from typing import Final

from service.expressions.errors import Note
from service.grids.cutting.grid import GridError, too_many_rows
from service.grids.cutting.limits import GRID_LIMITS
from service.grids.cutting.pairs import CLOSES, split, strict_pairs
from service.grids.cutting.source_text import SourceText
from service.grids.matrices import matlab
from service.grids.scripts.robot_links import LINK_CLASSES, RobotLink, read_link, vector_link
from service.grids.scripts.script import excerpt, split_call, unread_script
from service.regex import regex
from service.translations import say

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
        rows, notes = matlab.rows(source.cut(1, len(source.text) - 1))
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
