"""The right answer to each part, computed by SymPy and laid out as text and LaTeX."""

from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass, replace
from typing import Any, Final

import numpy as np
import sympy

from dh_grader.catalogue import (
    Exercise,
    Joint,
    PartSpec,
    PosePartSpec,
    Robot,
    ScrewRobot,
    grid_values,
)
from dh_grader.catalogue.kinds import (
    FRAME_CELLS,
    DhRowSpec,
    DhTableSpec,
    EulerAnglesSpec,
    FindSlipSpec,
    FramesSpec,
    LinkTransformsSpec,
    MatrixSpec,
    PositionSpec,
    RotationSpec,
    ScrewAxesSpec,
    TransformSpec,
    VectorSpec,
    frame_labels,
)
from dh_grader.catalogue.robot import EXACT, ROW_QUANTITIES, TRIALS, FormulaRow, trial_values
from dh_grader.expressions import Expression, Kind, read
from dh_grader.expressions.printing import to_latex, to_text
from dh_grader.expressions.vocabulary import Node
from dh_grader.grading.kinds.tables import slip_of
from dh_grader.kinematics import COLUMNS, Convention, dh1_residual, dh2_residual
from dh_grader.learning import as_rows
from dh_grader.solutions.algebra import (
    Algebra,
    Motion,
    TooLongError,
    Turn,
    Writer,
    X,
    Y,
    Z,
    as_angle,
    between,
    euler_angles,
    joint_axes,
    link,
    multiplied,
)
from dh_grader.solutions.solution import (
    LinkSolution,
    ModelSolution,
    PartAnswer,
    PrintedAnswer,
    Shown,
)
from dh_grader.translations import Sentence, say

# --- The state while one exercise is solved, and the steps that several answer kinds share


@dataclass(frozen=True, slots=True)
class Work:
    """An exercise, its conversion to SymPy, and the conversion back to trees."""

    exercise: Exercise
    algebra: Algebra
    writer: Writer

    def as_written(self, part: PartSpec) -> list[list[Node]] | None:
        """Return the part's formulas from the exercise file; None if the robot is used instead."""
        grid, written = self.exercise.formulas.get(part.id), part.formulas()
        if grid is None or written is None:
            return None
        return [self._row(*each) for each in zip(grid, written.quantities, strict=True)]

    def table_row(self, row: FormulaRow) -> list[Node]:
        """Return a row of the reference table as the author wrote it."""
        return self._row(row, ROW_QUANTITIES)

    def _row(self, formulas: Sequence[Expression], quantities: Sequence[Kind]) -> list[Node]:
        return [self._with_units(*each) for each in zip(formulas, quantities, strict=True)]

    def _with_units(self, formula: Expression, quantity: Kind) -> Node:
        # Students who work in degrees need the units.
        text = to_text(formula.tree)
        in_degrees = read(text, self.exercise.vocabulary, quantity=quantity, angle_unit="degrees")
        if in_degrees.tree == formula.tree:
            return formula.tree
        exact = self.algebra.of(formula)
        return self.writer.angle(exact) if quantity == "angle" else self.writer.number(exact)

    def pose_motions(self, part: PosePartSpec) -> list[Motion]:
        """Return the motions whose product is the pose that the part asks for."""
        return between(self.exercise, part.start, part.to, self.algebra, home=part.home)

    def matrix(self, entries: sympy.Matrix) -> PrintedAnswer:
        """Lay out a matrix of numbers and lengths."""
        return matrix([[self.writer.number(each) for each in row] for row in entries.tolist()])

    def link_matrices(self, convention: Convention) -> dict[str, PrintedAnswer]:
        """Return the transform of each row of the robot's table, by the row's label."""
        reference = self.exercise.robot.tables[convention]
        return {
            label: self.matrix(multiplied(link(row, convention, self.algebra)).matrix())
            for label, row in zip(reference.labels, reference.rows, strict=True)
        }


# --- The model solution of an exercise


def solved(exercise: Exercise) -> ModelSolution:
    """Return the model solution of an exercise."""
    # It depends only on the exercise.
    work = Work(exercise, Algebra(exercise), Writer(exercise))
    robot = exercise.reference
    links = work.link_matrices(robot.convention) if isinstance(robot, Robot) else {}
    parts = tuple(_part_answer(part, work) for part in exercise.parts)
    pose = None if robot is None else _pose(work, list(links))
    # Sort by function and length: c1, c2, c12, s1, s2, s12.
    notation = sorted(work.writer.used, key=lambda name: (name[0], len(name), name))
    return ModelSolution(
        exercise=exercise.id,
        version=exercise.version,
        notation={name: work.writer.used[name] for name in notation},
        parts=parts,
        links=tuple(LinkSolution(each.text, each.latex, label) for label, each in links.items()),
        pose=pose,
    )


def _part_answer(part: PartSpec, work: Work) -> PartAnswer:
    try:
        right: PrintedAnswer = ANSWERS[part.kind](part, work)
    except TooLongError:
        right = too_long()
    return PartAnswer(right.text, right.latex, part.id, part.kind, part.title, right.answer)


def _pose(work: Work, labels: Sequence[str]) -> Shown:
    # A pose that is too long becomes a product of link transforms.
    pose = multiplied(between(work.exercise, "base", "tool", work.algebra))
    try:
        shown: Shown = work.matrix(pose.matrix())
    except TooLongError:
        shown = product(labels) if labels else too_long()
    return Shown(shown.text, shown.latex)


# --- The model answer of kind ``vector``: the list in the exercise file


def answer_vector(part: VectorSpec, work: Work) -> PrintedAnswer:
    """Return the components in order."""
    given = work.as_written(part)
    assert given is not None
    return listed(given[0])


# --- The model answer of kind ``transform``


def answer_transform(part: TransformSpec, work: Work) -> PrintedAnswer:
    """Return the transform that the exercise file gives, or the pose of the robot."""
    given = work.as_written(part)
    return matrix(given) if given else work.matrix(multiplied(work.pose_motions(part)).matrix())


# --- The model answer of kind ``screw_axes``


def answer_screw_axes(part: ScrewAxesSpec, work: Work) -> PrintedAnswer:
    """Return the screw axes that the exercise file gives, or else those of the robot."""
    # The robot's joints are at home.
    given = work.as_written(part)
    if given:
        return matrix(given)
    axes = _in_space(work.exercise, work.algebra)
    if part.frame == "body":
        home = multiplied(between(work.exercise, "tool", "base", work.algebra, home=True))
        R, p = home.rotation, home.position
        # Ad_T (ω; v) = (R ω; R v + p × R ω). Source: *Modern Robotics*, definition 3.20.
        axes = [(R * omega, R * v + p.cross(R * omega)) for omega, v in axes]
    rows = [[sympy.expand(number) for half in axis for number in half] for axis in axes]
    return work.matrix(sympy.Matrix(rows))


def _in_space(exercise: Exercise, algebra: Algebra) -> list[tuple[sympy.Matrix, sympy.Matrix]]:
    if isinstance(exercise.reference, ScrewRobot):
        rows = algebra.matrix(exercise.reference.axes).tolist()
        return [(sympy.Matrix(row[:3]), sympy.Matrix(row[3:])) for row in rows]
    axes = zip(exercise.joints, joint_axes(exercise), strict=True)
    return [
        (sympy.zeros(3, 1), direction) if joint.prismatic else (direction, point.cross(direction))
        for joint, (direction, point) in axes
    ]


# --- The model answer of kind ``rotation``


_AXES = {"x": X, "y": Y, "z": Z}


def answer_rotation(part: RotationSpec, work: Work) -> PrintedAnswer:
    """Return the rotation that the exercise file or the robot determines."""
    given = work.as_written(part) if part.steps is None else None
    return matrix(given) if given else work.matrix(multiplied(_turns(part, work)).rotation)


def _turns(part: RotationSpec, work: Work) -> list[Motion]:
    # A turn about a fixed axis goes to the front.
    if part.steps is None:
        return work.pose_motions(part)
    angles = work.algebra.matrix(work.exercise.formulas[part.id])
    motions: list[Motion] = []
    for step, angle in zip(part.steps, angles, strict=True):
        motions.insert(0 if step.about == "fixed" else len(motions), Turn(_AXES[step.axis], angle))
    return motions


# --- The model answer of kind ``position``


def answer_position(part: PositionSpec, work: Work) -> PrintedAnswer:
    """Return the coordinates that the exercise file gives, or those of the robot's frame."""
    given = work.as_written(part)
    if given:
        return listed(given[0])
    position = multiplied(work.pose_motions(part)).position
    return listed(
        [work.writer.number(position["xyz".index(letter)]) for letter in part.coordinates]
    )


# --- The model answer of kind ``matrix``: the matrix in the exercise file


def answer_matrix(part: MatrixSpec, work: Work) -> PrintedAnswer:
    """Return the matrix in the exercise file."""
    given = work.as_written(part)
    assert given is not None
    return matrix(given)


# --- The model answer of kind ``link_transforms``: the transforms of the reference table's rows


def answer_link_transforms(part: LinkTransformsSpec, work: Work) -> PrintedAnswer:
    """Return the link transforms in order, each with its name."""
    matrices = work.link_matrices(part.convention)
    return PrintedAnswer(
        "\n\n".join(f"A{label} =\n{matrix.text}" for label, matrix in matrices.items()),
        "\n".join(
            f"A_{{{label}}} = {matrix.latex}" + r" \quad" for label, matrix in matrices.items()
        ),
        [matrix.answer for matrix in matrices.values()],
    )


# --- The model answer of kind ``frames``


_BASE = "xyz"


def answer_frames(part: FramesSpec, work: Work) -> PrintedAnswer:
    """Return the frames of the robot's own table, with all joint variables 0."""
    exercise = work.exercise
    robot, algebra = exercise.robot, Algebra(exercise, home=True)
    labels = frame_labels(robot, part.convention)
    standard = part.convention is Convention.STANDARD
    motions = []
    rows = []
    table = robot.tables[part.convention].rows
    for i, label in enumerate(labels):
        motions += link(table[i], part.convention, algebra)
        reached = multiplied(motions)
        origin = [work.writer.number(sympy.expand(each)) for each in reached.position]
        joint = robot.joints[i + 1 if standard else i].index
        z, x = (_direction(reached.rotation[:, column], work) for column in (2, 0))
        rows.append(PrintedFrame(label, str(joint), z, origin, x))
    return frames(rows)


def _direction(vector: sympy.Matrix, work: Work) -> str | list[Node]:
    simple = [sympy.simplify(each) for each in vector]
    for axis, component in enumerate(simple):
        if component in (1, -1):
            return f"{'+' if component == 1 else '-'}{_BASE[axis]}"
    return [work.writer.number(each) for each in simple]


# --- The model answer of kind ``find_slip``: the wrong cells, and the table without the slip


def answer_find_slip(part: FindSlipSpec, work: Work) -> PrintedAnswer:
    """Return the cells to mark, and the corrected table."""
    robot = work.exercise.robot
    table = robot.tables[part.convention]
    drawn = slip_of(part, work.exercise)
    marks = [f"{table.labels[i]}.{COLUMNS[j]}" for i, j in sorted(drawn.cells)]
    rows = [work.table_row(row) for row in table.rows]
    printed = table_layout(rows, table.labels, part.convention, named=False)
    return marked(marks, printed)


# --- The model answer of kind ``euler_angles``


def answer_euler_angles(part: EulerAnglesSpec, work: Work) -> PrintedAnswer:
    """Return the angles that the exercise file gives, or the angles of the robot's pose."""
    given = work.as_written(part)
    if given:
        return listed(given[0])
    angles = euler_angles(work.pose_motions(part), part.turns, part.axes)
    return listed(list(map(work.writer.angle, angles)))


# --- The model answer of kind ``dh_table``: the reference table in the requested convention


def answer_dh_table(part: DhTableSpec, work: Work) -> PrintedAnswer:
    """Return the table. If the part accepts either convention, the table names its convention."""
    robot = work.exercise.robot
    asked = part.convention
    convention = asked if isinstance(asked, Convention) else robot.convention
    table = robot.tables[convention]
    rows = [work.table_row(row) for row in table.rows]
    return table_layout(rows, table.labels, convention, named=asked == "either")


# --- The model answer of kind ``dh_row``: the DH row of a transform, or "no row"


_MOST_STEPS = 60


def answer_dh_row(part: DhRowSpec, work: Work) -> PrintedAnswer:
    """Return the DH row of the part's transform, or the answer that the transform has none."""
    # The row follows from the entries of a link transform (Spong, Hutchinson, Vidyasagar, *Robot
    # Modeling and Control*, eq. 3.10; Craig, *Introduction to Robotics*, eq. 3.6).
    grid = work.exercise.formulas[part.id]
    numbers = np.moveaxis(grid_values(grid, trial_values(work.exercise.variables), TRIALS), -1, 0)
    broken = [dh1_residual(numbers, part.convention), dh2_residual(numbers, part.convention)]
    if np.abs(broken).max() > EXACT:
        return no_row()
    T = work.algebra.matrix(grid)
    x, y, z = T[:3, 3]
    if part.convention is Convention.STANDARD:
        a, d = x * T[0, 0] + y * T[1, 0], z
        alpha, theta = as_angle(T[2, 1], T[2, 2]), as_angle(T[1, 0], T[0, 0])
    else:
        a, d = x, y * T[1, 2] + z * T[2, 2]
        alpha, theta = as_angle(-T[1, 2], T[2, 2]), as_angle(-T[0, 1], T[0, 0])
    length, angle = work.writer.number, work.writer.angle
    nodes = [length(_simplified(a)), angle(alpha), length(_simplified(d)), angle(theta)]
    return row(nodes, part.convention)


def _simplified(length: sympy.Expr) -> sympy.Expr:
    # l cos² φ + l sin² φ becomes l. Long formulas stay as they are, to save time.
    return sympy.trigsimp(sympy.expand(length)) if length.count_ops() < _MOST_STEPS else length


# --- The right answer to a part, and the answers that need no knowledge, by the kind of the part


# The functions that return the right answer.
ANSWERS: Final[Mapping[str, Callable[[Any, Work], PrintedAnswer]]] = {
    "dh_row": answer_dh_row,
    "dh_table": answer_dh_table,
    "euler_angles": answer_euler_angles,
    "find_slip": answer_find_slip,
    "frames": answer_frames,
    "link_transforms": answer_link_transforms,
    "matrix": answer_matrix,
    "position": answer_position,
    "rotation": answer_rotation,
    "screw_axes": answer_screw_axes,
    "transform": answer_transform,
    "vector": answer_vector,
}


# --- Lay out an answer as JSON, as text to paste, and as LaTeX


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


def table_layout(
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
    return replace(table_layout([nodes], ["1"], convention, named=False), answer=answer)


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


# --- Answers that need no knowledge; their points show whether the marking is fair
#
# In these answers, every joint turns about the z axis or slides along it by its variable; all other
# entries are 0.


_Rows = list[list[str]]

IDENTITY: _Rows = [["1" if i == j else "0" for j in range(4)] for i in range(4)]


def motion(joints: Sequence[Joint]) -> _Rows:
    """Return the homogeneous transform of joints that all turn about or slide along the z axis."""
    angle = " + ".join(joint.variable for joint in joints if not joint.prismatic)
    distance = " + ".join(joint.variable for joint in joints if joint.prismatic)
    rows = [list(row) for row in IDENTITY]
    if angle:
        rows[0][:2] = f"cos({angle})", f"-sin({angle})"
        rows[1][:2] = f"sin({angle})", f"cos({angle})"
    rows[2][3] = distance or "0"
    return rows


def poses(exercise: Exercise, size: int) -> list[_Rows]:
    """Return the poses that a lazy student would write: the identity, and all joints moved."""
    # ``size`` is 3 (rotations) or 4.
    of_joints = [motion(exercise.joints)] if exercise.joints else []
    return [[row[:size] for row in rows[:size]] for rows in (IDENTITY, *of_joints)]


def lazy_vector(part: VectorSpec, _exercise: Exercise) -> list[object]:
    """Return the answer that needs no knowledge: all components are 0."""
    return [["0"] * len(part.components)]


def lazy_transform(_part: TransformSpec, exercise: Exercise) -> list[object]:
    """Return the identity, and the transform of an arm whose joints all have the same axis."""
    return [*poses(exercise, 4)]


def lazy_screw_axes(part: ScrewAxesSpec, exercise: Exercise) -> list[object]:
    """Return two answers: every axis is the z axis of the base frame, and every axis is zero."""
    kinds = [joint.prismatic for joint in exercise.joints]
    prismatic = kinds if part.expected is None else [False] * len(part.expected)
    axes = [["0"] * 5 + ["1"] if slides else [*"001000"] for slides in prismatic]
    return [axes, [["0"] * 6] * len(axes)]


def lazy_rotation(_part: RotationSpec, exercise: Exercise) -> list[object]:
    """Return the identity, and the rotation of an arm whose joints all have the same axis."""
    return [*poses(exercise, 3)]


def lazy_position(part: PositionSpec, _exercise: Exercise) -> list[object]:
    """Return the answer that needs no knowledge: all coordinates are 0."""
    return [["0"] * len(part.coordinates)]


def lazy_matrix(part: MatrixSpec, _exercise: Exercise) -> list[object]:
    """Return two matrices: one of zeros, and one with 1 on the diagonal and 0 elsewhere."""
    rows, columns = len(part.quantities), len(part.quantities[0])
    zeros = [["0"] * columns for _ in range(rows)]
    ones = [["1" if i == j else "0" for j in range(columns)] for i in range(rows)]
    return [zeros, ones]


def lazy_link_transforms(part: LinkTransformsSpec, exercise: Exercise) -> list[object]:
    """Return the motion of each joint, and the identity for each row without a joint."""
    table = exercise.robot.tables[part.convention]
    fixed = len(table.rows) - len(table.joints)
    return [[*(motion([joint]) for joint in table.joints), *[IDENTITY] * fixed]]


def lazy_frames(part: FramesSpec, exercise: Exercise) -> list[object]:
    """Return frames on the correct joints that are all equal to the base frame."""
    standard = part.convention is Convention.STANDARD
    joints = [joint.index for joint in exercise.joints][int(standard) :]
    labels = frame_labels(exercise.robot, part.convention)
    rows = [
        dict(zip(FRAME_CELLS, [str(joint), "+z", "0", "0", "0", "+x"], strict=True))
        for joint, _ in zip(joints, labels, strict=False)
    ]
    return [rows]


def lazy_find_slip(part: FindSlipSpec, exercise: Exercise) -> list[object]:
    """Return the given table unchanged, with no cell marked."""
    return [{"table": {"rows": as_rows(slip_of(part, exercise).texts)}}]


def lazy_euler_angles(_part: EulerAnglesSpec, _exercise: Exercise) -> list[object]:
    """Return the answer that needs no knowledge: three zeros."""
    return [["0"] * 3]


def lazy_dh_table(part: DhTableSpec, exercise: Exercise) -> list[object]:
    """Return a table with the joint variables in their columns and 0 elsewhere."""
    robot, asked = exercise.robot, part.convention
    convention = asked if isinstance(asked, Convention) else robot.convention
    named = {"convention": convention.value} if asked == "either" else {}
    return [{"rows": robot.tables[convention].lazy_rows, **named}]


def lazy_dh_row(_part: DhRowSpec, _exercise: Exercise) -> list[object]:
    """Return a row of zeros, which needs no knowledge."""
    # "No row" is not included, because this guess may be right.
    return [dict.fromkeys(COLUMNS, "0")]


# The functions that return answers that need no knowledge.
LAZY: Final[Mapping[str, Callable[[Any, Exercise], list[object]]]] = {
    "dh_row": lazy_dh_row,
    "dh_table": lazy_dh_table,
    "euler_angles": lazy_euler_angles,
    "find_slip": lazy_find_slip,
    "frames": lazy_frames,
    "link_transforms": lazy_link_transforms,
    "matrix": lazy_matrix,
    "position": lazy_position,
    "rotation": lazy_rotation,
    "screw_axes": lazy_screw_axes,
    "transform": lazy_transform,
    "vector": lazy_vector,
}
