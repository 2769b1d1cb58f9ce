"""Write a table in each format, as people and programs do."""

import csv
import html
import io
import json
from collections.abc import Callable, Mapping, Sequence

# `test_registry` reads each format back; `test_hostile` mutates the texts.

Rows = Sequence[Sequence[str]]

POSE = [
    ["c12", "-s12", "0", "a1*c1+a2*c12"],
    ["s12", "c12", "0", "a1*s1+a2*s12"],
    ["0", "0", "1", "-d3"],
    ["0", "0", "0", "1"],
]


def delimited(separator: str) -> Callable[[Rows], str]:
    def write(rows: Rows) -> str:
        text = io.StringIO()
        csv.writer(text, delimiter=separator).writerows(rows)
        return text.getvalue()

    return write


def markdown(rows: Rows) -> str:
    head, *body = (f"| {' | '.join(row)} |" for row in rows)
    rule = "|" + "|".join([":---:"] * len(rows[0])) + "|"
    return "\n".join([head, rule, *body]) + "\n"


def bare_markdown(rows: Rows) -> str:
    head, *body = (" | ".join(row) for row in rows)
    return "\n".join([head, "|".join(["---"] * len(rows[0])), *body])


def drawn(rows: Rows) -> str:
    lines = ["│" + "│".join(f" {cell} " for cell in row) + "│" for row in rows]
    rule = "├" + "┼".join(["────"] * len(rows[0])) + "┤"
    return "\n".join(["┌────┐", lines[0], rule, *lines[1:], "└────┘"])


def latex_rows(rows: Rows) -> str:
    return " \\\\\n".join(" & ".join(row) for row in rows)


def tabular(rows: Rows) -> str:
    spec = "|".join("c" * len(rows[0]))
    head, *body = rows
    return (
        "\\begin{table}[h]\n\\centering\n\\caption{DH table}\n"
        f"\\begin{{tabular}}{{|{spec}|}}\n\\hline\n{latex_rows([head])} \\\\ \\hline \\hline\n"
        f"{latex_rows(body)} \\\\[2pt]\n\\hline % the end & so on\n\\end{{tabular}}\n\\end{{table}}"
    )


def booktabs(rows: Rows) -> str:
    head, *body = rows
    return (
        f"\\begin{{tabular}}{{{'l' * len(head)}}}\n\\toprule\n{latex_rows([head])} \\\\\n"
        f"\\cmidrule(lr){{1-2}}\n{latex_rows(body)} \\\\\n\\bottomrule\n\\end{{tabular}}"
    )


def environment(name: str, spec: str = "") -> Callable[[Rows], str]:
    def write(rows: Rows) -> str:
        return f"T = \\begin{{{name}}}{spec} {latex_rows(rows)} \\end{{{name}}}"

    return write


def array(rows: Rows) -> str:
    spec = "c" * len(rows[0])
    return (
        f"$$T_0^4 = \\left[\\begin{{array}}{{{spec}}} {latex_rows(rows)} \\end{{array}}\\right]$$"
    )


def matlab(rows: Rows) -> str:
    return "A = [" + ";\n     ".join(", ".join(row) for row in rows) + "];"


def matlab_blanks(rows: Rows) -> str:
    return "% my matrix\nA = [" + "; ".join(" ".join(row) for row in rows) + "]"


def matlab_lines(rows: Rows) -> str:
    lines = [" ".join(row[:2]) + " ... goes on\n  " + " ".join(row[2:]) for row in rows]
    return "[\n" + "\n".join(lines) + "\n]"


def matlab_without_brackets(rows: Rows) -> str:
    return ";\n".join(", ".join(row) for row in rows)


def matlab_print(rows: Rows) -> str:
    return "T =\n \n" + "\n".join(f"[{', '.join(row)}]" for row in rows) + "\n"


def nested(rows: Rows) -> str:
    return "[" + ", ".join(f"[{', '.join(row)}]" for row in rows) + "]"


def tuples(rows: Rows) -> str:
    return "(" + ",\n ".join(f"({', '.join(row)})" for row in rows) + ")"


def numpy_call(rows: Rows) -> str:
    return f"import numpy as np\nT = np.array({nested(rows)})  # the pose"


def numpy_repr(rows: Rows) -> str:
    lines = ",\n       ".join(f"[{', '.join(row)}]" for row in rows)
    return f"array([{lines}], dtype=object)"


def numpy_print(rows: Rows) -> str:
    return "[" + "\n ".join(f"[{' '.join(row)}]" for row in rows) + "]"


def strings(rows: Rows) -> str:
    return repr([list(row) for row in rows])


def json_text(rows: Rows) -> str:
    return json.dumps([list(row) for row in rows], indent=2)


def sympy_call(rows: Rows) -> str:
    return f"sympy.Matrix({nested(rows)})"


def sympy_shape(rows: Rows) -> str:
    flat = ", ".join(cell for row in rows for cell in row)
    return f"Matrix({len(rows)}, {len(rows[0])}, [{flat}])"


def web_page(rows: Rows) -> str:
    def line(tag: str, row: Sequence[str]) -> str:
        cells = "".join(f"<{tag} class='x>y'>{html.escape(cell)}</{tag}>\n" for cell in row)
        return f"<tr>{cells}</tr>\n"

    head, *body = rows
    return (
        "<!-- <td> --><p>See</p><table><caption>DH</caption><thead>"
        + line("th", head)
        + "</thead><tbody>"
        + "".join(line("td", row) for row in body)
        + "</tbody></table>"
    )


def loose_web_page(rows: Rows) -> str:
    return "<TABLE>" + "".join("<TR>" + "".join(f"<TD>{c}" for c in row) for row in rows)


def columns(rows: Rows) -> str:
    widths = [max(map(len, column)) for column in zip(*rows, strict=True)]
    return "\n".join(
        "  ".join(cell.ljust(width) for cell, width in zip(row, widths, strict=True)).rstrip()
        for row in rows
    )


def one_blank(rows: Rows) -> str:
    return "\n".join(" ".join(row) for row in rows)


# TABLES are formats for tables with headers. Matrices are written in TABLES and MATRICES.
TABLES: Mapping[str, Callable[[Rows], str]] = {
    "CSV": delimited(","),
    "TSV": delimited("\t"),
    "CSV with semicolons": delimited(";"),
    "Markdown": markdown,
    "Markdown without outer bars": bare_markdown,
    "drawn": drawn,
    "LaTeX tabular": tabular,
    "LaTeX booktabs": booktabs,
    "HTML": web_page,
    "old HTML": loose_web_page,
    "columns": columns,
    "one blank": one_blank,
}
MATRICES: Mapping[str, Callable[[Rows], str]] = {
    "bmatrix": environment("bmatrix"),
    "pmatrix": environment("pmatrix"),
    "matrix": environment("matrix"),
    "smallmatrix": environment("smallmatrix"),
    "bmatrix*": environment("bmatrix*", "[r]"),
    "array": array,
    "LaTeX rows": latex_rows,
    "MATLAB": matlab,
    "MATLAB with blanks": matlab_blanks,
    "MATLAB with lines": matlab_lines,
    "MATLAB without brackets": matlab_without_brackets,
    "MATLAB print": matlab_print,
    "nested list": nested,
    "tuples": tuples,
    "np.array": numpy_call,
    "array repr": numpy_repr,
    "array print": numpy_print,
    "strings": strings,
    "JSON": json_text,
    "SymPy": sympy_call,
    "SymPy shape": sympy_shape,
}
FORMATS: Mapping[str, Callable[[Rows], str]] = {**TABLES, **MATRICES}
