"""Test how the tree of a formula is built."""

import re
import sys
from collections.abc import Sequence
from contextlib import suppress
from functools import cache
from inspect import currentframe, getsource, isfunction
from math import cos, pi, sin
from random import Random
from typing import Literal
from unittest.mock import Mock

import numpy as np
import pytest
from dh_grader.expressions import LIMITS, ExpressionError, Kind, Vocabulary, parser, read
from dh_grader.expressions.errors import UnreadableError
from dh_grader.expressions.lexer import END, Token
from dh_grader.expressions.parser import Builder
from numpy.typing import NDArray

from tests.together import together

# --- The parser accepts exactly its documented grammar

# A part of a rule: ("", symbol), or a bracket with alternatives, each a sequence of parts.
Part = tuple[str, "str | list[list[Part]]"]
UNITS: tuple[Literal["radians", "degrees"], ...] = ("radians", "degrees")
CLOSING = {"{": "}", "[": "]", "(": ")"}


def grammar() -> dict[str, list[list[Part]]]:
    """Return the grammar rules in the docstring of the parser module."""
    [text] = (each for each in str(parser.__doc__).split("\n\n") if each.startswith("    sum "))
    rules = re.split(r"^ +(\w+) +=", text, flags=re.MULTILINE)[1:]
    return {
        name: alternatives(re.findall(r"\w+|[{}\[\]()|]", body))
        for name, body in zip(rules[::2], rules[1::2], strict=True)
    }


def alternatives(words: list[str], closing: str = "") -> list[list[Part]]:
    found: list[list[Part]] = [[]]
    while words:
        word = words.pop(0)
        if word == closing:
            break
        if word == "|":
            found.append([])
        elif word in CLOSING:
            found[-1].append((word, alternatives(words, CLOSING[word])))
        else:
            found[-1].append(("", word))
    return found


GRAMMAR = grammar()
TERMINALS = sorted(set(re.findall(r"\b[A-Z]+\b", str(GRAMMAR))))


class Recogniser:
    def __init__(self, terminals: Sequence[str]) -> None:
        self.terminals = terminals
        self.rule = cache(self._rule)

    def _rule(self, name: str, start: int) -> frozenset[int]:
        if name.isupper():
            return frozenset({start + 1} if self.terminals[start : start + 1] == [name] else ())
        return self.any_of(GRAMMAR[name], start)

    def any_of(self, choices: list[list[Part]], start: int) -> frozenset[int]:
        return frozenset().union(*(self.sequence(parts, start) for parts in choices))

    def sequence(self, parts: list[Part], start: int) -> frozenset[int]:
        places = frozenset({start})
        for part in parts:
            places = frozenset().union(*(self.part(part, place) for place in places))
        return places

    def part(self, part: Part, start: int) -> frozenset[int]:
        bracket, inside = part
        if isinstance(inside, str):
            return self.rule(inside, start)
        if bracket == "(":
            return self.any_of(inside, start)
        found = frozenset({start})
        longer = self.any_of(inside, start)
        while bracket == "{" and not longer <= found:
            found |= longer
            longer = frozenset().union(*(self.any_of(inside, place) for place in found))
        return found | longer


def is_sentence(terminals: list[str]) -> bool:
    return len(terminals) in Recogniser(terminals).rule("sum", 0)


def sentence(random: Random, name: str = "sum", depth: int = 7) -> list[str]:
    # Return random terminals that the grammar derives from `name`, nested at most `depth`.
    if name.isupper():
        return [name]
    return expansion(random, GRAMMAR[name], depth - 1)


def expansion(random: Random, choices: list[list[Part]], depth: int) -> list[str]:
    found: list[str] = []
    for bracket, inside in random.choice(choices) if depth > 0 else choices[0]:
        if isinstance(inside, str):
            found += sentence(random, inside, depth)
        elif bracket == "(" or (depth > 0 and random.random() < 0.4):
            found += expansion(random, inside, depth)
    return found


# Plain functions replace the mock's methods, which are called thousands of times and would be slow.
BUILDER = Mock(spec=Builder)
for _method in [name for name, member in vars(Builder).items() if isfunction(member)]:
    if not _method.startswith("__"):
        setattr(BUILDER, _method, lambda *_: BUILDER)


def accepts(terminals: list[str]) -> bool:
    tokens: list[Token] = [(each, BUILDER, at, at) for at, each in enumerate((*terminals, END))]
    try:
        parser.parse(tokens, BUILDER)
    except UnreadableError:
        return False
    return True


def test_the_parser_uses_every_method_of_the_builder() -> None:
    methods = re.findall(r"builder\.(\w+)", getsource(parser))
    public = {name for name, member in vars(Builder).items() if isfunction(member)}
    assert set(methods) == {name for name in public if not name.startswith("_")}
    assert len(TERMINALS) == 17


def test_every_sentence_of_the_grammar_is_parsed() -> None:
    random = Random(0)
    for _ in range(750):
        terminals = sentence(random)
        assert accepts(terminals), terminals


@pytest.mark.long
def test_other_terminals_are_refused() -> None:
    random = Random(1)
    refused = 0
    for _ in range(750):
        terminals = sentence(random)[:25]
        at = random.randrange(len(terminals) + 1)
        terminals[at : at + random.randrange(2)] = random.choices(TERMINALS, k=random.randrange(3))
        derived = is_sentence(terminals)
        refused += not derived
        assert accepts(terminals) == derived, terminals
    assert 100 < refused < 700


CHAINS = [
    "-", "+", "-+", "√", "tg ", "sin ", "2^-", "k^-+", "tg k^", "tg 2k^", "tg ½k^-", "√√-", "√(",
    "tg √", "(", "|", "cos(", "-(", "½", "k deg", "2^(", "sin^2 ", "k*-", "k/-", r"\frac{1}{", "k ",
    "atan2(k,", "[{(", "deg(",
]  # fmt: skip


@pytest.mark.sampled(4)
@pytest.mark.parametrize("chain", CHAINS)
def test_no_chain_nears_the_recursion_limit(chain: str, arm: Vocabulary) -> None:
    depth, frame = 0, currentframe()
    while frame is not None:
        depth, frame = depth + 1, frame.f_back
    times = LIMITS.characters // len(chain) - 1
    limit = sys.getrecursionlimit()
    sys.setrecursionlimit(depth + 400)
    try:
        for text in (chain * times, chain * times + "k", chain * 39 + "k" + ")" * 39):
            for unit in UNITS:
                with suppress(ExpressionError):
                    read(text, arm, angle_unit=unit)
    finally:
        sys.setrecursionlimit(limit)


@pytest.mark.parametrize("chain", ["-", "√", "tg ", "tg k^", "tg 2k^"])
def test_a_long_chain_exceeds_a_limit(chain: str, arm: Vocabulary) -> None:
    text = chain * (LIMITS.characters // len(chain) - 1) + "k"
    with pytest.raises(ExpressionError, match=r"inside each other|operations and values|too long"):
        read(text, arm)


# --- Numbers without a unit are degrees if the student works in degrees

Values = dict[str, NDArray[np.float64]]

Q1, L1, K, BETA = 0.3, 1.1, 2.0, 0.25

ANGLES = [
    ("0", 0.0),
    ("90", pi / 2),
    ("-90", -pi / 2),
    ("180/2", pi / 2),
    ("90*1", pi / 2),
    ("q1 + 90", Q1 + pi / 2),
    ("q1* - 90", Q1 - pi / 2),
    ("90 - q1", pi / 2 - Q1),
    ("2*(q1+45)", 2 * (Q1 + pi / 4)),
    ("(q1 + 90)/2", (Q1 + pi / 2) / 2),
    ("-(q1 - 90)", pi / 2 - Q1),
    ("abs(q1 - 90)", pi / 2 - Q1),
    ("β + 45", BETA + pi / 4),
    ("k*90", K * pi / 2),
    ("90k", K * pi / 2),
    ("90/k", pi / 4),
    ("2q1", 2 * Q1),
    ("90deg", pi / 2),
    ("1.5rad", 1.5),
    ("pi/2", pi / 2),
    ("q1 + pi/2", Q1 + pi / 2),
    ("atan2(1,1)", pi / 4),
    ("2*atan(1)", pi / 2),
    ("asin(0.5) + 60", pi / 2),
    ("atan2(sin(30), cos(30))", pi / 6),
    ("sqrt(8100)", pi / 2),
]

NUMBERS = [
    ("90", 90.0),
    ("cos(60)", 0.5),
    ("sin 30", 0.5),
    ("sin90", 1.0),
    ("cos(q1+90)", -sin(Q1)),
    ("l1*cos(60) + 30", L1 * 0.5 + 30),
    ("sin(pi/6)", 0.5),
    ("sin(2*15)", 0.5),
    ("c1 + cos(0)", cos(Q1) + 1),
    ("sin(asin(0.5))", 0.5),
    ("exp(sin(90))", np.e),
    ("-sqrt(sin(90))", -1.0),
    ("(sin(90))deg", pi / 180),
]


@together(
    ("text", "quantity", "expected"),
    [
        *((text, "angle", value) for text, value in ANGLES),
        *((text, "number", value) for text, value in NUMBERS),
    ],
)
def test_bare_angles_are_degrees(
    text: str, quantity: Kind, expected: float, arm: Vocabulary, values: Values
) -> None:
    expression = read(text, arm, quantity=quantity, angle_unit="degrees")
    assert np.ravel(expression.evaluate(values)) == pytest.approx([expected], rel=1e-12)


@pytest.mark.parametrize(
    ("text", "span"), [("pi/2", (0, 4)), ("q1 + π/2", (5, 8)), ("l1 cos(q1 - pi)", (12, 14))]
)
def test_a_constant_with_pi_is_radians(text: str, span: tuple[int, int], arm: Vocabulary) -> None:
    expression = read(text, arm, quantity="angle", angle_unit="degrees")
    assert [(note.code, note.span) for note in expression.notes] == [("radians_in_degrees", span)]


def test_in_radians_a_number_keeps_its_value(arm: Vocabulary) -> None:
    assert read("90", arm, quantity="angle").evaluate({}) == 90.0


def test_in_degrees_a_length_keeps_its_value(arm: Vocabulary) -> None:
    assert read("90", arm, quantity="length", angle_unit="degrees").evaluate({}) == 90.0


@together("text", [text for text, _ in ANGLES])
def test_printed_text_reads_back_in_degrees(text: str, arm: Vocabulary) -> None:
    tree = read(text, arm, quantity="angle", angle_unit="degrees")
    again = read(tree.text(), arm, quantity="angle", angle_unit="degrees")
    assert again.tree == tree.tree
