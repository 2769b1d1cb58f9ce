"""Find the line of each value in a TOML text.

The text must be valid TOML: this module does not check its syntax.
"""

import re
from typing import Final

from service.regex import regex
from service.translations import say

_BLANK: Final = regex(r"(?:[ \t\r\n]|#[^\n]*)*")
_KEY: Final = regex(r"""[ \t]*("(?:[^"\\\n]|\\.)*"|'[^'\n]*'|[A-Za-z0-9_-]+)[ \t]*""")
_STRINGS: Final = (
    r'"""(?:[^\\]|\\.)*?"{3,5}(?!")',
    r"'''.*?'{3,5}(?!')",
    r'"(?:[^"\\\n]|\\.)*"',
    r"'[^'\n]*'",
)
_SCALAR: Final = regex("|".join((*_STRINGS, r"[^,\]}#\n]*")), re.DOTALL)


def with_line(field: str, line: int | None) -> str:
    """Return the field with its line, if known, as in "points (line 12)"."""
    return field if line is None else say("{field} (line {line})", field=field, line=line)


def line_of(field: str, lines: dict[str, int]) -> int | None:
    """Return the line of a field such as ``parts[1].points``.

    If the field has no line, return the line of the table or list that contains it. ``lines`` comes
    from ``value_lines``.
    """
    while field and field not in lines:
        field = field[: max(field.rfind("."), field.rfind("["), 0)]
    return lines.get(field)


def value_lines(text: str) -> dict[str, int]:
    """Map the path of each value of a TOML text to its line: ``{"parts[1].points": 31, …}``."""
    return _LineFinder(text).found()


class _LineFinder:
    def __init__(self, text: str) -> None:
        self._text = text
        self._at = 0
        self._lines: dict[str, int] = {}
        # The index of the last table in each array of tables.
        self._counts: dict[str, int] = {}

    def found(self) -> dict[str, int]:
        prefix = ""
        self._skip()
        while self._at < len(self._text):
            if self._text.startswith("[", self._at):
                prefix = self._header()
            else:
                self._pair(prefix)
            self._skip()
        return self._lines

    def _skip(self, pattern: re.Pattern[str] = _BLANK) -> None:
        match = pattern.match(self._text, self._at)
        assert match is not None
        self._at = match.end()

    def _header(self) -> str:
        array = self._text.startswith("[[", self._at)
        line = self._line()
        self._at += 1 + array
        path = self._keys("", tables=True)
        if array:
            self._counts[path] = self._counts.get(path, -1) + 1
            path = f"{path}[{self._counts[path]}]"
        self._lines.setdefault(path, line)
        self._at += 1 + array
        return path

    def _pair(self, prefix: str) -> None:
        line = self._line()
        path = self._keys(prefix)
        self._lines.setdefault(path, line)
        self._at += 1  # the =
        self._value(path)

    def _keys(self, prefix: str, *, tables: bool = False) -> str:
        path = prefix
        while match := _KEY.match(self._text, self._at):
            if tables and path in self._counts:
                path = f"{path}[{self._counts[path]}]"
            name = match[1].strip("\"'")
            path = f"{path}.{name}" if path else name
            self._at = match.end()
            if not self._text.startswith(".", self._at):
                break
            self._at += 1
        return path

    def _value(self, path: str) -> None:
        self._skip()
        self._lines.setdefault(path, self._line())
        if self._text.startswith("[", self._at):
            self._inside("]", path)
        elif self._text.startswith("{", self._at):
            self._inside("}", path)
        else:
            self._skip(_SCALAR)

    def _inside(self, closing: str, path: str) -> None:
        self._at += 1
        index = 0
        self._skip()
        while self._at < len(self._text) and not self._text.startswith(closing, self._at):
            if closing == "]":
                self._value(f"{path}[{index}]")
            else:
                self._pair(path)
            index += 1
            self._skip()
            if self._text.startswith(",", self._at):
                self._at += 1
            self._skip()
        self._at += 1

    def _line(self) -> int:
        return self._text.count("\n", 0, self._at) + 1
