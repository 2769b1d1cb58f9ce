"""Test solutions in the formats that other programs print."""

from collections.abc import Callable, Mapping
from functools import partial, reduce
from operator import mul
from random import Random

import pytest
import sympy
from dh_grader.catalogue import Exercise, shipped_folder
from dh_grader.catalogue.kinds import DhTableSpec
from dh_grader.expressions import LIMITS, Expression, read
from dh_grader.kinematics import COLUMNS, Convention
from dh_grader.solutions.algebra import Algebra
from sympy.printing.numpy import NumPyPrinter

from tests.grading.support.submitting import full_marks, handed_in
from tests.pasting.writers import FORMATS
from tests.samples import one_in
from tests.shipped import sampled
from tests.solutions.prints import PRINTERS as MATRIX_PRINTERS
from tests.solutions.prints import Print, prints, refused
from tests.solutions.solved import memoized_by_exercise, solved

# --- Model solutions get full marks in the output formats of programs such as MATLAB

# `tests.solutions.prints` defines these formats and submits every solution in every format; this
# file submits a sample.

IDS = sorted(file.stem for file in shipped_folder().glob("*.toml"))
PRINTERS: Mapping[str, Callable[[sympy.Expr], str]] = {
    "str": str,
    "latex": sympy.latex,
    "octave_code": sympy.octave_code,
    "numpy": NumPyPrinter().doprint,
}
_expressions: dict[tuple[str, str | float], sympy.Expr] = {}


def expression(exercise: Exercise, entry: str | float) -> sympy.Expr:
    key = (exercise.id, entry)
    if key not in _expressions:
        _expressions[key] = Algebra(exercise).of(read(entry, exercise.vocabulary))
    return _expressions[key]


def printed(answer: object, exercise: Exercise, printer: Callable[[sympy.Expr], str]) -> object:
    if isinstance(answer, dict):
        # The marks on a slip are no formulas.
        return {
            key: value if key == "marked" else printed(value, exercise, printer)
            for key, value in answer.items()
        }
    if isinstance(answer, list):
        return [printed(value, exercise, printer) for value in answer]
    if isinstance(answer, bool) or not isinstance(answer, str | int | float):
        return answer
    text = printer(expression(exercise, answer))
    # With full names and \\left(, the longest entries of six and seven joints exceed the limit.
    # They are not replaced; the test reports their number.
    return text if len(text) <= LIMITS.characters else answer


def _unchanged_entries(before: object, after: object) -> int:
    if isinstance(before, list) and isinstance(after, list):
        return sum(map(_unchanged_entries, before, after))
    return int(isinstance(before, str) and before == after and len(before) > 100)


@pytest.mark.sampled(4)
@pytest.mark.parametrize("printer", PRINTERS)
@pytest.mark.parametrize("exercise_id", sampled(IDS, 3))
def test_the_model_solution_gets_full_marks_as_sympy_prints_it(
    exercise_id: str,
    printer: str,
    catalogue: Mapping[str, Exercise],
    figure: Callable[[str], None],
) -> None:
    exercise = catalogue[exercise_id]
    solution = solved(exercise)
    # Placed frames have directions such as +y, which are no formulas.
    frames = {part.id for part in exercise.parts if part.kind == "frames"}
    answers = {
        part.part: part.answer
        if part.text == "none" or part.part in frames
        else printed(part.answer, exercise, PRINTERS[printer])
        for part in solution.parts
    }
    kept = sum(_unchanged_entries(part.answer, answers[part.part]) for part in solution.parts)
    if kept:
        figure(
            f"{exercise_id}, {printer}: {kept} entries too long as printed, handed in as they were"
        )
    for part in handed_in(exercise, answers).parts:
        assert full_marks(part), part


# The number of prints for each exercise. The choice is random, but fixed for each exercise.
SAMPLE = 6


@pytest.mark.sampled(4)
@pytest.mark.parametrize("exercise_id", sampled(IDS, 3))
def test_matrices_get_full_marks_as_programs_print_them(
    exercise_id: str, catalogue: Mapping[str, Exercise]
) -> None:
    exercise = catalogue[exercise_id]
    found = list(prints(exercise))
    chosen = Random(exercise_id).sample(found, min(SAMPLE, len(found)))
    reasons = {each.name: refused(each, exercise) for each in chosen}
    assert {name: why for name, why in reasons.items() if why} == {}


LONG = (
    "str", "octave_code", "NumPyPrinter", "NumPy repr", "latex, mul_symbol=times", "Maxima",
    "latex, mul_symbol=ldot", "MATLAB latex", "Mathematica TeXForm", "Maxima tex",
)  # fmt: skip


@pytest.mark.parametrize("printer", one_in(4, LONG))
def test_the_expanded_pose_of_seven_joints_gets_full_marks(
    printer: str, catalogue: Mapping[str, Exercise]
) -> None:
    # This is the longest pose in textbook exercises: entries of 1,100 characters.
    exercise = catalogue["baxter-left-arm"]
    write = partial(MATRIX_PRINTERS[printer], multiplied_out(exercise))
    assert refused(Print(exercise.id, "pose", printer, write), exercise) == ""


@memoized_by_exercise
def multiplied_out(exercise: Exercise) -> sympy.Matrix:
    """Return the robot's pose as expanded formulas."""
    # The link matrices are those of SHV, eq. 3.10.
    table = exercise.robot.tables[Convention.STANDARD]
    algebra = Algebra(exercise)

    def link(row: tuple[Expression, ...]) -> sympy.Matrix:
        a, alpha, d, theta = map(algebra.of, row)
        c, s, ca, sa = sympy.cos(theta), sympy.sin(theta), sympy.cos(alpha), sympy.sin(alpha)
        lines = [[c, -s * ca, s * sa, a * c], [s, c * ca, -c * sa, a * s], [0, sa, ca, d]]
        return sympy.Matrix([*lines, [0, 0, 0, 1]])

    return reduce(mul, map(link, table.rows)).expand()


# --- The model table of every exercise, pasted in every format, gets full marks


@pytest.mark.sampled(4)
@pytest.mark.parametrize("exercise_id", sampled(IDS))
def test_the_model_table_gets_full_marks_in_every_format(
    exercise_id: str, catalogue: Mapping[str, Exercise]
) -> None:
    exercise = catalogue[exercise_id]
    tables = [part for part in exercise.parts if isinstance(part, DhTableSpec)]
    if not tables:
        pytest.skip("asks for no table")
    solution = {part.part: part.answer for part in solved(exercise).parts}
    for part in tables:
        answer = solution[part.id]
        assert isinstance(answer, dict)
        rows = [[str(row[column]) for column in COLUMNS] for row in answer["rows"]]
        refused = []
        for name, write in FORMATS.items():
            report = handed_in(exercise, {part.id: write(rows)})
            graded = next(each for each in report.parts if each.part == part.id)
            if not full_marks(graded):
                refused.append((name, write(rows), graded.feedback))
        assert not refused, refused[:2]
