"""Tables whose joint numbers are not the expected ones, but begin for example with 0."""

from collections.abc import Iterator, Mapping, Sequence
from dataclasses import replace

from service.catalogue import Joint
from service.expressions import Vocabulary
from service.expressions.printing.spelling import Spelling
from service.grading.diagnosis.tables.intended_table import IntendedTable
from service.grading.feedback import Finding
from service.grading.misconception import register
from service.grading.part import Grading
from service.grading.reading.absent_variables import with_absent_variables
from service.grading.reading.tables.table import StudentRow, StudentTable, table_values
from service.translations import say, template

# Maps the names under a numbering to the joint variables that they mean.
Meanings = Mapping[str, str]
_NUMBERED = register(
    of=StudentTable,
    code="joint_numbering",
    rule="joint_variable",
    means=template("the joint numbers start at another number: θ0, θ1, θ2 for θ1, θ2, θ3"),
    example=("planar-rr", "table", {"1/theta": "theta0", "2/theta": "theta1"}),
    unlike={"1/a": "0", "1/d": "a1"},
)
_NUMBERED_BY_KIND = register(
    of=StudentTable,
    code="joint_numbering_by_kind",
    rule="joint_variable",
    means=template(
        "turning and sliding joints are numbered separately: θ1, θ2, d3, θ3 for θ1, θ2, d3, θ4"
    ),
    example=(
        "stanford-arm",
        "table",
        (
            "a, alpha, d, theta ↵ 0, -90deg, 0, theta1 ↵ 0, 90deg, d2, theta2 ↵ 0, 0, d3, 0 ↵ 0, "
            "-90deg, 0, theta3 ↵ 0, 90deg, 0, theta4 ↵ 0, 0, d6, theta5"
        ),
    ),
    unlike="0, -90, 0, theta1 ↵ 0, 90, d2, theta2 ↵ 0, 0, d3, 0 ↵ 0, -90, 0, theta4 ↵ 0, 90, 0, "
    "theta5 ↵ 0, 0, d6, theta6",
)


def by_other_numbering(table: StudentTable, grading: Grading) -> IntendedTable | None:
    """Return the table with its joint variables renumbered, or None."""
    # None if no other numbering gives each row the variable of its own joint.
    joints = grading.exercise.joints
    vocabulary = with_absent_variables(grading.exercise.vocabulary)
    used = [_joint_variables(row, vocabulary) for row in table.rows]
    if all(not names - {joint.variable} for names, joint in zip(used, joints, strict=False)):
        return None
    spelling = grading.spelling(entry for row in table.rows for entry in row.entries)
    written = set[str]().union(*used)
    if written <= {joint.variable for joint in joints}:
        # Another numbering has a name that this robot does not have. Rows that are missing or in
        # other places have only the robot's own names.
        return None
    for finding, every_name in _numberings(joints, spelling):
        if not written <= every_name.keys():
            continue
        meanings = {name: every_name[name] for name in written}
        if not _explains(used, meanings, joints):
            continue
        values = table_values(table.rows, grading.samples.renamed(meanings))
        rows = tuple(
            replace(row, values=cells, as_written=None)
            for row, cells in zip(table.rows, values, strict=True)
        )
        cells = frozenset(
            (i, column)
            for i, row in enumerate(table.rows)
            for column, each in enumerate(row.expressions)
            if each is not None and any(meanings.get(name, name) != name for name in each.symbols)
        )
        return IntendedTable(replace(table, rows=rows, values=values), finding, cells)
    return None


def _joint_variables(row: StudentRow, vocabulary: Vocabulary) -> set[str]:
    symbols = set[str]().union(*(each.symbols for each in row.expressions if each is not None))
    return {name for name in symbols if vocabulary.by_name[name].joint is not None}


def _explains(used: Sequence[set[str]], meanings: Meanings, joints: Sequence[Joint]) -> bool:
    # used are the joint variables in each row; meanings is the numbering.
    if len(used) < len(joints):
        return False
    own = [joint.variable for joint in joints]
    of_rows = [*own, *[""] * (len(used) - len(own))]
    return all(
        {meanings[name] for name in names} <= {variable}
        for names, variable in zip(used, of_rows, strict=True)
    )


def _numberings(joints: Sequence[Joint], spelling: Spelling) -> Iterator[tuple[Finding, Meanings]]:
    # Each numbering is a finding on it, and a map from written to correct variables.
    first = joints[0].index
    by_index = {joint.index: joint for joint in joints}
    for start in {0, 1, first - 1} - {first}:
        yield (
            _numbered_from(start, joints[0], spelling),
            {
                name: joint.variable
                for joint in joints
                for name in _names(joint.index - first + start, by_index)
            },
        )
    for slides_too in (False, True):
        meanings: dict[str, str] = {}
        count = {True: 0, False: 0}
        for joint in joints:
            count[joint.prismatic] += 1
            is_counted = slides_too or not joint.prismatic
            name = _name(count[joint.prismatic], by_index, joint.prismatic)
            meanings[name if is_counted else joint.variable] = joint.variable
        renamed = {variable for name, variable in meanings.items() if name != variable}
        moved = [joint for joint in joints if joint.variable in renamed]
        if moved:
            yield _numbered_by_kind(moved[0], spelling), meanings


def _names(index: int, joints: Mapping[int, Joint]) -> tuple[str, str]:
    return _name(index, joints, False), _name(index, joints, True)


def _name(index: int, joints: Mapping[int, Joint], slides: bool) -> str:
    joint = joints.get(index)
    if joint is not None and joint.prismatic == slides:
        return joint.variable
    return f"{'d' if slides else 'theta'}{index}"


def _numbered_from(start: int, first: Joint, spelling: Spelling) -> Finding:
    variable = spelling.names.get(first.variable, first.variable)
    return _NUMBERED.finding(
        say(
            "The joint variables are numbered from {start}. This robot's joints are numbered from "
            "{first}: the variable of its first joint is {variable}.",
            start=start,
            first=first.index,
            variable=variable,
        ),
        say("Add {number} to the index of each joint variable.", number=first.index - start),
    )


def _numbered_by_kind(joint: Joint, spelling: Spelling) -> Finding:
    variable = spelling.names.get(joint.variable, joint.variable)
    return _NUMBERED_BY_KIND.finding(
        say(
            "Turning and sliding joints are numbered separately. Number all joints together, from "
            "the base to the end effector: the variable of joint {joint} is {variable}.",
            joint=joint.index,
            variable=variable,
        ),
        say("Number turning and sliding joints together."),
    )
