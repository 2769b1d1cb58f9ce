"""Find the sentences of all messages of the program, by reading its source."""

# A template is a string of at least two words in the code that reads, judges or explains. Each
# value in an f-string and each `{name}` in the template of a sentence is a gap. Texts for
# programmers (docstrings, patterns, the text of a ValueError) are no templates.

import ast
import re
from collections.abc import Iterable, Iterator, Mapping
from dataclasses import dataclass
from functools import cached_property
from string import Formatter
from typing import Final

GAP: Final = "…"
# Exceptions whose texts are not for students.
_FOR_PROGRAMMERS: Final = {"ValueError", "TypeError", "RuntimeError", "UnknownPartError"}
# The functions that take templates of sentences, where a brace is written twice.
_OF_SENTENCES: Final = {"say", "say_count", "template"}
# What is registered by these is on the pages of codes and in no message.
_RECORDS: Final = {"misconception", "check", "register"}
_PATTERN: Final = re.compile(r"\\|\(\?|\[\^|\]\+|\)\*|\[A-Z|</?m|[\[(|].*\|")
# Gaps that are filled later: {name} or {…:in other words}.
_FIELD: Final = re.compile(r"\{\w+\}|\{…(?::[^{}]*)?\}")
_WORD: Final = re.compile(r"[^\W\d_]{2,}")


@dataclass(frozen=True, slots=False)
class Template:
    """A sentence with gaps: its constant pieces in order."""

    pieces: tuple[str, ...]
    file: str

    @property
    def text(self) -> str:
        """The sentence with a placeholder for each gap."""
        return GAP.join(self.pieces).strip()

    @property
    def is_telling(self) -> bool:
        """True if the template is long enough to identify a sentence."""
        return len(_WORD.findall(self.text)) > 4

    def begins(self, sentence: str) -> bool:
        """True if the sentence begins with the first piece of the template."""
        return bool(self.pieces[0].strip()) and self._pattern.match(sentence) is not None

    def is_met_by(self, text: str) -> bool:
        """True if a text contains the sentence with its gaps filled."""
        return self._longest in text and self._pattern.search(text) is not None

    @cached_property
    def _longest(self) -> str:
        return max(self.pieces, key=len).strip()[1:]

    @cached_property
    def _pattern(self) -> re.Pattern[str]:
        first, *others = [re.escape(piece) for piece in self.text.split(GAP)]
        if first[:1].islower():
            first = f"[{first[0]}{first[0].upper()}]{first[1:]}"
        return re.compile(".*?".join([first, *others]), re.DOTALL)


def templates_in(files: Mapping[str, str]) -> list[Template]:
    # Return the templates of these files in order; each template is once per file.
    found = [
        Template(pieces, file)
        for file, text in files.items()
        for pieces in _pieces(ast.parse(text))
        if _is_prose(pieces)
    ]
    return list(dict.fromkeys(found))


def _is_prose(pieces: tuple[str, ...]) -> bool:
    text = " ".join(pieces)
    return len(_WORD.findall(text)) > 1 and " " in text.strip() and not _PATTERN.search(text)


def _pieces(tree: ast.AST) -> Iterator[tuple[str, ...]]:
    for node in ast.iter_child_nodes(tree):
        match node:
            case ast.Expr(value=ast.Constant()):  # a docstring
                continue
            case ast.Raise(exc=ast.Call(func=ast.Name(name))) if name in _FOR_PROGRAMMERS:
                continue
            case ast.Assert():
                continue
            case ast.Call(func=ast.Name(name)) if name in _RECORDS:
                continue
            case ast.Call(func=ast.Name(name)) if name in _OF_SENTENCES:
                yield from _of_call(node)
                continue
            case ast.Constant(value=str(text)):
                yield _with_gaps([text])
            case ast.JoinedStr():
                yield from _of_joined(node)
                continue
        yield from _pieces(node)


def _of_joined(node: ast.JoinedStr) -> Iterator[tuple[str, ...]]:
    pieces = [""]
    for value in node.values:
        if isinstance(value, ast.Constant):
            pieces[-1] += str(value.value)
        else:
            pieces.append("")
            yield from _pieces(value)
    yield _with_gaps(pieces)


def _of_call(call: ast.Call) -> Iterator[tuple[str, ...]]:
    for each in call.args:
        if isinstance(each, ast.Constant):
            yield _of_sentence(str(each.value))
    for value in (*call.args, *(keyword.value for keyword in call.keywords)):
        if not isinstance(value, ast.Constant):
            yield from _pieces(ast.Expression(value))


def _of_sentence(template: str) -> tuple[str, ...]:
    pieces = [""]
    for text, name, _, _ in Formatter().parse(template):
        pieces[-1] += text
        if name is not None:
            pieces.append("")
    return tuple(GAP.join(pieces).split(GAP))


def _with_gaps(pieces: Iterable[str]) -> tuple[str, ...]:
    return tuple(_FIELD.sub(GAP, GAP.join(pieces)).split(GAP))
