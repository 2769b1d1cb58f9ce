"""Submit model solutions in the notation of programs such as MATLAB.

``python -m tests.solutions.prints`` submits all of them.
"""

# Printers that SymPy lacks are written here; they imitate the programs. `test_printers` submits a
# sample.

import argparse
import re
import sys
from collections.abc import Callable, Iterator, Mapping, Sequence
from functools import partial
from typing import NamedTuple

import numpy as np
import sympy as sp
from dh_grader.catalogue import Exercise
from dh_grader.catalogue.kinds import LinkTransformsSpec
from dh_grader.expressions import read
from dh_grader.solutions.algebra import Algebra
from sympy.printing.numpy import NumPyPrinter

from tests.grading.support.submitting import full_marks, handed_in, part
from tests.shipped import shipped_exercises
from tests.solutions.solved import solved

GREEK = frozenset({"theta", "alpha", "phi", "psi", "beta", "gamma"})
Printer = Callable[[sp.Matrix], str]
# The labels of matrices and their texts -> one text.
Join = Callable[[Sequence[tuple[str, str]]], str]


def rows(matrix: sp.Matrix, entry: Callable[[sp.Expr], str]) -> list[list[str]]:
    return [[entry(matrix[i, j]) for j in range(matrix.cols)] for i in range(matrix.rows)]


# --- entries as other programs print them, made from SymPy's print


def of_maxima(entry: sp.Expr) -> str:
    return re.sub(r"\bpi\b", "%pi", str(entry).replace("**", "^")).replace(" ", "")


def of_maxima_tex(entry: sp.Expr) -> str:
    text = re.sub(r"\\(cos|sin)\{\\left\((\S+) \\right\)\}", r"\\\1 \2", sp.latex(entry))
    return text.replace(r"\left(", r"\left(").replace(r"\right)", r"\right)")


def of_matlab_latex(entry: sp.Expr) -> str:
    r"""Print like MATLAB's ``latex``: ``a_{1}\,\cos\left(\theta _{1}\right)``."""
    text = sp.latex(entry, mul_symbol=r"\,")
    text = re.sub(r"\\(theta|alpha|phi)_", r"\\\1 _", text)
    text = re.sub(r"\\(cos|sin)\{\\left\(", r"\\\1\\left(", text)
    return text.replace(r" \right)}", r"\right)").replace(r" \right)", r"\right)")


def of_texform(entry: sp.Expr, *, greek: bool) -> str:
    r"""Print like Mathematica's ``TeXForm``: ``\text{a1} \cos \left(\theta _1\right)``."""

    def named(symbol: sp.Symbol) -> str:
        stem, index = re.fullmatch(r"([A-Za-z]+?)_?(\d*)", symbol.name).groups()  # type: ignore[union-attr]
        letter = rf"\{stem}" if stem in GREEK else stem
        if not index:
            return letter
        return rf"{letter} _{index}" if greek else rf"\text{{{symbol.name}}}"

    names = {symbol: named(symbol) for symbol in entry.free_symbols}
    text = sp.latex(entry, symbol_names=names)
    text = re.sub(r"\\(cos|sin)(\^\{\d\})?\{\\left\(", r"\\\1\2 \\left(", text)
    return text.replace(r" \right)}", r"\right)").replace(r" \right)", r"\right)")


def of_numpy(entry: sp.Expr) -> str:
    return str(NumPyPrinter().doprint(entry))


# --- one matrix


def latex_environment(name: str, entry: Callable[[sp.Expr], str], between: str = "\n") -> Printer:
    def write(matrix: sp.Matrix) -> str:
        lines = rf" \\ {between}".join(" & ".join(row) for row in rows(matrix, entry))
        spec = f"{{{'c' * matrix.cols}}}" if name == "array" else ""
        return rf"\left(\begin{{{name}}}{spec} {lines} \end{{{name}}}\right)"

    return write


def maxima(matrix: sp.Matrix) -> str:
    lines = [f"[{','.join(row)}]" for row in rows(matrix, of_maxima)]
    return f"matrix({','.join(lines)})"


def maxima_tex(matrix: sp.Matrix) -> str:
    lines = "".join("&".join(row) + r"\cr " for row in rows(matrix, of_maxima_tex))
    return rf"$$\pmatrix{{{lines}}}$$"


def maxima_display(matrix: sp.Matrix) -> str:
    cells = rows(matrix, lambda e: str(e).replace("**", "^").replace("*", " "))
    cells = [[re.sub(r"^-(?=\w)", "- ", cell) for cell in row] for row in cells]
    widths = [max(map(len, column)) for column in zip(*cells, strict=True)]
    lines = ["[ " + "  ".join(map(str.center, row, widths)) + " ]" for row in cells]
    return f"\n[{' ' * (len(lines[0]) - 2)}]\n".join(lines)


def matlab_display(matrix: sp.Matrix) -> str:
    cells = rows(matrix, sp.octave_code)
    widths = [max(map(len, column)) for column in zip(*cells, strict=True)]
    return "\n".join(f"[{', '.join(map(str.rjust, row, widths))}]" for row in cells)


def matlab_pretty(matrix: sp.Matrix) -> str:
    cells = rows(matrix, lambda e: str(e).replace("*", " "))
    widths = [max(map(len, column)) for column in zip(*cells, strict=True)]
    lines = [", ".join(map(str.center, row, widths)) for row in cells]
    spaced = f"\n| {' ' * len(lines[0])} |\n".join(f"| {line} |" for line in lines).split("\n")
    first, *middle, last = spaced
    return "\n".join([f"/{first[1:-1]}\\", *middle, f"\\{last[1:-1]}/"])


def matlab_input(matrix: sp.Matrix) -> str:
    return f"[{'; '.join(' '.join(row) for row in rows(matrix, sp.octave_code))}]"


def mathematica_form(matrix: sp.Matrix) -> str:
    cells = rows(matrix, lambda e: sp.mathematica_code(e).replace("*", " "))
    widths = [max(map(len, column)) for column in zip(*cells, strict=True)]
    return "\n\n".join("   ".join(map(str.ljust, row, widths)).rstrip() for row in cells)


def c_entries(printer: Callable[[sp.Expr], str]) -> Printer:
    def write(matrix: sp.Matrix) -> str:
        return "{" + ", ".join("{" + ", ".join(row) + "}" for row in rows(matrix, printer)) + "}"

    return write


def object_array(matrix: sp.Matrix) -> np.ndarray[tuple[int, ...], np.dtype[np.object_]]:
    return np.array(matrix.tolist(), dtype=object)


SYMPY: Mapping[str, Printer] = {
    "str": str,
    "immutable repr": lambda m: repr(sp.ImmutableMatrix(m)),
    "repr of lists": lambda m: repr(m.tolist()),
    "pretty": partial(sp.pretty, use_unicode=True, wrap_line=False),
    "pretty, ASCII": partial(sp.pretty, use_unicode=False, wrap_line=False),
    "octave_code": sp.octave_code,
    "mathematica_code": sp.mathematica_code,
    "maple_code": sp.maple_code,
    "julia_code": sp.julia_code,
    "pycode": sp.pycode,
    "NumPyPrinter": of_numpy,
    "ccode of the entries": c_entries(sp.ccode),
    "jscode of the entries": c_entries(sp.jscode),
    "cxxcode of the entries": c_entries(sp.cxxcode),
    "rcode of the entries": c_entries(sp.rcode),
}
LATEX_OPTIONS: Mapping[str, Mapping[str, object]] = {
    "plain": {},
    "pmatrix": {"mat_str": "pmatrix"},
    "bmatrix": {"mat_str": "bmatrix"},
    "smallmatrix": {"mat_str": "smallmatrix"},
    "array in [": {"mat_str": "array", "mat_delim": "["},
    "array in (": {"mat_str": "array", "mat_delim": "("},
    "bmatrix alone": {"mat_str": "bmatrix", "mat_delim": ""},
    "mul_symbol=ldot": {"mul_symbol": "ldot"},
    "mul_symbol=dot": {"mul_symbol": "dot"},
    "mul_symbol=times": {"mul_symbol": "times"},
    "fold_short_frac": {"fold_short_frac": True},
    "fold_func_brackets": {"fold_func_brackets": True},
    "inv_trig_style=full": {"inv_trig_style": "full"},
    "inv_trig_style=power": {"inv_trig_style": "power"},
    "root_notation=False": {"root_notation": False},
    "long_frac_ratio": {"long_frac_ratio": 2},
    "inline": {"mode": "inline"},
    "equation": {"mode": "equation"},
    "equation*, itex": {"mode": "equation*", "itex": True},
    "parenthesize_super=False": {"parenthesize_super": False},
    "gothic_re_im, ln_notation": {"gothic_re_im": True, "ln_notation": True},
}
LATEX: Mapping[str, Printer] = {
    f"latex, {name}": partial(sp.latex, **options) for name, options in LATEX_OPTIONS.items()
}
NUMPY: Mapping[str, Printer] = {
    "NumPy str": lambda m: str(object_array(m)),
    "NumPy repr": lambda m: repr(object_array(m)),
}
OTHERS: Mapping[str, Printer] = {
    "MATLAB display": matlab_display,
    "MATLAB input": matlab_input,
    "MATLAB pretty": matlab_pretty,
    "MATLAB latex": latex_environment("array", of_matlab_latex, ""),
    "Mathematica TeXForm": latex_environment("array", partial(of_texform, greek=False)),
    "Mathematica TeXForm, subscripts": latex_environment("array", partial(of_texform, greek=True)),
    "Mathematica MatrixForm": mathematica_form,
    "Maxima": maxima,
    "Maxima tex": maxima_tex,
    "Maxima display": maxima_display,
}
PRINTERS: Mapping[str, Printer] = {**SYMPY, **LATEX, **NUMPY, **OTHERS}


DRAWN = ("pretty", "pretty, ASCII", "MATLAB pretty", "Mathematica MatrixForm", "Maxima display")


# --- the text before and after a matrix

AROUND: Mapping[str, Callable[[str], str]] = {
    "alone": lambda text: text,
    "named": lambda text: f"T = {text}",
    "MATLAB": lambda text: f"T =\n \n{text}\n \n",
    "MATLAB prompt": lambda text: f">> simplify(T)\n \nans =\n \n{text}\n \n>> ",
    "product": lambda text: f"T = A1*A2 = {text};",
    "Jupyter": lambda text: f"Out[3]:\n{text}\n",
    "Mathematica": lambda text: f"In[3]:= T\n\nOut[3]= {text}\n",
    "Maxima": lambda text: f"(%i3) T;\n(%o3) {text}\n",
}


# --- all link transforms


def named(form: str, between: str = "\n") -> Join:
    def write(matrices: Sequence[tuple[str, str]]) -> str:
        return between.join(form.format(label=label, text=text) for label, text in matrices)

    return write


def backwards(matrices: Sequence[tuple[str, str]]) -> str:
    return named("A{label} = {text}", "\n\n")(matrices[::-1])


LISTS: Mapping[str, Join] = {
    "named": named("A{label} = {text}"),
    "named, ;": named("A_{label} = {text};", "\n\n"),
    "MATLAB": named("A{label} =\n \n{text}\n \n"),
    "prompts": named(">> A{label}\n \nA{label} =\n \n{text}\n \n"),
    "headings": named("A{label}:\n{text}\n", "\n"),
    "backwards": backwards,
    "in order": named("{text}", "\n\n"),
}
OF_LATEX: Mapping[str, Join] = {
    "commas": named("A_{label} = {text}", ", \\quad "),
    "display": named("\\[ {{}}^{{}}A_{{{label}}}(q) = {text} \\]"),
    "bold": named("$$\\mathbf{{A}}_{label} = {text}$$"),
}
IN_BRACKETS: Mapping[str, Join] = {
    "list": lambda matrices: f"[{', '.join(text for _, text in matrices)}]",
}


class Print(NamedTuple):
    """A model answer as a program such as MATLAB prints it."""

    exercise: str
    part: str
    name: str
    write: Callable[[], str]

    @property
    def text(self) -> str:
        return self.write()


def matrix_of(exercise: Exercise, algebra: Algebra, entries: Sequence[Sequence[str]]) -> sp.Matrix:
    return sp.Matrix(
        [[algebra.of(read(entry, exercise.vocabulary)) for entry in row] for row in entries]
    )


def matrices(exercise: Exercise) -> Iterator[tuple[str, list[sp.Matrix]]]:
    algebra = Algebra(exercise)
    for solution in solved(exercise).parts:
        answer = solution.answer
        if not isinstance(answer, list) or not answer or not isinstance(answer[0], list):
            continue
        listed = answer if isinstance(answer[0][0], list) else [answer]
        if len(listed[0]) > 2:
            yield solution.part, [matrix_of(exercise, algebra, each) for each in listed]


def ways_around(name: str) -> Mapping[str, Callable[[str], str]]:
    # Return functions that put text around a matrix, such as a name or a product in front of it.
    #
    # A matrix that is drawn over several lines must begin on a new line; it gets fewer functions.
    left_out = {"named", "product"} if name in DRAWN else set()
    return {way: AROUND[way] for way in AROUND if way not in left_out}


def ways_together(name: str) -> Mapping[str, Join]:
    if name in DRAWN:
        more = ["in order"] if name.startswith("pretty") else []
        return {way: LISTS[way] for way in ("MATLAB", "prompts", "headings", *more)}
    is_latex = "latex" in name or "TeX" in name or "tex" in name
    # A display encloses each row in brackets, so a list of displays would be one matrix.
    listed: Mapping[str, Join] = {} if name == "MATLAB display" else IN_BRACKETS
    return {**LISTS, **(OF_LATEX if is_latex else listed)}


def prints(exercise: Exercise) -> Iterator[Print]:
    for part_id, found in matrices(exercise):
        spec = exercise.part(part_id)
        for name, printer in PRINTERS.items():
            if isinstance(spec, LinkTransformsSpec):
                labels = exercise.robot.tables[spec.convention].labels
                for way, join in ways_together(name).items():
                    write = partial(_joined, join, labels, found, printer)
                    yield Print(exercise.id, part_id, f"{name}, {way}", write)
            else:
                for way, wrap in ways_around(name).items():
                    write = partial(_wrapped, wrap, found[0], printer)
                    yield Print(exercise.id, part_id, f"{name}, {way}", write)


def _joined(join: Join, labels: Sequence[str], found: Sequence[sp.Matrix], printer: Printer) -> str:
    return join([(label, printer(each)) for label, each in zip(labels, found, strict=True)])


def _wrapped(wrap: Callable[[str], str], matrix: sp.Matrix, printer: Printer) -> str:
    return wrap(printer(matrix))


# Refusals that are right: drawings with powers and roots or too wide; Julia's 1 // 2 (0 in Python).
_RIGHTLY_REFUSED = {
    "pretty": frozenset({"drawn_matrix", "too_long"}),
    "julia_code": frozenset({"comment"}),
}


def refused(each: Print, exercise: Exercise) -> str:
    text = each.text
    report = part(handed_in(exercise, {each.part: text}), each.part)
    codes = {message.code for message in report.feedback}
    codes |= {m.code for row in report.rows for cell in row.cells for m in cell.feedback}
    if full_marks(report) or codes & _RIGHTLY_REFUSED.get(each.name.partition(",")[0], frozenset()):
        return ""
    return f"{report.verdict.value}: {', '.join(sorted(codes))}"


def main() -> int:
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--exercise", default="", help="only exercises with this in their id")
    parser.add_argument("--printer", default="", help="only prints with this in their name")
    parser.add_argument("--show", action="store_true", help="show the texts without full marks")
    chosen = parser.parse_args()
    catalogue = shipped_exercises()
    exercises = [each for each in catalogue.values() if chosen.exercise in each.id]
    tried = [p for e in exercises for p in prints(e) if chosen.printer in p.name]
    failed = 0
    for each in tried:
        if reason := refused(each, catalogue[each.exercise]):
            failed += 1
            text = f"\n{each.text}" if chosen.show else ""
            sys.stdout.write(f"{each.exercise} {each.part} [{each.name}] {reason}{text}\n")
    sys.stdout.write(f"{len(tried)} prints, {failed} without full marks\n")
    return bool(failed)


if __name__ == "__main__":
    sys.exit(main())
