"""Write an answer in many notations, and check that all notations get the same points."""

import json
import re
import tempfile
from collections.abc import Callable, Iterator, Sequence
from pathlib import Path
from random import Random
from typing import Any, Final

import numpy as np
from dh_grader.catalogue import Exercise, load_exercise
from dh_grader.grading import PartReport, Verdict

from tests.attack.bodies import COLUMNS, exercises, model_of
from tests.attack.formulas import (
    Call,
    Name,
    Number,
    Power,
    Product,
    Quotient,
    Sum,
    Tree,
    Turn,
    changed_sign,
    evaluated,
    formula,
    numbers,
)
from tests.attack.spellings import PLAIN, Spelling, Writer
from tests.grading.support.submitting import graded, handed_in, one_part, part
from tests.pasting.writers import FORMATS, TABLES
from tests.solutions.solved import memoized_by_exercise

Suited = Callable[[str, Random], Spelling]
Outcome = tuple[str, str, str]
Trees = list[list[Tree]]

_SETTING: Final = """
[robot]
structure = "RRPRRR"
convention = "standard"
joints = ["theta1", "theta2", "d3", "theta4", "theta5", "theta6"]
table = [
    ["a1", "alpha1", "d1", "theta1"], ["a2", "alpha2", "0", "theta2"], ["0", "beta", "d3", "0"],
    ["l1", "90deg", "l_base", "theta4"], ["l2", "-90deg", "0", "theta5"],
    ["0", "0", "k", "theta6"],
]
[symbols]
""" + "\n".join(
    f'{name} = {{ kind = "{kind}", description = "{name}" }}'
    for kind, names in {
        "length": ("a1", "a2", "d1", "l1", "l2", "l_base", "k"),
        "angle": ("alpha1", "alpha2", "beta"),
    }.items()
    for name in names
) + "\n"  # fmt: skip
_DEGREES: Final = re.compile(r"(\d+)deg")
_TERM: Final = re.compile(r"\s*([+-]?)\s*([A-Za-z][A-Za-z_]*\d?|\d+deg|[\d.]+)")


def exercise_of(trees: Sequence[Sequence[Tree]]) -> Exercise:
    plain = Writer(PLAIN, Random(0))
    # A list of texts is written in TOML as in JSON.
    rows = json.dumps([[plain.write(each) for each in row] for row in trees])
    text = one_part("matrix", f'expected = {rows}\nquantity = "number"', _SETTING)
    with tempfile.TemporaryDirectory() as folder:
        file = Path(folder) / "drawn.toml"
        file.write_text(text, encoding="utf-8")
        return load_exercise(file)


def _signature(report: PartReport) -> tuple[object, ...]:
    cells = [[cell.verdict.value for cell in row.cells] for row in report.rows]
    return report.verdict.value, report.points, [row.points for row in report.rows], cells


def _refused(report: PartReport) -> bool:
    verdicts = {cell.verdict for row in report.rows for cell in row.cells}
    return bool({Verdict.UNREADABLE, Verdict.MISSING} & (verdicts | {report.verdict}))


def _spoiled(random: Random, trees: Trees) -> tuple[Trees, tuple[int, int]] | None:
    i, j = random.randrange(len(trees)), random.randrange(len(trees[0]))
    changed = changed_sign(random, trees[i][j])
    values = numbers(random)
    before, after = evaluated(trees[i][j], values), evaluated(changed, values)
    if np.max(np.abs(after - before)) < 0.05 * max(1.0, np.max(np.abs(before))):
        return None
    rows = [list(row) for row in trees]
    rows[i][j] = changed
    return rows, (i, j)


def _is_tame(tree: Tree) -> bool:
    match tree:
        case Sum(terms):
            return all(_is_tame(term) for _, term in terms)
        case Product(factors):
            return all(map(_is_tame, factors))
        case Quotient(top, bottom):
            return _is_tame(top) and isinstance(bottom, Number)
        case Power(base, exponent):
            return _is_tame(base) and exponent > 0
        case Call(function, arguments):
            return function in ("sin", "cos", "abs", "atan") and all(map(_is_tame, arguments))
    return True


def _drawn(random: Random) -> Tree:
    while not _is_tame(tree := formula(random, 1)):
        pass
    return tree


def matrices(random: Random, suited: Suited) -> Iterator[Outcome]:
    trees = [[_drawn(random) for _ in range(3)] for _ in range(random.randint(2, 3))]
    exercise = exercise_of(trees)
    spoiled = _spoiled(random, trees)
    plain = Writer(PLAIN, random)
    for rows, at in ((trees, None), *((spoiled,) if spoiled else ())):
        wanted = graded(exercise, [[plain.write(each) for each in row] for row in rows])
        if at is None and wanted.verdict is not Verdict.CORRECT:
            yield "a right matrix", "misread", str(exercise.parts[0])
            continue
        if at and wanted.rows[at[0]].cells[at[1]].verdict is not Verdict.INCORRECT:
            yield (
                "a changed sign",
                "misread",
                f"{exercise.parts[0]} {plain.write(rows[at[0]][at[1]])}",
            )
        for name in (*random.sample(list(FORMATS), 4), "list"):
            writer = Writer(suited(name, random), random)
            cells = [[writer.write(each) for each in row] for row in rows]
            answer: Any = cells if name == "list" else FORMATS[name](cells)
            found = graded(exercise, answer)
            kind = "a matrix with a changed sign" if at else "a right matrix"
            yield kind, _compared(found, wanted), f"{name} {answer!r}"


def _compared(found: PartReport, wanted: PartReport) -> str:
    if _refused(found):
        if any(
            cell.verdict not in (is_wanted.verdict, Verdict.UNREADABLE, Verdict.MISSING)
            for row, wanted_row in zip(found.rows, wanted.rows, strict=False)
            for cell, is_wanted in zip(row.cells, wanted_row.cells, strict=False)
        ):
            return "misread"
        return "refused: " + ",".join(sorted(_reasons(found)))
    return "read" if _signature(found) == _signature(wanted) else "misread"


def _reasons(report: PartReport) -> set[str]:
    cells = [cell for row in report.rows for cell in row.cells]
    found = {m.code for cell in cells if cell.verdict is Verdict.UNREADABLE for m in cell.feedback}
    return found or {m.code for m in report.feedback}


# --- tables


def _tree(text: str) -> Tree | None:
    terms: list[tuple[int, Tree]] = []
    at = 0
    for match in _TERM.finditer(text):
        if match.start() != at or (at and not match[1]):
            return None
        at = match.end()
        sign, word = -1 if match[1] == "-" else 1, match[2]
        degrees = _DEGREES.fullmatch(word)
        term: Tree = Name(word) if word[0].isalpha() else Number(word)
        terms.append((sign, Turn(int(degrees[1])) if degrees else term))
    if at != len(text) or not terms:
        return None
    return terms[0][1] if len(terms) == 1 and terms[0][0] == 1 else Sum(tuple(terms))


@memoized_by_exercise
def _trees_of(exercise: Exercise) -> Trees | None:
    rows = model_of(exercise).answers["table"]["rows"]
    trees = [[_tree(str(row[column])) for column in COLUMNS] for row in rows]
    found = [[tree for tree in row if tree is not None] for row in trees]
    return (
        None if re.search(r"q\d", str(rows)) or list(map(len, found)) != [4] * len(rows) else found
    )


def _table(random: Random) -> tuple[Exercise, Trees]:
    with_tables = [each for each in exercises() if each.part("table")]
    while True:
        exercise = random.choice(with_tables)
        if trees := _trees_of(exercise):
            return exercise, trees


def _slips(random: Random, trees: Trees) -> Trees:
    rows = [list(row) for row in trees]
    for _ in range(random.choice((0, 1, 1, 2))):
        row = random.choice(rows)
        at = random.randrange(4)
        slip = random.randrange(4)
        if slip == 0:
            row[at] = changed_sign(random, row[at])
        elif slip == 1:
            other = random.randrange(4)
            row[at], row[other] = row[other], row[at]
        elif slip == 2:
            row[at] = Number("0")
        elif isinstance(row[at], Name):
            row[at] = Sum(((1, row[at]), (random.choice((1, -1)), Turn(90))))
    return rows


# Column headers as people write them.
_HEADERS: Final = (
    ("a", "alpha", "d", "theta"),
    ("a_i", "alpha_i", "d_i", "theta_i"),
    ("a", "α", "d", "θ"),
    ("$a_i$", r"$\alpha_i$", "$d_i$", r"$\theta_i$"),
)


def tables(random: Random, suited: Suited) -> Iterator[Outcome]:
    exercise, trees = _table(random)
    rows = _slips(random, trees)
    plain = Writer(PLAIN, random)

    def report(answer: object) -> PartReport:
        return part(handed_in(exercise, {"table": answer}), "table")

    wanted = report(_json([[plain.write(each) for each in row] for row in rows]))
    listed = Writer(suited("list", random), random)
    written = [[listed.write(each) for each in row] for row in rows]
    yield "a table", _compared(report(_json(written)), wanted), f"{exercise.id} {written}"
    for name in random.sample(list(TABLES), 3):
        writer = Writer(suited(name, random), random)
        order = random.sample(range(4), 4) if random.random() < 0.5 else list(range(4))
        heads = random.choice(_HEADERS[:3] if "LaTeX" not in name else _HEADERS)
        cells = [[heads[column] for column in order]]
        cells += [[writer.write(row[column]) for column in order] for row in rows]
        if random.random() < 0.5:
            cells = [[("i", *map(str, range(1, 10)))[i], *row] for i, row in enumerate(cells)]
        text = TABLES[name](cells)
        yield "a pasted table", _compared(report(text), wanted), f"{exercise.id} {name} {text}"


def _json(rows: Sequence[Sequence[str]]) -> dict[str, Any]:
    return {"rows": [dict(zip(COLUMNS, row, strict=True)) for row in rows]}
