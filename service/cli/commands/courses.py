"""`dh-grader courses`: courses with learners, links, assignments and a gradebook."""

import sys
from collections.abc import Iterable
from datetime import UTC, datetime
from pathlib import Path
from typing import Annotated, Final

import typer

from service.cli.commands import course_assignments
from service.cli.commands.attempts import encodable
from service.cli.commands.course_assignments import (
    WithAttempts,
    YesOption,
    checked,
)
from service.cli.files.output import write
from service.cli.language import spoken
from service.cli.operations.assignment_lines import ends
from service.cli.operations.course_changes import changed, deleted
from service.cli.terminal import complain, give_up, stdout, tell
from service.contract.courses import (
    LONGEST_LINK_DAYS,
    Course,
    CourseChange,
    CourseLearner,
    DeletionRequest,
    GradebookFormat,
    LinksRequest,
    NewCourse,
    RemovalRequest,
)
from service.courses import deletion, roll
from service.courses.class_list import decoded, read_class_list
from service.courses.errors import CourseError
from service.courses.links import issue_links, revoke_links, written_links
from service.courses.names import told_apart
from service.courses.results.gradebook import gradebook, missing, written_gradebook
from service.courses.results.workbook import gradebook_workbook
from service.formats.shared.plain_text import visible
from service.settings import load_settings
from service.translations import joined, say, say_count

commands = typer.Typer(
    help="Courses: learners, links, assignments, gradebook.",
    no_args_is_help=True,
    add_completion=False,
)
_learners = typer.Typer(help="The learners of a course.", no_args_is_help=True)
commands.add_typer(_learners, name="learners")
commands.add_typer(course_assignments.commands, name="assignments")

CourseIdArgument = Annotated[
    str, typer.Argument(help="The id of a course.", show_default=False, callback=encodable)
]
Output = Annotated[Path | None, typer.Option(help="The file to write.")]
# The address of a service that was started without settings.
_LOCAL: Final = "http://127.0.0.1:8000"
LearnerOption = Annotated[
    list[str] | None, typer.Option("--learner", help="Only this learner. Repeatable. \\[all]")
]


@commands.command("new")
def new(
    course: CourseIdArgument,
    title: Annotated[str, typer.Option(help="The title.", callback=encodable)],
    zone: Annotated[str, typer.Option(help="The time zone, such as Europe/Berlin.")],
) -> None:
    """Create a course. Its id has small letters, digits and hyphens."""
    body = checked(NewCourse, id=course, title=title, zone=zone)
    changed(lambda it: roll.add_course(it, body, datetime.now(UTC)), create=True)
    tell(say("The course {course} is there.", course=course))


@commands.command("list")
def list_courses() -> None:
    """List the courses."""
    for each in changed(roll.all_courses):
        stdout().print(f"{each.id}  {visible(each.title)}  {_counts(each)}", soft_wrap=True)


@commands.command("show")
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


@commands.command("change")
def change(
    course: CourseIdArgument,
    title: Annotated[str | None, typer.Option(help="The title.", callback=encodable)] = None,
    zone: Annotated[str | None, typer.Option(help="The time zone.")] = None,
) -> None:
    """Change the title or the time zone of a course."""
    body = checked(CourseChange, title=title, zone=zone)
    changed(lambda it: roll.change_course(it, course, body))
    tell(say("Changed."))


@commands.command("delete")
def delete(
    course: CourseIdArgument, with_attempts: WithAttempts = False, yes: YesOption = False
) -> None:
    """Delete a course, and end its keys and links; with --with-attempts also its attempts."""
    deleted(
        say("the course {course}", course=visible(course)),
        lambda it, wanted: deletion.delete_course(it, course, wanted, datetime.now(UTC)),
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
        lambda it, wanted: deletion.remove_learner(it, course, wanted, datetime.now(UTC)),
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
        give_up(say("{file}: cannot be read: {reason}", file=str(file), reason=str(error)))
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


@commands.command("links")
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


@commands.command("gradebook")
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


@commands.command("missing")
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
