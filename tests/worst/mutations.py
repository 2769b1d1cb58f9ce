"""Change request bodies at random, as an attacker would."""

import copy
import json
import random
import re
from collections.abc import Callable, Iterator, Sequence
from typing import Any

from tests.pasting.writers import FORMATS
from tests.worst.entry_points import FRAMES, PREVIEW, PREVIEWS, SUBMITTED, Attack
from tests.worst.seeds import NESTING, RUNS, runs

# A list or object, and the index or key of one of its items.
Place = tuple[Any, Any]

PIECES = (
    *("//", "½", "²", "π", "θ", "₁", "°", "\u0301", "\u200b", "^", "_", "(", ")", "[", "]", "{"),
    *("}", "$", "&", "|", ",", ";", "\n", "\t", " ", "\\\\", "\\frac", "\\sin ", "=", "==", "'"),
    *('"', "%"),
    *("sin", "cos", "atan2(", "q1", "theta2", "d3", "l1", "c12", "0", "1", "1.23", "0.785", "deg"),
    *("rad", "mm", "+", "-", "*", "/", ".", "E", "e", "i", "j", "A1 = ", "...", "<td>", "<tr>"),
    *("\\begin{bmatrix}", "\\end{bmatrix}", "[[", "]]", "Matrix(", "sym(", "array(", ">> "),
)  # fmt: skip
WRAPS = (
    "({})", "-({})", "sin({})", "\\frac{{{}}}{{2}}", "sqrt({})", "${}$", "[{}]", "|{}|", "{}^2",
    "{} = {}", "\\left({}\\right)", "sin {}", "{}deg", "{{{}}}", "cos({})*cos({})",
)  # fmt: skip
LENGTHS = (60, 120, 240, 250, 480, 500, 900, 1000, 1500, 2000, 4000, 7900, 15_000, 25_000)
HUGE = (60_000, 240_000)
LONGEST = 260_000
# The field that is changed in a body without answers; that of frames is in its table.
_ONLY = {PREVIEWS: "entries", FRAMES: "rows"}


class Mutator:
    """Changes request bodies at random; ``cells`` are texts to insert."""

    def __init__(self, choose: random.Random, cells: Sequence[str]) -> None:
        self._choose = choose
        self._cells = cells
        self._of_text: tuple[Callable[[str], str], ...] = (
            self._repeated, self._lengthened, self._wrapped, self._pieced, self._cut,
            self._renumbered, self._spliced, self._replaced,
            self._run, self._nested, self._run_inside,
        )  # fmt: skip

    def mutated(self, attack: Attack, others: Sequence[Attack]) -> Attack:
        """Return a randomly changed body."""
        body = copy.deepcopy(dict(attack.body))
        for _ in range(self._choose.choice((1, 1, 1, 2, 3))):
            if attack.entry == PREVIEW:
                body["text"] = self._text(body["text"])
            elif attack.entry in _ONLY:
                # Parts of other bodies do not fit here.
                holder = body["table"] if attack.entry == FRAMES else body
                only = {_ONLY[attack.entry]: holder[_ONLY[attack.entry]]}
                self._answers(only, {})
                holder |= only
            else:
                other = self._choose.choice(others).body.get("answers", {}) if others else {}
                self._answers(body["answers"], other)
        if self._choose.random() < 0.03:
            body["angle_unit"] = self._choose.choice(("radians", "degrees"))
        if attack.entry in SUBMITTED and self._choose.random() < 0.03:
            body["echo"] = self._choose.random() < 0.5
        if attack.entry in SUBMITTED and self._choose.random() < 0.03:
            body["feedback"] = self._choose.choice(("full", "hints", "verdicts", "score"))
        found = Attack(attack.entry, attack.exercise, body)
        return found if len(found.content) < LONGEST else attack

    def _answers(self, answers: dict[str, Any], other: dict[str, Any]) -> None:
        if not answers:
            if other:
                self._borrowed(answers, other)
            return
        steps: list[Callable[[], None]] = [lambda: self._in_leaf(answers)] * 6
        steps += [lambda: self._spread_leaf(answers), lambda: self._swapped(answers)] * 2
        steps += [lambda: self._other_length(answers), lambda: self._pasted(answers)]
        steps += [lambda: self._numbers_everywhere(answers), lambda: self._dropped(answers)]
        if other:
            steps += [lambda: self._borrowed(answers, other)] * 2
        self._choose.choice(steps)()

    def _leaves(self, value: Any) -> Iterator[Place]:
        keys = range(len(value)) if isinstance(value, list) else list(value)
        for key in keys:
            if isinstance(value[key], dict | list) and value[key]:
                yield from self._leaves(value[key])
            else:
                yield value, key

    def _lists(self, value: Any) -> Iterator[Any]:
        for child in value if isinstance(value, list) else value.values():
            if isinstance(child, dict | list):
                yield child
                yield from self._lists(child)

    def _leaf(self, answers: Any) -> Place | None:
        leaves = list(self._leaves(answers))
        return self._choose.choice(leaves) if leaves else None

    def _in_leaf(self, answers: Any) -> None:
        if place := self._leaf(answers):
            value, key = place
            found = value[key]
            kind = self._choose.random()
            if kind < 0.1:
                value[key] = self._choose.choice((None, {}, [], True, 0, 1.5, "", "=", ["="] * 4))
            else:
                value[key] = self._text(found if isinstance(found, str) else json.dumps(found))

    def _spread_leaf(self, answers: Any) -> None:
        place = self._leaf(answers)
        if place is None:
            return
        value, key = place
        found = value[key]
        parts = [each for each in answers.values() if isinstance(each, dict | list) and each]
        where = self._choose.choice([value, *parts])
        share = self._choose.choice((0.3, 0.7, 1.0))
        distinct = self._choose.random() < 0.7
        for i, (target, at) in enumerate(list(self._leaves(where))):
            if self._choose.random() < share:
                target[at] = f"{found}{i}" if distinct and isinstance(found, str) else found

    def _swapped(self, answers: Any) -> None:
        first, second = self._leaf(answers), self._leaf(answers)
        if first and second:
            (one, i), (two, j) = first, second
            one[i], two[j] = two[j], one[i]

    def _other_length(self, answers: Any) -> None:
        lists = [each for each in self._lists(answers) if isinstance(each, list) and each]
        if not lists:
            return
        chosen = self._choose.choice(lists)
        if self._choose.random() < 0.5:
            chosen.pop(self._choose.randrange(len(chosen)))
        else:
            for _ in range(self._choose.choice((1, 1, 2, 6))):
                chosen.insert(
                    self._choose.randint(0, len(chosen)), copy.deepcopy(self._choose.choice(chosen))
                )

    def _pasted(self, answers: Any) -> None:
        part = self._choose.choice(list(answers))
        answer = answers[part]
        rows = answer.get("rows") if isinstance(answer, dict) else answer
        if not isinstance(rows, list) or not rows:
            return
        rows = [list(row.values()) if isinstance(row, dict) else row for row in rows]
        if all(isinstance(row, list) and row and isinstance(row[0], list) for row in rows):
            rows = [line for matrix in rows for line in matrix]
        if not all(isinstance(row, list) and len(row) == len(rows[0]) and row for row in rows):
            return
        write = self._choose.choice(list(FORMATS.values()))
        answers[part] = write([[str(cell) for cell in row] for row in rows])

    def _numbers_everywhere(self, answers: Any) -> None:
        share = self._choose.choice((0.2, 0.6, 1.0))
        for value, key in list(self._leaves(answers)):
            if self._choose.random() < share:
                value[key] = f"{self._choose.uniform(-4, 4):.3g}"

    def _dropped(self, answers: Any) -> None:
        if len(answers) > 1:
            del answers[self._choose.choice(list(answers))]

    def _borrowed(self, answers: Any, other: dict[str, Any]) -> None:
        part = self._choose.choice(list(other))
        answers[part] = copy.deepcopy(other[part])

    def _text(self, text: str) -> str:
        return self._choose.choice(self._of_text)(text)[:LONGEST]

    def _slice(self, text: str) -> tuple[int, int]:
        start = self._choose.randint(0, len(text))
        return start, min(len(text), start + self._choose.choice((1, 2, 5, 20, 100, 1000)))

    def _repeated(self, text: str) -> str:
        start, end = self._slice(text)
        return text[:end] + text[start:end] * self._choose.choice((1, 2, 5, 20, 100)) + text[end:]

    def _lengthened(self, text: str) -> str:
        text = text or self._choose.choice(PIECES)
        length = self._choose.choice((*LENGTHS, *HUGE))
        if self._choose.random() < 0.3:
            return text + self._choose.choice(PIECES) * (max(0, length - len(text)))
        return (text * (length // len(text) + 1))[:length]

    def _wrapped(self, text: str) -> str:
        found = text
        for _ in range(self._choose.choice((1, 1, 2, 10, 30))):
            if len(found) < 10_000:
                found = self._choose.choice(WRAPS).format(found, found)
        return found

    def _pieced(self, text: str) -> str:
        start, end = self._slice(text)
        piece = self._choose.choice(PIECES) * self._choose.choice((1, 1, 2, 10, 100))
        return text[:start] + piece + text[self._choose.choice((start, end)) :]

    def _cut(self, text: str) -> str:
        start, end = self._slice(text)
        return text[:start] + text[end:]

    def _renumbered(self, text: str) -> str:
        return re.sub(r"\d", lambda _: str(self._choose.randrange(10)), text)

    def _spliced(self, text: str) -> str:
        start, end = self._slice(text)
        return text[:start] + self._choose.choice(self._cells) + text[end:]

    def _replaced(self, _: str) -> str:
        return self._choose.choice(self._cells)

    def _run(self, _: str) -> str:
        return next(runs(self._choose, 1))

    def _run_inside(self, text: str) -> str:
        at = self._choose.randint(0, len(text))
        unit = "".join(self._choose.choices(RUNS, k=self._choose.choice((1, 1, 2, 3))))
        return text[:at] + unit * self._choose.choice((10, 200, 2_000, 12_000)) + text[at:]

    def _nested(self, text: str) -> str:
        opener, closer = self._choose.choice(NESTING)
        depth = self._choose.choice((10, 100, 1_000, 3_900))
        start, end = self._slice(text)
        return text[:start] + opener * depth + text[start:end] + closer * depth + text[end:]
