"""`dh-grader courses assignments`: the assignments of a course, and extensions."""

from collections.abc import Iterator, Mapping
from pathlib import Path
from typing import Annotated, Any, TypeVar

import typer
from pydantic import BaseModel, ValidationError
from pydantic_core import ErrorDetails
from sqlalchemy import Connection

from service.cli.commands.attempts import encodable
from service.cli.exercises.new_file import warn_of_unread
from service.cli.language import spoken
from service.cli.operations.assignment_lines import assignment_lines
from service.cli.operations.course_changes import changed, deleted
from service.cli.terminal import give_up, installed, installed_exercise, stdout
from service.contract.courses import (
    AssignedPoints,
    AssignmentChange,
    CourseAssignment,
    DeletionRequest,
    Extension,
    NewAssignment,
    Practice,
    ShowSolution,
)
from service.courses import assignments, dealing, deletion
from service.formats.shared.plain_text import visible
from service.submissions.assignment import Assignment, load_assignment
from service.submissions.field_errors import field_error
from service.submissions.lookup import find_exercise
from service.translations import joined, paragraph, say

M = TypeVar("M", bound=BaseModel)

commands = typer.Typer(help="The assignments of a course.", no_args_is_help=True)

# What these options are to remove what was set before.
_NONE = "none"
_REMOVABLE = ("opens", "due", "closes", "limit", "feedback", "hint_prices")

CourseOption = Annotated[str, typer.Argument(help="The id of a course.", callback=encodable)]
AssignmentName = Annotated[str, typer.Argument(help="The id of the assignment.")]
TitleOption = Annotated[str | None, typer.Option(help="The title.", callback=encodable)]
ExercisesOption = Annotated[
    list[str] | None,
    typer.Option("--exercise", help="An exercise and its points: scara=10. Repeatable."),
]
FileOption = Annotated[
    Path | None,
    typer.Option(help="An assignment file: its title, exercises, feedback and variants."),
]
OpensOption = Annotated[
    str | None,
    typer.Option(
        help='From when on attempts are accepted: "2026-10-01 08:00", in the time zone of the '
        "course. A date without a time is the start of the day; none removes."
    ),
]
DueOption = Annotated[
    str | None,
    typer.Option(
        help='Such as "2026-10-15 23:59", in the time zone of the course. A date without a time '
        "is 23:59:59; none removes."
    ),
]
ClosesOption = Annotated[
    str | None, typer.Option(help="Until when late attempts are accepted, as --due.")
]
LimitOption = Annotated[str | None, typer.Option(help="The most attempts at each exercise.")]
LateWorthOption = Annotated[
    float | None, typer.Option(min=0, max=1, help="The share that a late attempt earns. [0.5]")
]
FeedbackOption = Annotated[
    str | None, typer.Option(help="One level for each attempt: score,verdicts,hints.")
]
PracticeOption = Annotated[
    Practice | None, typer.Option(help="Whether answers are graded without being recorded.")
]
WithAttempts = Annotated[
    bool,
    typer.Option("--with-attempts", help="Delete the attempts, too, with answers and reports."),
]
YesOption = Annotated[bool, typer.Option("--yes", help="Do not ask.")]
SolutionOption = Annotated[ShowSolution | None, typer.Option(help="When the solution is shown.")]
VariantsOption = Annotated[
    bool | None,
    typer.Option(
        "--variants/--no-variants", help="Give each learner a variant of their own, or none."
    ),
]

HintPricesOption = Annotated[
    str | None,
    typer.Option(help="What each step of a hint costs, as shares of the points: 0,0.05,0.1."),
]


def checked(model: type[M], **fields: Any) -> M:
    """Return a request body with these fields; exit if they are invalid."""
    try:
        given = {name: value for name, value in fields.items() if value is not None}
        return model.model_validate(given)
    except ValidationError as error:
        give_up(paragraph(*dict.fromkeys(_told(each) for each in error.errors())))


def _told(error: ErrorDetails) -> str:
    match error["loc"], error["type"]:
        case ("id",), "string_pattern_mismatch":
            return say("The id has small letters, digits and hyphens, such as homework-1.")
        case ("exercises",), "missing" | "too_short":
            return say("Choose at least one exercise.")
    place = ".".join(map(str, error["loc"]))
    return say("{place}: {message}", place=place, message=field_error(error))


@commands.command("add")
def add(
    course: CourseOption,
    assignment: AssignmentName,
    title: TitleOption = None,
    exercise: ExercisesOption = None,
    file: FileOption = None,
    opens: OpensOption = None,
    due: DueOption = None,
    closes: ClosesOption = None,
    limit: LimitOption = None,
    late_worth: LateWorthOption = None,
    feedback: FeedbackOption = None,
    practice: PracticeOption = None,
    solution: SolutionOption = None,
    variants: VariantsOption = None,
    hint_prices: HintPricesOption = None,
) -> None:
    """Add an assignment to a course."""
    fields = _fields(
        title, exercise, file, opens, due, closes, limit, late_worth, feedback, practice, solution
    )
    if variants is not None:
        fields["variants"] = variants
    if hint_prices is not None:
        fields["hint_prices"] = _words(hint_prices)
    fields.setdefault("title", assignment)
    body = checked(NewAssignment, id=assignment, **fields)
    catalogue = installed()

    def added(connection: Connection) -> CourseAssignment:
        made = assignments.add_assignment(connection, course, body, catalogue.keys())
        dealing.pin_choices(connection, course, assignment, catalogue)
        return made

    _print(changed(added))
    warn_of_unread(each.exercise for each in body.exercises)


@commands.command("change")
def change(
    course: CourseOption,
    assignment: AssignmentName,
    title: TitleOption = None,
    exercise: ExercisesOption = None,
    file: FileOption = None,
    opens: OpensOption = None,
    due: DueOption = None,
    closes: ClosesOption = None,
    limit: LimitOption = None,
    late_worth: LateWorthOption = None,
    feedback: FeedbackOption = None,
    practice: PracticeOption = None,
    solution: SolutionOption = None,
    variants: VariantsOption = None,
    hint_prices: HintPricesOption = None,
) -> None:
    """Change an assignment. With a later due date, late attempts get their points back."""
    fields = _fields(
        title, exercise, file, opens, due, closes, limit, late_worth, feedback, practice, solution
    )
    if variants is not None:
        fields["variants"] = variants
    if hint_prices is not None:
        fields["hint_prices"] = _words(hint_prices)
    removed = dict.fromkeys(name for name in _REMOVABLE if fields.get(name) == _NONE)
    body = checked(AssignmentChange, **(fields | removed))
    # A field that is None on purpose removes what was set.
    body = body.model_copy(update=removed)
    catalogue = installed()

    def done(connection: Connection) -> CourseAssignment:
        known = catalogue.keys()
        made = assignments.change_assignment(connection, course, assignment, body, known)
        dealing.pin_choices(connection, course, assignment, catalogue)
        return made

    _print(changed(done))
    warn_of_unread(each.exercise for each in body.exercises or ())


@commands.command("list")
def list_assignments(course: CourseOption) -> None:
    """List the assignments of a course, with the extensions."""
    for each in changed(lambda it: assignments.assignments_of(it, course)):
        _print(each)


@commands.command("delete")
def delete(
    course: CourseOption,
    assignment: AssignmentName,
    with_attempts: WithAttempts = False,
    yes: YesOption = False,
) -> None:
    """Delete an assignment with its extensions; with --with-attempts also with its attempts."""
    name = say("the assignment {assignment}", assignment=visible(assignment))
    deleted(
        name,
        lambda it, wanted: deletion.delete_assignment(it, course, assignment, wanted),
        DeletionRequest(with_attempts=with_attempts),
        yes=yes,
    )


@commands.command("extend")
def extend(
    course: CourseOption,
    assignment: AssignmentName,
    learner: Annotated[str, typer.Argument(help="The learner's id.", callback=encodable)],
    due: DueOption = None,
    closes: ClosesOption = None,
    limit: LimitOption = None,
) -> None:
    """Give a learner other dates or another limit; without options, the usual ones again."""
    given = {"due": due, "closes": closes, "limit": limit}
    body = checked(Extension, learner=learner, **given)
    _print(changed(lambda it: assignments.extend(it, course, assignment, body)))


@commands.command("variants")
def variants_of_learner(
    course: CourseOption,
    assignment: AssignmentName,
    learner: Annotated[str, typer.Argument(help="The learner's id.", callback=encodable)],
    new: Annotated[
        str | None, typer.Option(metavar="EXERCISE", help="Deal another variant of this exercise.")
    ] = None,
) -> None:
    """Show which variants a learner has, or deal a new one."""
    catalogue = installed()
    if new is not None:
        chosen = find_exercise(catalogue, new)
        changed(lambda it: dealing.deal_again(it, course, assignment, learner, chosen))
    found = changed(lambda it: dealing.learner_variants(it, course, assignment, learner, catalogue))
    for each in found:
        dealt: list[str] = [f"{visible(learner)}: {each.variant}"]
        if each.deals != 1:
            dealt.append(say("deal {number}", number=each.deals))
        if each.values is not None:
            values = ", ".join(f"{name} = {value}" for name, value in each.values.items())
            dealt.append(say("by earlier choices: {values}", values=visible(values)))
        stdout().print(spoken(joined(", ", dealt)), soft_wrap=True)


@commands.command("renew")
def renew_variants(course: CourseOption, assignment: AssignmentName) -> None:
    r"""Deal the variants by the choices that `\[vary]` has now in the exercise files.

    Learners may get other numbers. Their attempts stay as they are.
    """
    catalogue = installed()
    changed(lambda it: dealing.pin_choices(it, course, assignment, catalogue, renew=True))


def _fields(
    title: str | None,
    exercise: list[str] | None,
    file: Path | None,
    opens: str | None,
    due: str | None,
    closes: str | None,
    limit: str | None,
    late_worth: float | None,
    feedback: str | None,
    practice: Practice | None,
    solution: ShowSolution | None,
) -> dict[str, Any]:
    fields = {} if file is None else dict(_of_file(load_assignment(file, installed_exercise)))
    given = {
        "title": title,
        "exercises": [_points(each) for each in exercise or ()] or None,
        "opens": opens,
        "due": due,
        "closes": closes,
        "limit": limit,
        "late_worth": late_worth,
        "feedback": feedback and _words(feedback),
        "practice": practice,
        "solution": solution,
    }
    return fields | {name: value for name, value in given.items() if value is not None}


def _of_file(assignment: Assignment) -> Iterator[tuple[str, Any]]:
    exercises = []
    for each in assignment.exercises:
        if each.path is not None or each.left_out:
            give_up(
                say(
                    "{exercise}: an assignment of a course has whole exercises of the catalogue: "
                    "leave out path and parts.",
                    exercise=each.exercise.id,
                )
            )
        exercises.append(AssignedPoints(exercise=each.exercise.id, points=each.worth))
    yield "title", assignment.title
    yield "exercises", exercises
    if assignment.feedback is not None:
        yield "feedback", [assignment.feedback]
    if assignment.variants:
        yield "variants", True


def _points(option: str) -> Mapping[str, Any]:
    name, sign, points = option.partition("=")
    if not sign:
        exercise = installed_exercise(name)
        return {"exercise": exercise.id, "points": sum(part.points for part in exercise.parts)}
    return {"exercise": name, "points": points}


def _words(option: str) -> str | list[str]:
    return option if option == _NONE else option.split(",")


def _print(assignment: CourseAssignment) -> None:
    screen = stdout()
    for i, line in enumerate(assignment_lines(assignment, installed)):
        screen.print("  " * (i > 0) + spoken(line), soft_wrap=True)
