"""Generate random texts, and check how the program reads them."""

import time
import xml.etree.ElementTree as ET
from collections.abc import Iterator
from random import Random
from typing import Final, NamedTuple

import numpy as np
from dh_grader.expressions import Expression, ExpressionError, read, reader, words

from tests.expressions.corpus_files import FOLDER, ROBOT, cases, names, python_text

Fingerprint = tuple[object, ...]

VALUES: Final = {symbol.name: np.linspace(-2, 2, 16) for symbol in ROBOT.symbols}
PIECES: Final = (
    *(
        "q1",
        "theta1",
        "θ₁",
        r"\theta_1",
        r"\theta_{12}",
        "l1",
        "a2",
        "k",
        "β",
        "d3",
        "q[0]",
        "q(2)",
    ),
    *(
        "c1",
        "s12",
        "c_{12}",
        "cθ1",
        "C1",
        "sα1",
        "1",
        "2.5",
        ".5",
        "1e-3",
        "90",
        "½",
        "π",
        "pi",
        "np.",
    ),
    *("sin", "cos", "tan", "atan2", "sqrt", "√", r"\sin", r"\cos", "sin^2", "cosd", "acosd", "abs"),
    *(
        "+",
        "-",
        "*",
        "/",
        "^",
        "**",
        ".*",
        "./",
        "·",
        "×",
        "−",
        "²",
        "⁻¹",
        "°",
        "deg",
        "rad",
        r"\cdot",
    ),
    *(
        "(",
        ")",
        "[",
        "]",
        "{",
        "}",
        "|",
        r"\left(",
        r"\right)",
        r"\frac{",
        "}{",
        r"\frac12",
        r"\sqrt{",
    ),
    *(
        " ",
        "  ",
        "\t",
        "\n",
        r"\,",
        "~",
        "$",
        ",",
        ";",
        "=",
        "*",
        "^*",
        "_",
        "'",
        "%",
        "#",
        "//",
        "e",
    ),
    *(
        "x",
        "t",
        "m",
        "а",
        "\u200b",
        "\u202e",
        "\ud800",
        "\ue000",
        "\ue001",
        "\ue002",
        "±",
        "!",
        "?",
        "\\",
    ),
)


def seeds() -> list[str]:
    """Return the texts of all test cases in corpus/, except the hostile ones."""
    return [case.text for name in (*names(), "errors") for case in cases(name)]


def hostile() -> list[str]:
    """Return the texts of corpus/hostile.txt."""
    lines = (FOLDER / "hostile.txt").read_text("utf-8").split("\n")
    return [str(python_text(line)) for line in lines if line and not line.startswith("#")]


def texts(count: int, seed: int) -> Iterator[str]:
    """Yield random texts and changed test cases."""
    random = Random(seed)
    written = [*seeds(), *hostile()]
    for _ in range(count):
        kind = random.random()
        if kind < 0.35:
            yield _formula(random, random.randint(0, 5))
        elif kind < 0.55:
            yield "".join(random.choices(PIECES, k=random.randint(1, 25)))
        else:
            yield mutated(random.choice(written), random, written)


def _formula(random: Random, depth: int) -> str:
    if not depth or random.random() < 0.15:
        return random.choice(PIECES[: PIECES.index("np.")])
    inner = _formula(random, depth - 1)
    match random.randrange(7):
        case 0:
            return f"({inner})"
        case 1:
            return random.choice(["sin({})", r"\cos\left({}\right)", "tan[{}]", "√({})"]).format(
                inner
            )
        case 2:
            return random.choice(["-{}", "sin {}", "{}^2", "{}²", "2{}", "|{}|"]).format(inner)
        case 3:
            return rf"\frac{{{inner}}}{{{_formula(random, depth - 1)}}}"
        case _:
            sign = random.choice([" + ", " - ", "*", "·", "/", " ", r" \cdot ", ".*"])
            return f"{inner}{sign}{_formula(random, depth - 1)}"


def mutated(text: str, random: Random, written: list[str]) -> str:
    data = bytearray(text.encode("utf-8", "surrogatepass"))
    for _ in range(random.randint(1, 4)):
        at = random.randint(0, len(data))
        kind = random.randrange(6)
        if kind == 0:
            data[at : at + random.randint(1, 4)] = b""
        elif kind == 1:
            data[at:at] = bytes([random.randrange(256)])
        elif kind == 2:
            data[at:at] = random.choice(PIECES).encode("utf-8", "surrogatepass")
        elif kind == 3:
            other = random.choice(written).encode("utf-8", "surrogatepass")
            data[at:at] = other[: random.randint(0, 60)]
        elif kind == 4 and data:
            data[at % len(data)] ^= 1 << random.randrange(8)
        else:
            data[at:at] = data[at : at + 20] * random.randint(1, 8)
    return data.decode("utf-8", "replace")


class Outcome(NamedTuple):
    """The result of reading a text, and the processor time it took in seconds."""

    fingerprint: Fingerprint
    seconds: float


def outcome(text: str, *, degrees: bool = False) -> Outcome:
    for memoized in reader._reader_memoized:
        memoized.cache_clear()
    reader._parsed.cache_clear()
    words.split.cache_clear()
    return next_outcome(text, degrees=degrees)


def next_outcome(text: str, *, degrees: bool = False) -> Outcome:
    start = time.process_time()
    try:
        expression = _read(text, degrees)
    except ExpressionError as error:
        seconds = time.process_time() - start
        _check_error(error, text, degrees)
        return Outcome((error.code, error.message, error.span, error.suggestion), seconds)
    value = expression.evaluate(VALUES)
    printed = expression.text(), expression.latex(), expression.mathml()
    seconds = time.process_time() - start
    assert np.shape(value) in {(), (16,)}
    for note in expression.notes:
        assert 0 <= note.span[0] < note.span[1] <= len(text), note
    ET.fromstring(printed[2])
    return Outcome((*printed, expression.notes, np.asarray(value).tobytes()), seconds)


def _read(text: str, degrees: bool) -> Expression:
    if degrees:
        return read(text, ROBOT, quantity="angle", angle_unit="degrees")
    return read(text, ROBOT)


def _check_error(error: ExpressionError, text: str, degrees: bool) -> None:
    assert 0 <= error.span[0] <= error.span[1] <= len(text), error.span
    assert error.message.isprintable(), error.message
    if error.suggestion is not None:
        _read(error.suggestion, degrees)
