"""`dh-grader assignments`: check assignment files, each of which lists several exercises."""

from collections.abc import Iterator
from pathlib import Path
from typing import Annotated

import typer
from rich.text import Text

from service.cli.language import spoken
from service.cli.terminal import installed_exercise, stdout
from service.formats.shared.plain_text import number, percent, visible
from service.submissions.answers import ExerciseAnswers, answers_in, of_file
from service.submissions.assignment import AssignedExercise, Assignment, load_assignment
from service.submissions.handed_in import HandedIn, all_handed_in
from service.translations import joined, say, say_count

commands = typer.Typer(
    help="Assignments of several exercises.", no_args_is_help=True, add_completion=False
)


@commands.callback()
def _group() -> None:
    """Make `check` a subcommand, although it is the only one."""


@commands.command("check")
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
