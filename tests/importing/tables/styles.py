"""Type a table as a person would, in twenty styles."""

from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass, field
from fractions import Fraction

import numpy as np

from tests.importing.tables.drawn import ANGLES, COLUMNS, Cell, Drawn

METRES = {"m": 1000.0, "cm": 10.0, "mm": 1.0}


@dataclass(frozen=True)
class Typed:
    """A table as text, and what the text means: cells in metres and degrees.

    ``answers`` are what its author answers to questions; ``asked`` are the questions that must be
    asked, because the text does not say it.
    """

    text: str
    rows: Sequence[Mapping[str, Cell]]
    answers: Mapping[str, str]
    asked: frozenset[str] = frozenset()


@dataclass(frozen=True)
class Style:
    """A way to type a table. The order and the heads of columns, units, angles and variables."""

    name: str
    order: Sequence[str] = COLUMNS
    heads: Mapping[str, str] | None = field(default_factory=lambda: {c: c for c in COLUMNS})
    between: str = " | "
    unit: str = "m"
    unit_in: str = "no"
    angle: str = "deg"
    variable: str = "q{}"
    slide: str = "q{}"
    label: str = ""
    offset: str = ""
    shuffled: bool = False
    wrapped: str = "{}"


def _heads(a: str, alpha: str, d: str, theta: str) -> Mapping[str, str]:
    return {"a": a, "alpha": alpha, "d": d, "theta": theta}


STYLES = (
    Style("plain, metres not said"),
    Style("labels", label="i", variable="theta{}", slide="d{}"),
    Style("craig", ("alpha", "a", "d", "theta"), label="Link", unit="mm", unit_in="head"),
    Style("toolbox order", ("theta", "d", "a", "alpha"), angle="pi", between=", ", unit="cm",
          unit_in="head"),
    Style("no heads", heads=None, angle="°", between=" "),
    Style("no heads, craig", ("alpha", "a", "d", "theta"), None, ", ", "mm"),
    Style("no heads, with numbers", ("theta", "d", "a", "alpha"), None, "\t", label="i", unit="m"),
    Style("bare degrees", angle="bare", unit="mm"),
    Style("bare degrees, tabs", ("d", "theta", "a", "alpha"), between="\t", angle="bare"),
    Style("degrees in heads", angle="head", unit="cm", unit_in="head", between="; "),
    Style("radians of 4 digits", angle="rad4", unit_in="sentence"),
    Style("radians of 3 digits", angle="rad3", variable="θ_{}", slide="d_{}"),
    Style("radians of 2 digits", angle="rad2", variable="theta_{}", slide="d{}*"),
    Style("radians of 8 digits", angle="rad8", unit="mm", unit_in="sentence"),
    Style("latex", heads=_heads("$a_i$", r"$\alpha_i$", "$d_i$", r"$\theta_i$"), between=" & ",
          angle="latex", variable=r"\theta_{{{}}}", slide="d_{{{}}}^*", label="$i$",
          wrapped="{} \\\\"),
    Style("words", heads=_heads("link length", "link twist", "link offset", "joint angle"),
          angle="°", label="Joint", unit="mm", unit_in="head", shuffled=True),
    Style("new heads", ("a", "alpha", "d", "theta"), _heads("R", "∝", "d_z", "φ_i"), label="L"),
    Style("offset", offset="offset", angle="pi"),
    Style("offset of theta", ("theta", "d", "a", "alpha"), offset="theta_offset", unit="mm",
          unit_in="head"),
    Style("subscripts", heads=_heads("aᵢ", "αᵢ", "dᵢ", "θᵢ"), variable="q_{}", slide="l + q"),
)  # fmt: skip


def typed(drawn: Drawn, style: Style, rng: np.random.Generator) -> Typed:
    """Return the table as typed in a style."""
    meant = [
        {name: _rounded(cell, name, style) for name, cell in row.items()} for row in drawn.rows
    ]
    columns = [*style.order, *([style.offset] if style.offset else [])]
    lines = []
    for i, row in enumerate(meant):
        texts = _row(row, drawn.kinds[i], drawn.joints[i], style, rng)
        cells = [texts[column] for column in columns]
        label = str(i + 1)
        lines.append(
            style.wrapped.format(style.between.join([label, *cells] if style.label else cells))
        )
    if style.shuffled and style.label:
        lines = [lines[i] for i in rng.permutation(len(lines))]
    head = _head(style, columns)
    text = "\n".join([*head, *lines]) + "\n"
    has_numbers = any(row[name].number for row in meant for name in ("a", "d"))
    has_angles = any(row[name].number for row in meant for name in ANGLES)
    asked = {"order"} if style.heads is None else set[str]()
    if has_numbers and style.unit_in == "no":
        asked.add("unit")
    if has_angles and style.angle == "bare":
        asked.add("angles")
    answers = {
        "order": " ".join(style.order),
        "unit": style.unit,
        "angles": "degrees" if style.angle == "bare" else "radians",
        "convention": drawn.convention,
    }
    return Typed(text, [in_metres(row) for row in meant], answers, frozenset(asked))


def in_metres(row: Mapping[str, Cell]) -> Mapping[str, Cell]:
    """Return the row with lengths in metres."""
    return {
        name: cell if name in ANGLES else Cell(cell.number / 1000, cell.letters, cell.motion)
        for name, cell in row.items()
    }


def _rounded(cell: Cell, column: str, style: Style) -> Cell:
    if column in ANGLES and style.angle.startswith("rad"):
        radians = float(f"{np.radians(cell.number):.{style.angle[3:]}f}")
        return Cell(float(np.degrees(radians)), cell.letters, cell.motion)
    return cell


def _head(style: Style, columns: Sequence[str]) -> list[str]:
    head = []
    if style.unit_in == "sentence":
        words = {"m": "metres", "mm": "mm", "cm": "cm"}
        head.append(f"All lengths in {words[style.unit]}.")
    if style.heads is None:
        return head
    names = []
    for column in columns:
        name = style.heads.get(column, column)
        if column in ANGLES and style.angle == "head":
            name += " [deg]"
        if column in ("a", "d") and style.unit_in == "head":
            name += f" ({style.unit})"
        names.append(name)
    names = [style.label, *names] if style.label else names
    return [*head, style.wrapped.format(style.between.join(names))]


def _row(
    row: Mapping[str, Cell], kind: str, joint: int, style: Style, rng: np.random.Generator
) -> Mapping[str, str]:
    texts = {}
    apart = "0"
    for column, cell in row.items():
        variable = style.variable.format(joint) if column == "theta" else style.slide.format(joint)
        if variable == "l + q":
            variable = "q"
        angle = column in ANGLES
        write: Callable[[float], str] = (
            (lambda number: _angle(number, style.angle)) if angle else (lambda n: _length(n, style))
        )
        here = cell
        if cell.motion and style.offset and (angle or style.offset == "offset"):
            apart = _sum("", 0, Cell(cell.number, cell.letters), write, rng)
            here = Cell(motion=cell.motion)
        texts[column] = _sum(variable, here.motion, here, write, rng)
    if style.offset:
        texts[style.offset] = apart
    return texts


def _sum(
    variable: str, motion: int, cell: Cell, write: Callable[[float], str], rng: np.random.Generator
) -> str:
    terms = [(motion, variable)] if motion else []
    for name, factor in cell.letters.items():
        size = abs(factor)
        shown = {1.0: name, 2.0: f"2*{name}", 0.5: f"{name}/2"}[size]
        terms.append((1 if factor > 0 else -1, shown))
    if cell.number:
        terms.append((1 if cell.number > 0 else -1, write(abs(cell.number))))
    if not terms:
        return "0"
    if rng.random() < 0.4:
        terms.reverse()
    (sign, first), *others = terms
    text = first if sign > 0 else f"-{first}"
    return text + "".join(f" {'+' if sign > 0 else '-'} {each}" for sign, each in others)


def _length(millimetres: float, style: Style) -> str:
    return f"{millimetres / METRES[style.unit]:.10g}"


def _angle(degrees: float, style: str) -> str:
    if style.startswith("rad"):
        return f"{np.radians(degrees):.{style[3:]}f}"
    if style in ("bare", "head"):
        return f"{degrees:g}" if float(f"{degrees:g}") == degrees else repr(degrees)
    part = Fraction(degrees) / 180
    if style in ("pi", "latex") and part.denominator <= 12:
        above = "" if part.numerator == 1 else str(part.numerator)
        if style == "latex":
            pi = above + r"\pi"
            return pi if part.denominator == 1 else rf"\frac{{{pi}}}{{{part.denominator}}}"
        pi = f"{above}*pi" if above else "pi"
        return pi if part.denominator == 1 else f"{pi}/{part.denominator}"
    sign = {"latex": r"^\circ", "°": "°"}.get(style, "deg")
    return f"{degrees!r}".removesuffix(".0") + sign
