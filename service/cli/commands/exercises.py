"""`dh-grader exercises`: list, show, check and create exercises."""

import textwrap
from collections.abc import Iterator, Sequence
from pathlib import Path
from typing import Annotated

import typer
from rich.console import Console
from rich.padding import Padding
from rich.table import Table
from rich.text import Text

from service.authoring import UnusableIdError, template
from service.catalogue import Exercise, by_level, in_language
from service.catalogue.robots.robot import Robot
from service.cli.exercises import check, export_robot, import_robot, variants
from service.cli.exercises.new_file import write_new
from service.cli.language import spoken, user_language
from service.cli.terminal import (
    give_up,
    installed,
    installed_file,
    named_exercise,
    stdout,
    unwritable,
)
from service.figures.drawing.style import Theme
from service.figures.figure import exercise_figure, reference_figure
from service.grading.kinds.find_slip import shown_shape
from service.solutions import ModelSolution, Shown, solve
from service.translations import say

_NARROWEST = 24

commands = typer.Typer(
    help="The catalogue of exercises.", no_args_is_help=True, add_completion=False
)


@commands.command("list")
def list_exercises() -> None:
    """List the exercises."""
    console = stdout()
    language = user_language()
    exercises = [in_language(each, language) for each in installed().values()]
    for line in _list(exercises, console.width):
        console.print(line, soft_wrap=True)


@commands.command("show")
def show_exercise(
    exercise_id: Annotated[str, typer.Argument(metavar="ID|FILE", show_default=False)],
    solution: Annotated[
        bool, typer.Option("--solution", help="Show the model solution instead.")
    ] = False,
    latex: Annotated[
        bool, typer.Option("--latex", help="Show the model solution in LaTeX.")
    ] = False,
    figure: Annotated[
        Path | None,
        typer.Option(metavar="FILE", help="Write a drawing of the robot (SVG) instead."),
    ] = None,
    theme: Annotated[
        Theme, typer.Option(help="Colours of the drawing; auto follows the reader's system.")
    ] = Theme.AUTO,
    frames: Annotated[
        bool, typer.Option("--frames", help="Draw the frames of the reference table, too.")
    ] = False,
) -> None:
    """Show an exercise: its statement, symbols and parts, or its solution."""
    exercise = in_language(named_exercise(exercise_id), user_language())
    console = stdout()
    if figure is not None:
        _write_figure(exercise, figure, theme, frames=frames)
        return
    if solution or latex:
        _write_solution(exercise, console, latex=latex)
        return
    console.print(Text(exercise.title, "bold"))
    name = ", ".join(filter(None, (exercise.id, exercise.structure, *exercise.conventions)))
    console.print(Text(f"{name}. {exercise.source}", "dim"))
    # Line breaks within a paragraph are left to the terminal.
    paragraphs = (" ".join(block.split()) for block in exercise.statement.split("\n\n"))
    console.print(Text("\n" + "\n\n".join(paragraphs) + "\n"))
    console.print(Text(spoken(say("Symbols")), "bold"))
    symbols = Table.grid(padding=(0, 2, 0, 0))
    for variable in exercise.variables:
        symbols.add_row(variable.name, variable.unit, variable.description)
    console.print(Padding(symbols, (0, 0, 0, 2), expand=False))
    console.print()
    console.print(Text(spoken(say("Parts")), "bold"))
    for part in exercise.parts:
        points = spoken(say("{points} points", points=f"{part.points:g}"))
        heading = f"{part.id}: {part.title} ({part.kind}, {points})"
        console.print(Padding(Text(heading), (0, 0, 0, 2), expand=False))
        answer = spoken(say("Answer: {shape}.", shape=shown_shape(part, exercise).in_words()))
        for text in filter(None, (part.prompt, answer)):
            console.print(Padding(Text(text, "dim"), (0, 0, 0, 4), expand=False))


def _write_figure(exercise: Exercise, file: Path, theme: Theme, *, frames: bool) -> None:
    if exercise.reference is None:
        give_up(say("the exercise {id} has no robot to draw", id=exercise.id))
    if frames and not isinstance(exercise.reference, Robot):
        give_up(
            say("the robot of {id} is given by screw axes, without frames to draw", id=exercise.id)
        )
    draw = reference_figure if frames else exercise_figure
    try:
        file.write_text(draw(exercise, theme), encoding="utf-8")
    except OSError as error:
        give_up(unwritable(file, error))


commands.command("check")(check.command)
commands.command("deploy")(variants.deploy_command)
commands.command("import")(import_robot.command)
commands.command("export")(export_robot.command)


@commands.command("new")
def new_exercise(
    exercise_id: Annotated[
        str, typer.Argument(metavar="ID", help="The name of the file.", show_default=False)
    ],
    output: Annotated[
        Path, typer.Option(metavar="FOLDER", help="The folder; created if missing.")
    ] = Path(),
    like: Annotated[
        str | None,
        typer.Option(metavar="ID", help="Start from a copy of this exercise."),
    ] = None,
) -> None:
    """Write a commented exercise file to start from. It passes `exercises check` as it is."""
    try:
        text = template(exercise_id, None if like is None else installed_file(like))
    except UnusableIdError as error:
        give_up(error)
    file = write_new(output, exercise_id, text)
    written = say(
        "{file} is written. Edit it, then: dh-grader exercises check {file}", file=str(file)
    )
    stdout().print(spoken(written), soft_wrap=True)


def _list(exercises: Sequence[Exercise], width: int) -> Iterator[Text]:
    ids = max(len(exercise.id) for exercise in exercises)
    heading = spoken(say("joints"))
    joints = max(len(heading), *(len(exercise.structure or "") for exercise in exercises))
    room = max(width - ids - joints - 4, _NARROWEST)
    columns = spoken(say("title, and parts (points)"))
    yield Text(f"{'id':{ids}}  {heading:{joints}}  {columns}", "dim")
    for level, group in by_level(exercises):
        yield Text(spoken(level), "bold")
        for exercise in group:
            yield from _lines(exercise, ids, joints, room)


def _lines(exercise: Exercise, ids: int, joints: int, room: int) -> Iterator[Text]:
    indent = " " * (ids + joints + 4)
    about = [*exercise.conventions, *([f"{exercise.minutes} min"] if exercise.minutes else [])]
    first, *more = textwrap.wrap(", ".join([exercise.title, *about]), room)
    yield Text(f"{exercise.id:{ids}}  {exercise.structure or '':{joints}}  {first}")
    # A no-break space keeps a part and its points on one line.
    parts = ", ".join(f"{part.id}\N{NO-BREAK SPACE}({part.points:g})" for part in exercise.parts)
    below = textwrap.wrap(parts, room, break_on_hyphens=False)
    yield from (Text(indent + line) for line in more)
    yield from (Text(indent + line.replace("\N{NO-BREAK SPACE}", " "), "dim") for line in below)


def _write_solution(exercise: Exercise, console: Console, *, latex: bool) -> None:
    solution = solve(exercise)
    links = not any(part.holds_links for part in exercise.parts)
    for heading, shown in _sections(solution, links=links):
        console.print(Text(heading, "bold"))
        # Do not wrap, so that it can be copied and pasted.
        console.print(Text(shown.latex if latex else shown.text), soft_wrap=True)
        console.print()
    if solution.notation:
        console.print(Text(spoken(say("Shorthand")), "bold"))
        for name, meaning in solution.notation.items():
            console.print(Text(f"{name} = {meaning}"))


def _sections(solution: ModelSolution, *, links: bool) -> Iterator[tuple[str, Shown]]:
    for part in solution.parts:
        yield f"{part.part}: {part.title} ({part.kind})", part
    if links:
        yield from (
            (spoken(say("Link transform {name}", name=f"A{link.label}")), link)
            for link in solution.links
        )
    answered = [part.text for part in solution.parts]
    if solution.pose is not None and solution.pose.text not in answered:
        yield spoken(say("Pose of the tool in the base frame")), solution.pose
