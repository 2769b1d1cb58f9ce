"""Write tables as programs, pages and typesetters do: a second hand, independent of ``styles``."""

import json
from collections.abc import Callable, Iterator, Mapping

import numpy as np

from tests.importing.tables.drawn import Cell, Drawn
from tests.importing.tables.styles import Typed, in_metres

Row = Mapping[str, Cell]
Write = Callable[[Drawn, np.random.Generator], Typed | None]
_HTML = str.maketrans({"<": "&lt;", ">": "&gt;", "&": "&amp;"})


def _numbers_only(drawn: Drawn) -> bool:
    cells = [cell for row in drawn.rows for cell in row.values()]
    return not any(cell.letters or cell.motion < 0 for cell in cells) and "" not in drawn.kinds


def _typed(drawn: Drawn, text: str, asked: tuple[str, ...] = (), **answers: str) -> Typed:
    answers = {"convention": drawn.convention, "angles": "radians", "unit": "m", **answers}
    has_length = any(row[name].number for row in drawn.rows for name in ("a", "d"))
    has_angle = any(row[name].number for row in drawn.rows for name in ("alpha", "theta"))
    wanted = {"unit": has_length, "angles": has_angle}
    must = frozenset(each for each in asked if wanted.get(each, True))
    return Typed(text, [in_metres(row) for row in drawn.rows], answers, must)


def _terms(cell: Cell, variable: str, number: str, times: str) -> str:
    """Return the cell as a sum in which the constant comes first."""
    parts = [number] if cell.number else []
    for name, factor in cell.letters.items():
        size = "" if abs(factor) == 1 else f"{abs(factor):g}{times}"
        parts.append(f"{'-' if factor < 0 else ''}{size}{name}")
    if cell.motion:
        parts.append(variable if cell.motion > 0 else f"-{variable}")
    return "+".join(parts).replace("+-", "-") or "0"


def _cells(
    drawn: Drawn,
    variable: str,
    unit: float,
    angle: Callable[[float], str],
    times: str = "*",
) -> Iterator[list[str]]:
    """Yield the texts of each row in the order a, α, d, θ; ``unit`` is for lengths, per mm."""

    def length(millimetres: float) -> str:
        return repr(round(millimetres * unit, 9))

    for row, joint in zip(drawn.rows, drawn.joints, strict=True):
        name = variable.replace("#", str(joint))
        writers = {"a": length, "alpha": angle, "d": length, "theta": angle}
        yield [
            _terms(row[column], name, write(row[column].number), times)
            for column, write in writers.items()
        ]


def _pi(degrees: float) -> str:
    return f"{degrees / 180!r}*pi"


def matlab_matrix(drawn: Drawn, _: np.random.Generator) -> Typed:
    """Return a matrix under a comment with the columns."""
    rows = [f"  {c[3]} {c[2]} {c[0]} {c[1]};" for c in _cells(drawn, "q#", 0.001, _pi)]
    text = "\n".join(["% theta d a alpha", "DH = [", *rows, "];"])
    return _typed(drawn, text, ("unit",))


def matlab_matrix_without_names(drawn: Drawn, _: np.random.Generator) -> Typed:
    rows = [f"{c[1]}, {c[0]}, {c[2]}, {c[3]}" for c in _cells(drawn, "q#", 0.001, _pi)]
    return _typed(drawn, f"dh = [{'; '.join(rows)}]", ("order", "unit"), order="alpha a d theta")


def toolbox_script(drawn: Drawn, _: np.random.Generator) -> Typed | None:
    """Return a script for the Robotics Toolbox for Python, with offsets."""
    if not _numbers_only(drawn):
        return None
    kind = "DH" if drawn.convention == "standard" else "MDH"
    calls = []
    for row, joint in zip(drawn.rows, drawn.kinds, strict=True):
        a, alpha = row["a"].number / 1000, float(np.radians(row["alpha"].number))
        d, theta = row["d"].number / 1000, float(np.radians(row["theta"].number))
        if joint == "R":
            calls.append(f"Revolute{kind}(d={d!r}, a={a!r}, alpha={alpha!r}, offset={theta!r})")
        else:
            calls.append(
                f"Prismatic{kind}(theta={theta!r}, a={a!r}, alpha={alpha!r}, offset={d!r})"
            )
    text = "robot = DHRobot([\n" + ",\n".join(f"    {call}" for call in calls) + "\n])"
    return _typed(drawn, text, ("unit",))


def web_page(drawn: Drawn, _: np.random.Generator) -> Typed:
    """Return an HTML table with units in the headers."""
    names = ("Link", "θ<sub>i</sub> [°]", "d<sub>i</sub> [mm]", "a<sub>i</sub> [mm]",
             "α<sub>i</sub> [°]")  # fmt: skip
    head = "<tr>" + "".join(f"<th>{name}</th>" for name in names) + "</tr>"
    lines = []
    for i, c in enumerate(_cells(drawn, "θ#", 1.0, repr), 1):
        cells = [str(i), c[3], c[2], c[0], c[1]]
        lines.append("<tr>" + "".join(f"<td>{x.translate(_HTML)}</td>" for x in cells) + "</tr>")
    return _typed(drawn, f"<table>{head}{''.join(lines)}</table>")


def page_without_units(drawn: Drawn, _: np.random.Generator) -> Typed:
    rows = ["| Joint | a | α | d | θ |", "|---|---|---|---|---|"]
    for i, c in enumerate(_cells(drawn, "q#", 1.0, repr), 1):
        rows.append(f"| {i} | {' | '.join(c)} |")
    return _typed(drawn, "\n".join(rows), ("unit", "angles"), unit="mm", angles="degrees")


def typeset(drawn: Drawn, _: np.random.Generator) -> Typed:
    """Return a tabular in LaTeX."""
    head = r"Link & $d_i$ [cm] & $\theta_i$ & $a_i$ [cm] & $\alpha_i$ \\ \hline"
    lines = [r"\begin{tabular}{c|cccc}", head]
    degrees = lambda x: rf"{x!r}^{{\circ}}"  # noqa: E731
    for i, c in enumerate(_cells(drawn, r"q_{#}", 0.1, degrees, " "), 1):
        lines.append(f"{i} & ${c[2]}$ & ${c[3]}$ & ${c[0]}$ & ${c[1]}$ \\\\")
    return _typed(drawn, "\n".join([*lines, r"\end{tabular}"]))


def units_below(drawn: Drawn, _: np.random.Generator) -> Typed:
    rows = ["i\ta\tα\td\tθ", "\tm\trad\tm\trad"]
    for i, c in enumerate(_cells(drawn, "q#", 0.001, lambda x: repr(float(np.radians(x)))), 1):
        rows.append("\t".join([str(i), *c]))
    return _typed(drawn, "\n".join(rows))


def named_lines(drawn: Drawn, _: np.random.Generator) -> Typed:
    rows = [
        f"a = {c[0]}, alpha = {c[1]}, d = {c[2]}, theta = {c[3]}"
        for c in _cells(drawn, "theta#", 0.001, lambda x: f"{x!r}deg")
    ]
    return _typed(drawn, "\n".join(rows), ("unit",))


def json_rows(drawn: Drawn, _: np.random.Generator) -> Typed:
    cells = _cells(drawn, "q#", 0.001, lambda x: f"{x!r}deg")
    rows = [[c[1], c[0], c[3], c[2]] for c in cells]
    return _typed(drawn, json.dumps(rows), ("order", "unit"), order="alpha a theta d")


def turned(drawn: Drawn, _: np.random.Generator) -> Typed:
    """Return a table with a row for each parameter."""
    columns = list(zip(*_cells(drawn, "q#", 0.1, lambda x: f"{x!r}°"), strict=True))
    heads = ("a [cm]", "alpha", "d [cm]", "theta")
    lines = [", ".join([head, *cells]) for head, cells in zip(heads, columns, strict=True)]
    numbers = ", ".join(["i", *(str(i + 1) for i in range(len(drawn.rows)))])
    return _typed(drawn, "\n".join([numbers, *lines]))


def with_types(drawn: Drawn, _: np.random.Generator) -> Typed:
    words = {"R": "revolute", "P": "prismatic", "": "fixed"}
    lines = ["Joint;type;theta;d [m];a [m];alpha"]
    for i, c in enumerate(_cells(drawn, "q#", 0.001, lambda x: f"{x!r}deg"), 1):
        lines.append(";".join([str(i), words[drawn.kinds[i - 1]], c[3], c[2], c[0], c[1]]))
    return _typed(drawn, "\n".join(lines))


def without_variables(drawn: Drawn, _: np.random.Generator) -> Typed | None:
    """Return a table of a data sheet, whose variables are only named by the type: refused."""
    lines = ["type | a [mm] | alpha [deg] | d [mm] | theta [deg]"]
    for i, row in enumerate(drawn.rows):
        if row["a"].letters or row["d"].letters or drawn.kinds[i] == "":
            return None
        cells = [f"{row[name].number:.10g}" for name in ("a", "alpha", "d", "theta")]
        lines.append(" | ".join([drawn.kinds[i], *cells]))
    return _typed(drawn, "\n".join(lines))


def modified_heads(drawn: Drawn, _: np.random.Generator) -> Typed | None:
    """Return a modified table that is known by its headers."""
    if drawn.convention == "standard":
        return None
    lines = ["i | α_{i-1} | a_{i-1} (in) | d_i (in) | θ_i"]
    for i, c in enumerate(_cells(drawn, "θ_#", 1 / 25.4, lambda x: f"{x!r}deg"), 1):
        lines.append(f"{i} | {c[1]} | {c[0]} | {c[2]} | {c[3]}")

    def typed_inches(name: str, cell: Cell) -> Cell:
        number = round(cell.number / 25.4, 9) * 25.4 if name in ("a", "d") else cell.number
        return Cell(number, cell.letters, cell.motion)

    rows = [{name: typed_inches(name, cell) for name, cell in row.items()} for row in drawn.rows]
    inches = Drawn(drawn.convention, drawn.kinds, rows)
    return _typed(inches, "\n".join(lines))


PROGRAMS: tuple[Write, ...] = (
    matlab_matrix, matlab_matrix_without_names, toolbox_script, web_page, page_without_units,
    typeset, units_below, named_lines, json_rows, turned, with_types, without_variables,
    modified_heads,
)  # fmt: skip
