"""Lay out an answer as JSON, as text to paste, and as LaTeX."""

from collections.abc import Callable, Sequence
from dataclasses import dataclass, replace

from service.catalogue.parts.frames import FRAME_CELLS
from service.expressions.printing.latex import to_latex
from service.expressions.printing.text import to_text
from service.expressions.tree import Node
from service.kinematics.chain import COLUMNS
from service.kinematics.dh import Convention
from service.solutions.model_solution import PrintedAnswer, Shown
from service.translations import Sentence, say

# The column headers. In a modified table, a and α have the index i−1.
_HEADERS = {
    Convention.STANDARD: ("i", r"a_i", r"\alpha_i", r"d_i", r"\theta_i"),
    Convention.MODIFIED: ("i", r"a_{i-1}", r"\alpha_{i-1}", r"d_i", r"\theta_i"),
}


def matrix(nodes: Sequence[Sequence[Node]]) -> PrintedAnswer:
    """Return a matrix as nested lists, in MATLAB's brackets, and as a LaTeX matrix."""
    cells = [[to_text(node) for node in row] for row in nodes]
    widths = [max(map(len, column)) + 2 for column in zip(*cells, strict=True)]
    lines = [
        "".join(f"{cell}, ".ljust(width) for cell, width in zip(row, widths, strict=True))
        for row in cells
    ]
    text = "[" + ";\n ".join(line.rstrip(", ") for line in lines) + "]"
    return PrintedAnswer(text, _latex_matrix(nodes), cells)


def listed(nodes: Sequence[Node]) -> PrintedAnswer:
    """Return a list of values; in LaTeX, the list is a column."""
    cells = list(map(to_text, nodes))
    return PrintedAnswer(f"[{', '.join(cells)}]", _latex_matrix([[node] for node in nodes]), cells)


def table(
    rows: Sequence[Sequence[Node]], labels: Sequence[str], convention: Convention, *, named: bool
) -> PrintedAnswer:
    """Return a DH table as rows with column names, as a Markdown table, and as a LaTeX tabular.

    With ``named``, the JSON value names the convention.
    """
    cells = [[to_text(node) for node in row] for row in rows]
    answer: dict[str, object] = {"rows": [dict(zip(COLUMNS, row, strict=True)) for row in cells]}
    if named:
        answer["convention"] = convention.value
    return PrintedAnswer(_markdown(labels, cells), _tabular(labels, rows, convention), answer)


@dataclass(frozen=True, slots=True)
class PrintedFrame:
    """A placed frame. ``z`` and ``x`` are vectors, or names of base directions such as +y."""

    label: str
    joint: str
    z: str | Sequence[Node]
    origin: Sequence[Node]
    x: str | Sequence[Node]


def frames(placed: Sequence[PrintedFrame]) -> PrintedAnswer:
    """Return placed frames as rows with names, as a Markdown table, and as a LaTeX tabular."""
    answer = [
        {
            "frame": each.label,
            "axis": each.joint,
            "z": _vector(each.z, to_text),
            "origin": list(map(to_text, each.origin)),
            "x": _vector(each.x, to_text),
        }
        for each in placed
    ]
    text = _lines([["frame", *FRAME_CELLS], *(_frame_cells(each, to_text) for each in placed)])
    head = "frame & axis & $z$ & $o_x$ & $o_y$ & $o_z$ & $x$"
    body = [" & ".join(f"${cell}$" for cell in _frame_cells(each, to_latex)) for each in placed]
    lines = "\n".join([rf"{head} \\ \hline", *(rf"{line} \\" for line in body)])
    return PrintedAnswer(text, f"\\begin{{tabular}}{{c|cccccc}}\n{lines}\n\\end{{tabular}}", answer)


def _frame_cells(placed: PrintedFrame, write: Callable[[Node], str]) -> list[str]:
    z, x = (_vector(direction, write) for direction in (placed.z, placed.x))
    return [placed.label, placed.joint, z, *map(write, placed.origin), x]


def _vector(direction: str | Sequence[Node], write: Callable[[Node], str]) -> str:
    return direction if isinstance(direction, str) else f"[{', '.join(map(write, direction))}]"


def row(nodes: Sequence[Node], convention: Convention) -> PrintedAnswer:
    """Return one row of a DH table, laid out as a table."""
    answer = dict(zip(COLUMNS, map(to_text, nodes), strict=True))
    return replace(table([nodes], ["1"], convention, named=False), answer=answer)


def marked(marks: Sequence[str], printed: PrintedAnswer) -> PrintedAnswer:
    """Return an answer that consists of cells to mark and a printed table."""
    line = f"marked: {', '.join(marks)}"
    latex = rf"\text{{{line}}}" + "\n" + printed.latex
    answer = {"marked": list(marks), "table": printed.answer}
    return PrintedAnswer(f"{line}\n{printed.text}", latex, answer)


def no_row() -> PrintedAnswer:
    """Return the answer that a transform has no row."""
    return PrintedAnswer("none", r"\text{none}", {"none": True})


def too_long() -> PrintedAnswer:
    """Return the placeholder for an answer that is too long to be submitted."""
    text = say("longer than an answer may be")
    return PrintedAnswer(text, Sentence(r"\text{{{text}}}", {"text": text}), None)


def product(labels: Sequence[str]) -> Shown:
    """Return a pose as a product of named link transforms."""
    latex = " ".join(f"A_{{{label}}}" for label in labels)
    return Shown(" ".join(f"A{label}" for label in labels), latex)


def _markdown(labels: Sequence[str], cells: Sequence[Sequence[str]]) -> str:
    rows = ([label, *row] for label, row in zip(labels, cells, strict=True))
    return _lines([["i", *COLUMNS], *rows])


def _lines(lines: list[list[str]]) -> str:
    widths = [max(map(len, column)) for column in zip(*lines, strict=True)]
    lines.insert(1, ["-" * width for width in widths])
    return "\n".join(f"| {' | '.join(map(str.ljust, line, widths))} |" for line in lines)


def _tabular(labels: Sequence[str], rows: Sequence[Sequence[Node]], convention: Convention) -> str:
    lines = [_HEADERS[convention]] + [
        (label if label.isdigit() else rf"\mathrm{{{label}}}", *map(to_latex, row))
        for label, row in zip(labels, rows, strict=True)
    ]
    body = [" & ".join(f"${cell}$" for cell in line) + r" \\" for line in lines]
    content = "\n".join([body[0], r"\hline", *body[1:]])
    return f"\\begin{{tabular}}{{c|cccc}}\n{content}\n\\end{{tabular}}"


def _latex_matrix(nodes: Sequence[Sequence[Node]]) -> str:
    lines = " \\\\\n".join(" & ".join(map(to_latex, row)) for row in nodes)
    return f"\\begin{{bmatrix}}\n{lines}\n\\end{{bmatrix}}"
