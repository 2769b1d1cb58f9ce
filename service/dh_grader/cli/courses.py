"""`dh-grader courses` and `assignments`: courses with learners, links, dates and a gradebook.

The rules of courses are in ``dh_grader.courses``; this file knows options and messages.
"""

import sys
from collections.abc import Callable, Iterable, Iterator, Mapping
from datetime import UTC, datetime
from pathlib import Path
from typing import Annotated, Any, Final, TypeVar

import typer
from pydantic import BaseModel, ValidationError
from pydantic_core import ErrorDetails
from rich.text import Text
from sqlalchemy import Connection

from dh_grader.catalogue import Exercise, FeedbackLevel
from dh_grader.cli.attempts import database, encodable
from dh_grader.cli.exercises import warn_of_unread
from dh_grader.cli.grade import write
from dh_grader.cli.options import installed, installed_exercise
from dh_grader.cli.terminal import complain, give_up, spoken, stdout, tell
from dh_grader.contract.courses import (
    LONGEST_LINK_DAYS,
    AssignedPoints,
    AssignmentChange,
    Course,
    CourseAssignment,
    CourseChange,
    CourseLearner,
    DeletedData,
    DeletionRequest,
    Extension,
    GradebookFormat,
    LinksRequest,
    MissingLearner,
    NewAssignment,
    NewCourse,
    Practice,
    RemovalRequest,
    ShowSolution,
)
from dh_grader.courses import (
    CourseError,
    assignments,
    decoded,
    read_class_list,
    roll,
    told_apart,
    with_own_dates,
)
from dh_grader.courses.gradebook import gradebook, gradebook_workbook, missing, written_gradebook
from dh_grader.courses.roll import issue_links, revoke_links, written_links
from dh_grader.formats.texts import number, percent, visible
from dh_grader.settings import load_settings
from dh_grader.store.database import in_transaction
from dh_grader.submissions import AssignedExercise, Assignment, load_assignment
from dh_grader.submissions.answers import ExerciseAnswers, answers_in, of_file
from dh_grader.submissions.bodies import field_error, find_exercise
from dh_grader.submissions.files import HandedIn, all_handed_in
from dh_grader.translations import Sentence, joined, paragraph, say, say_count, template

# --- `dh-grader courses assignments`: the assignments of a course, and extensions


M = TypeVar("M", bound=BaseModel)

course_assignments_commands = typer.Typer(help="The assignments of a course.", no_args_is_help=True)

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


@course_assignments_commands.command("add")
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
        assignments.pin_choices(connection, course, assignment, catalogue)
        return made

    _print(changed(added))
    warn_of_unread(each.exercise for each in body.exercises)


@course_assignments_commands.command("change")
def course_assignments_change(
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
        assignments.pin_choices(connection, course, assignment, catalogue)
        return made

    _print(changed(done))
    warn_of_unread(each.exercise for each in body.exercises or ())


@course_assignments_commands.command("list")
def list_assignments(course: CourseOption) -> None:
    """List the assignments of a course, with the extensions."""
    for each in changed(lambda it: assignments.assignments_of(it, course)):
        _print(each)


@course_assignments_commands.command("delete")
def course_assignments_delete(
    course: CourseOption,
    assignment: AssignmentName,
    with_attempts: WithAttempts = False,
    yes: YesOption = False,
) -> None:
    """Delete an assignment with its extensions; with --with-attempts also with its attempts."""
    name = say("the assignment {assignment}", assignment=visible(assignment))
    deleted(
        name,
        lambda it, wanted: assignments.delete_assignment(it, course, assignment, wanted),
        DeletionRequest(with_attempts=with_attempts),
        yes=yes,
    )


@course_assignments_commands.command("extend")
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


@course_assignments_commands.command("variants")
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
        changed(lambda it: assignments.deal_again(it, course, assignment, learner, chosen))
    found = changed(
        lambda it: assignments.learner_variants(it, course, assignment, learner, catalogue)
    )
    for each in found:
        dealt: list[str] = [f"{visible(learner)}: {each.variant}"]
        if each.deals != 1:
            dealt.append(say("deal {number}", number=each.deals))
        if each.values is not None:
            values = ", ".join(f"{name} = {value}" for name, value in each.values.items())
            dealt.append(say("by earlier choices: {values}", values=visible(values)))
        stdout().print(spoken(joined(", ", dealt)), soft_wrap=True)


@course_assignments_commands.command("renew")
def renew_variants(course: CourseOption, assignment: AssignmentName) -> None:
    r"""Deal the variants by the choices that `\[vary]` has now in the exercise files.

    Learners may get other numbers. Their attempts stay as they are.
    """
    catalogue = installed()
    changed(lambda it: assignments.pin_choices(it, course, assignment, catalogue, renew=True))


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


# --- `dh-grader courses`: courses with learners, links, assignments and a gradebook


courses_commands = typer.Typer(
    help="Courses: learners, links, assignments, gradebook.",
    no_args_is_help=True,
    add_completion=False,
)
_learners = typer.Typer(help="The learners of a course.", no_args_is_help=True)
courses_commands.add_typer(_learners, name="learners")
courses_commands.add_typer(course_assignments_commands, name="assignments")

CourseIdArgument = Annotated[
    str, typer.Argument(help="The id of a course.", show_default=False, callback=encodable)
]
Output = Annotated[Path | None, typer.Option(help="The file to write.")]
# The address of a service that was started without settings.
_LOCAL: Final = "http://127.0.0.1:8000"
LearnerOption = Annotated[
    list[str] | None, typer.Option("--learner", help="Only this learner. Repeatable. \\[all]")
]


@courses_commands.command("new")
def new(
    course: CourseIdArgument,
    title: Annotated[str, typer.Option(help="The title.", callback=encodable)],
    zone: Annotated[str, typer.Option(help="The time zone, such as Europe/Berlin.")],
) -> None:
    """Create a course. Its id has small letters, digits and hyphens."""
    body = checked(NewCourse, id=course, title=title, zone=zone)
    changed(lambda it: roll.add_course(it, body, datetime.now(UTC)), create=True)
    tell(say("The course {course} is there.", course=course))


@courses_commands.command("list")
def list_courses() -> None:
    """List the courses."""
    for each in changed(roll.all_courses):
        stdout().print(f"{each.id}  {visible(each.title)}  {_counts(each)}", soft_wrap=True)


@courses_commands.command("show")
def show(course: CourseIdArgument) -> None:
    """Show a course, its assignments and its learners."""
    found = changed(lambda it: roll.course(it, course))
    learners = changed(lambda it: roll.learners(it, course, datetime.now(UTC)))
    screen = stdout()
    screen.print(f"{visible(found.title)}, {found.zone}: {_counts(found)}", soft_wrap=True)
    for assignment in found.assignments:
        screen.print(f"  {assignment}", soft_wrap=True)
    _print_learners(learners)


def _counts(course: Course) -> str:
    learners = say_count("{count} learner", "{count} learners", count=course.learners)
    assignments = say_count(
        "{count} assignment", "{count} assignments", count=len(course.assignments)
    )
    return spoken(joined(", ", [learners, assignments]))


@courses_commands.command("change")
def courses_change(
    course: CourseIdArgument,
    title: Annotated[str | None, typer.Option(help="The title.", callback=encodable)] = None,
    zone: Annotated[str | None, typer.Option(help="The time zone.")] = None,
) -> None:
    """Change the title or the time zone of a course."""
    body = checked(CourseChange, title=title, zone=zone)
    changed(lambda it: roll.change_course(it, course, body))
    tell(say("Changed."))


@courses_commands.command("delete")
def courses_delete(
    course: CourseIdArgument, with_attempts: WithAttempts = False, yes: YesOption = False
) -> None:
    """Delete a course, and end its keys and links; with --with-attempts also its attempts."""
    deleted(
        say("the course {course}", course=visible(course)),
        lambda it, wanted: assignments.delete_course(it, course, wanted, datetime.now(UTC)),
        DeletionRequest(with_attempts=with_attempts),
        yes=yes,
    )


@_learners.command("list")
def list_learners(course: CourseIdArgument) -> None:
    """List the learners of a course, by name: id, name, e-mail address, and link."""
    _print_learners(changed(lambda it: roll.learners(it, course, datetime.now(UTC))))


def _print_learners(found: Iterable[CourseLearner]) -> None:
    for each in found:
        link = say("no link")
        if each.link_until:
            link = say("link until {day}", day=f"{each.link_until:%Y-%m-%d}")
        told = (each.learner, each.name, each.email or "", spoken(link))
        line = "  ".join(visible(text) for text in told if text)
        stdout().print(line, soft_wrap=True)


@_learners.command("remove")
def remove_learner(
    course: CourseIdArgument,
    learner: Annotated[str, typer.Argument(help="The learner's id.", callback=encodable)],
    with_attempts: WithAttempts = False,
    yes: YesOption = False,
) -> None:
    """Remove a learner from a course, and end the learner's links to it.

    Without --with-attempts the attempts stay, and count again if the learner comes back.
    """
    deleted(
        say(
            "the learner {learner} of the course {course}",
            learner=visible(learner),
            course=visible(course),
        ),
        lambda it, wanted: assignments.remove_learner(it, course, wanted, datetime.now(UTC)),
        checked(RemovalRequest, learner=learner, with_attempts=with_attempts),
        yes=yes,
    )


@_learners.command("import")
def import_learners(
    course: CourseIdArgument,
    file: Annotated[Path, typer.Argument(help="A CSV file, or - for standard input.")],
) -> None:
    """Add the learners of a class list, as Moodle or Canvas export it, or written by hand.

    The first line has the headings: name, and email or id. Nobody is removed.
    """
    try:
        data = sys.stdin.buffer.read() if str(file) == "-" else file.read_bytes()
        listed = read_class_list(decoded(data))
    except OSError as error:
        give_up(say("{file} cannot be read: {reason}", file=str(file), reason=str(error)))
    except CourseError as error:
        give_up(joined(": ", [str(file), str(error.args[0])]))
    count = changed(lambda it: roll.add_learners(it, course, listed))
    imported = say_count(
        "{count} learner, {added} of them new.",
        "{count} learners, {added} of them new.",
        count=len(listed),
        added=count,
    )
    tell(imported)


@courses_commands.command("links")
def links(
    course: CourseIdArgument,
    address: Annotated[
        str | None,
        typer.Option(
            help="The address of the service, such as https://grader.example.edu. "
            "\\[DH_GRADER_PUBLIC_URL]"
        ),
    ] = None,
    learner: LearnerOption = None,
    renew: Annotated[
        bool, typer.Option("--renew", help="Make new links, and end the old ones.")
    ] = False,
    revoke: Annotated[bool, typer.Option("--revoke", help="End the links; write none.")] = False,
    days: Annotated[
        int, typer.Option(min=1, max=LONGEST_LINK_DAYS, help="How long new links are valid.")
    ] = 200,
    output: Output = None,
) -> None:
    """Write a CSV file with the personal link of each learner, for a mail merge."""
    now = datetime.now(UTC)
    if revoke:
        count = changed(lambda it: revoke_links(it, course, learner, now))
        ended = say_count(
            "{count} link ended. Each running service knows it within seconds.",
            "{count} links ended. Each running service knows it within seconds.",
            count=count,
        )
        tell(ended)
        return
    settings = load_settings()
    secret = settings.known_secret()
    if secret is None:
        give_up(say("Personal links need a secret: set DH_GRADER_SECRET or DH_GRADER_SECRET_FILE."))
    address = address or settings.public_url or _LOCAL
    if address == _LOCAL:
        complain(
            say(
                "The links lead to {address}, which only this machine can open. Give the "
                "address of the service by DH_GRADER_PUBLIC_URL, or with --address https://….",
                address=_LOCAL,
            )
        )
    wanted = LinksRequest(learners=learner, renew=renew, days=days)
    found = changed(lambda it: issue_links(it, course, wanted, secret, address, now))
    write(written_links(found), output, at_once=True)


@courses_commands.command("gradebook")
def show_gradebook(
    course: CourseIdArgument,
    assignment: Annotated[str | None, typer.Option(help="Only this assignment.")] = None,
    form: Annotated[
        GradebookFormat,
        typer.Option("--format", help="csv, json, xlsx, or CSV that moodle or canvas imports."),
    ] = "csv",
    output: Output = None,
) -> None:
    """Write the points that count, of each learner at each exercise."""
    if form == "xlsx":
        if output is None and stdout().is_terminal:
            give_up(say("A workbook is not for the screen: give a file with --output."))
        workbook = changed(lambda it: gradebook_workbook(it, course, assignment))
        write([workbook], output, at_once=True)
        return
    book = changed(lambda it: gradebook(it, course, assignment))
    if form == "json":
        write([book.model_dump_json(indent=2).encode() + b"\n"], output, at_once=True)
    else:
        write(written_gradebook(book, form), output, at_once=True)


@courses_commands.command("missing")
def show_missing(
    course: CourseIdArgument,
    assignment: Annotated[str, typer.Argument(help="The id of an assignment.")],
) -> None:
    """List who has not handed in which exercises."""
    found = changed(lambda it: missing(it, course, assignment))
    screen, names = stdout(), told_apart(found)
    for each in found:
        told = ", ".join((*each.exercises, *map(spoken, ends(each))))
        screen.print(f"{visible(names[each.learner])}: {told}", soft_wrap=True)
    incomplete = say_count(
        "Not complete: {count} learner.", "Not complete: {count} learners.", count=len(found)
    )
    screen.print(spoken(incomplete))


# --- The lines that the command line prints about an assignment of a course


def assignment_lines(
    assignment: CourseAssignment, installed: Callable[[], Mapping[str, Exercise]]
) -> Iterator[Sentence]:
    """Yield the lines about an assignment. ``installed`` returns all exercises of the service."""
    total = number(sum(each.points for each in assignment.exercises))
    title = visible(assignment.title)
    yield say("{id}: {title}, {points} points", id=assignment.id, title=title, points=total)
    for each in assignment.exercises:
        points = number(each.points)
        yield say("{exercise}, {points} points", exercise=each.exercise, points=points)
    if assignment.opens is not None:
        yield say("opens {time}", time=_time(assignment.opens))
    yield from ends(assignment)
    late = _late(assignment)
    limit = say("attempts not limited")
    if assignment.limit is not None:
        limit = say("attempts at most {limit}", limit=assignment.limit)
    yield joined("; ", [limit, late])
    levels = ", ".join(FeedbackLevel(each).value for each in assignment.feedback or ())
    yield say("feedback {level}", level=levels or say("that of each exercise"))
    yield say(
        "practice {practice}; solution {solution}",
        practice=assignment.practice,
        solution=assignment.solution,
    )
    if assignment.hint_prices is not None:
        prices = ", ".join(f"{each:.0%}" for each in assignment.hint_prices)
        yield say("the steps of a hint cost {prices} of the points", prices=prices)
    if assignment.variants:
        yield say("each learner has variants of their own")
        catalogue = installed()
        names = [each.exercise for each in assignment.exercises]
        same = [name for name in names if name in catalogue and catalogue[name].vary is None]
        if same:
            yield say("but not in {exercises}: no variants there", exercises=", ".join(same))
    yield from _extension_lines(assignment)


def _late(assignment: CourseAssignment) -> Sentence:
    if not assignment.due:
        return say("no due date")
    if assignment.closes or any(each.closes for each in assignment.extensions):
        return say("late attempts earn {share}", share=f"{assignment.late_worth:.0%}")
    return say("no late attempts")


def _extension_lines(assignment: CourseAssignment) -> Iterator[Sentence]:
    for extension in assignment.extensions:
        told = [*ends(with_own_dates(assignment, extension))]
        if extension.limit:
            told.append(say("at most {limit} attempts", limit=extension.limit))
        # Without a due date, an extension of the closing date alone has no effect.
        if told:
            yield joined(": ", [visible(extension.learner), joined("; ", told)])


def ends(dates: CourseAssignment | Extension | MissingLearner) -> Iterator[Sentence]:
    """Yield lines that say when answers are due and when the assignment closes."""
    if dates.due is not None:
        yield say("due {time}", time=_time(dates.due))
    if dates.closes is not None:
        yield say("closes {time}", time=_time(dates.closes))


def _time(moment: datetime) -> str:
    return f"{moment:%Y-%m-%d %H:%M %Z}"


# --- Run a change in a transaction, and ask before a deletion


D = TypeVar("D", bound=DeletionRequest)
R = TypeVar("R")

# What a deletion counts, by the fields of DeletedData.
_COUNTS: Final[Mapping[str, str]] = {
    "assignments": template("assignments: {count}"),
    "learners": template("learners: {count}"),
    "extensions": template("extensions: {count}"),
    "keys": template("keys: {count}"),
    "attempts": template("attempts: {count}"),
}


def changed(work: Callable[[Connection], R], *, create: bool = False) -> R:
    """Run ``work`` in a transaction and return its result; exit on an error.

    With ``create``, a missing database is created.
    """
    with database(create=create) as engine:
        try:
            return in_transaction(engine, work)
        except CourseError as error:
            give_up(error)


def deleted(
    name: str, work: Callable[[Connection, D], DeletedData], wanted: D, *, yes: bool
) -> None:
    """Ask the user for confirmation, delete data with ``work``, and print what was deleted.

    ``name`` is the name of the data in messages. ``yes`` skips the question.
    """
    found = changed(lambda it: work(it, wanted))
    if not wanted.with_attempts:
        # They stay, or they prevent the deletion.
        found = found.model_copy(update={"attempts": 0})
    numbers = found.model_dump(exclude={"deleted"})
    counts = joined(
        ", ",
        [Sentence(_COUNTS[kind], {"count": count}) for kind, count in numbers.items() if count],
    )
    if not yes:
        question = say("Delete {name} permanently? {counts}", name=name, counts=counts)
        typer.confirm(spoken(question), abort=True)
    apply = wanted.model_copy(update={"apply": True})
    changed(lambda it: work(it, apply))
    tell(say("Deleted {name}: {counts}.", name=name, counts=counts))


# --- `dh-grader assignments`: check assignment files, each of which lists several exercises


assignments_commands = typer.Typer(
    help="Assignments of several exercises.", no_args_is_help=True, add_completion=False
)


@assignments_commands.callback()
def _group() -> None:
    """Make `check` a subcommand, although it is the only one."""


@assignments_commands.command("check")
def check(
    file: Annotated[Path, typer.Argument(metavar="FILE", show_default=False)],
    folder: Annotated[
        Path | None,
        typer.Argument(
            metavar="[FOLDER]",
            help="Submissions of a class: show which file answers which exercise.",
            show_default=False,
        ),
    ] = None,
) -> None:
    """Check an assignment file, and show its exercises. Nothing is graded.

    Exit code 2: the file, or an exercise file that it names, cannot be used.
    """
    assignment = load_assignment(file, installed_exercise)
    console = stdout()
    for line in _lines(assignment):
        console.print(line, soft_wrap=True)
    for handed in all_handed_in([folder], parts=assignment.part_names) if folder else ():
        for line in _found(handed, assignment):
            console.print(line, soft_wrap=True)


def _lines(assignment: Assignment) -> Iterator[Text]:
    exercises = assignment.exercises
    total = number(sum(each.worth for each in exercises))
    summary = say_count(
        "{count} exercise, {points} points, pass mark {mark}",
        "{count} exercises, {points} points, pass mark {mark}",
        count=len(exercises),
        points=total,
        mark=percent(assignment.pass_mark),
    )
    yield Text.assemble((visible(assignment.title), "bold"), f": {spoken(summary)}")
    if assignment.variants:
        yield Text("  " + spoken(say("each learner has variants of their own")))
    for each in exercises:
        parts = ", ".join(part.id for part in each.exercise.parts)
        worth = say("{points} points", points=number(each.worth))
        level = assignment.ceiling(each).value
        more = say("feedback {level}; files {files}", level=level, files=_files(each))
        yield Text.assemble(
            "  ", (each.exercise.id, "bold"), f", {spoken(worth)}: {parts}",
            (f"; {visible(spoken(more))}", "dim"),
        )  # fmt: skip


def _files(assigned: AssignedExercise) -> str:
    own = assigned.exercise.id
    named = assigned.files or (f"{own}.json", f"{own}/PART.csv", say("and the like"))
    of_parts = (
        say("{files} for {part}", files=", ".join(names), part=part)
        for part, names in assigned.part_files.items()
    )
    return joined(", ", [*of_parts, *named])


def _found(handed: HandedIn, assignment: Assignment) -> Iterator[Text]:
    yield Text(visible(handed.name), "bold")
    answered = zip(assignment.exercises, answers_in(handed, assignment), strict=True)
    for assigned, answers in answered:
        yield Text(f"  {assigned.exercise.id}: {visible(_answered(answers))}")


def _answered(answers: ExerciseAnswers) -> str:
    if answers.problem:
        return spoken(of_file(answers.file, answers.problem))
    if answers.body is None or not answers.body.answers:
        return spoken(say("missing"))
    parts = ", ".join(answers.body.answers)
    return spoken(say("{parts} from {file}", parts=parts, file=answers.file))
