"""For each misconception, count how often reports name it."""

# A table is left out if independent forward kinematics find it correct despite the misconception.

from collections.abc import Callable, Iterator, Sequence
from dataclasses import dataclass

from dh_grader.grading import PartReport, Submission, grade

from tests.frame_choice.oracle import is_equivalent
from tests.frame_choice.robots import (
    ALPHA,
    COLUMNS,
    GIVEN,
    ROBOTS,
    THETA,
    A,
    D,
    Robot,
    TextRow,
    exercise,
)

ANGLES = (ALPHA, THETA)

Rows = Sequence[TextRow]
Misconception = Callable[[Robot, Rows], Iterator[Rows]]


def report(robot: Robot, rows: Rows) -> PartReport:
    """Return the report of the service on a table of the robot."""
    answer = {
        "rows": [dict(zip(COLUMNS, row, strict=True)) for row in rows],
        "convention": robot.convention,
    }
    return grade(exercise(robot, GIVEN), Submission({"table": answer})).parts[0]


def codes(part: PartReport) -> set[str]:
    """Return the codes of all messages of a report."""
    cells = [message for row in part.rows for cell in row.cells for message in cell.feedback]
    rows = [message for row in part.rows for message in row.feedback]
    return {message.code for message in (*part.feedback, *rows, *cells)}


@dataclass(frozen=True)
class Named:
    """Counts how often reports named a misconception."""

    # `missed` has the other tables and their codes.
    named: int
    missed: list[tuple[str, Rows, list[str]]]

    @property
    def total(self) -> int:
        return self.named + len(self.missed)


def named_in_all_robots(misconception: Misconception, names: set[str]) -> Named:
    named, missed = 0, []
    for robot in ROBOTS:
        for rows in misconception(robot, robot.rows):
            plain = [list(row) for row in rows]
            complete = len(rows) == len(robot.rows)
            if complete and is_equivalent(robot, GIVEN, plain, robot.convention):
                continue
            found = codes(report(robot, rows))
            if found & names:
                named += 1
            else:
                missed.append((robot.name, rows, sorted(found)))
    return Named(named, missed)


def with_cell(rows: Rows, i: int, column: int, text: str) -> Rows:
    row = tuple(text if c == column else cell for c, cell in enumerate(rows[i]))
    return [*rows[:i], (row[0], row[1], row[2], row[3]), *rows[i + 1 :]]


def joint_cells(robot: Robot, rows: Rows) -> Iterator[tuple[int, int, str]]:
    for i, variable in enumerate(robot.joints):
        yield i, robot.column(i), variable


def without_variable(robot: Robot, i: int, column: int, cell: str) -> str | None:
    """Return a cell without its joint variable, or None if it has none."""
    if i >= len(robot.joints) or column != robot.column(i):
        return None
    rest = cell.replace(robot.joints[i], "").strip(" +")
    return rest or "0"


def is_constant(robot: Robot, i: int, column: int) -> bool:
    return i >= len(robot.joints) or column != robot.column(i)


def wrong_sign(robot: Robot, rows: Rows) -> Iterator[Rows]:
    for i, row in enumerate(rows):
        for column, cell in enumerate(row):
            if is_constant(robot, i, column):
                yield with_cell(rows, i, column, f"-({cell})")


def quarter_turn(robot: Robot, rows: Rows) -> Iterator[Rows]:
    for i, row in enumerate(rows):
        for column in ANGLES:
            yield with_cell(rows, i, column, f"{row[column]} + pi/2")


def half_turn(robot: Robot, rows: Rows) -> Iterator[Rows]:
    for i, row in enumerate(rows):
        for column in ANGLES:
            yield with_cell(rows, i, column, f"{row[column]} + pi")


def variable_missing(robot: Robot, rows: Rows) -> Iterator[Rows]:
    for i, column, _ in joint_cells(robot, rows):
        rest = without_variable(robot, i, column, rows[i][column])
        yield with_cell(rows, i, column, rest or "0")


def variable_sign(robot: Robot, rows: Rows) -> Iterator[Rows]:
    for i, column, variable in joint_cells(robot, rows):
        yield with_cell(rows, i, column, rows[i][column].replace(variable, f"(-{variable})"))


def variable_doubled(robot: Robot, rows: Rows) -> Iterator[Rows]:
    for i, column, variable in joint_cells(robot, rows):
        yield with_cell(rows, i, column, rows[i][column].replace(variable, f"2*{variable}"))


def variable_index(robot: Robot, rows: Rows) -> Iterator[Rows]:
    for i, column, variable in joint_cells(robot, rows):
        same = [q for j, q in enumerate(robot.joints) if robot.column(j) == column and j != i]
        for other in same[:1]:
            yield with_cell(rows, i, column, rows[i][column].replace(variable, other))


def variable_column(robot: Robot, rows: Rows) -> Iterator[Rows]:
    for i, column, _ in joint_cells(robot, rows):
        other = D if column == THETA else THETA
        moved = with_cell(rows, i, column, rows[i][other])
        yield with_cell(moved, i, other, rows[i][column])


def degrees_everywhere(robot: Robot, rows: Rows) -> Iterator[Rows]:
    in_degrees = {"pi/2": "90", "-pi/2": "-90", "pi": "180", "-pi": "-180"}
    changed = []
    for row in rows:
        cells = list(row)
        for column in ANGLES:
            for exact, number in in_degrees.items():
                if cells[column] == exact:
                    cells[column] = number
                cells[column] = cells[column].replace(f"+{exact}", f"+{number}")
        changed.append((cells[0], cells[1], cells[2], cells[3]))
    yield changed


def columns_shifted(robot: Robot, rows: Rows) -> Iterator[Rows]:
    link = [("0", "0"), *((row[A], row[ALPHA]) for row in rows[:-1])]
    yield [(a, alpha, row[D], row[THETA]) for (a, alpha), row in zip(link, rows, strict=True)]


def a_and_d_swapped(robot: Robot, rows: Rows) -> Iterator[Rows]:
    yield [(d, alpha, a, theta) for a, alpha, d, theta in rows]


def alpha_and_theta_swapped(robot: Robot, rows: Rows) -> Iterator[Rows]:
    yield [(a, theta, d, alpha) for a, alpha, d, theta in rows]


def rows_exchanged(robot: Robot, rows: Rows) -> Iterator[Rows]:
    for i in range(len(rows) - 1):
        yield [*rows[:i], rows[i + 1], rows[i], *rows[i + 2 :]]


def column_signs(robot: Robot, rows: Rows) -> Iterator[Rows]:
    yield [(a, f"-({alpha})", d, theta) for a, alpha, d, theta in rows]


def tool_row_missing(robot: Robot, rows: Rows) -> Iterator[Rows]:
    if len(rows) > len(robot.joints):
        yield rows[:-1]


def row_missing(robot: Robot, rows: Rows) -> Iterator[Rows]:
    for i in range(len(robot.joints)):
        yield [*rows[:i], *rows[i + 1 :]]


# Each misconception, and the codes that name it. Some slips have two names: −90° for 90° is a wrong
# sign and half a turn, and wrong signs at every α of a wrist reverse its joint 5.
MISCONCEPTIONS: tuple[tuple[Misconception, set[str]], ...] = (
    (wrong_sign, {"sign", "half_turn"}),
    (quarter_turn, {"quarter_turn"}),
    (half_turn, {"half_turn", "sign"}),
    (variable_missing, {"joint_variable_missing"}),
    (variable_sign, {"joint_variable_sign"}),
    (variable_doubled, {"joint_variable_doubled"}),
    (variable_index, {"joint_variable_index"}),
    (variable_column, {"joint_variable_column", "joint_variable_missing"}),
    (degrees_everywhere, {"degrees_as_radians"}),
    (columns_shifted, {"link_columns_shifted", "other_convention"}),
    (a_and_d_swapped, {"columns_swapped"}),
    (alpha_and_theta_swapped, {"columns_swapped"}),
    (rows_exchanged, {"row_order"}),
    (column_signs, {"column_sign", "sign", "joint_variable_sign"}),
    (tool_row_missing, {"missing_tool_row"}),
    (row_missing, {"missing_row"}),
)
