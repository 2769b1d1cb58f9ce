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
from service.catalogue import Exercise, by_level
from service.catalogue.robots.robot import Robot
from service.cli.exercises import check, export_robot, import_robot, variants
from service.cli.exercises.new_file import write_new
from service.cli.terminal import give_up, installed, installed_file, named_exercise, stdout
from service.figures.drawing.style import Theme
from service.figures.figure import exercise_figure, reference_figure
from service.grading.kinds.find_slip import shown_shape
from service.solutions import ModelSolution, Shown, solve

_NARROWEST = 24

commands = typer.Typer(
    help="The catalogue of exercises.", no_args_is_help=True, add_completion=False
)


@commands.command("list")
def list_exercises() -> None:
    """List the exercises."""
    console = stdout()
    for line in _list(list(installed().values()), console.width):
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
    exercise = named_exercise(exercise_id)
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
    console.print(Text("Symbols", "bold"))
    symbols = Table.grid(padding=(0, 2, 0, 0))
    for variable in exercise.variables:
        symbols.add_row(variable.name, variable.unit, variable.description)
    console.print(Padding(symbols, (0, 0, 0, 2), expand=False))
    console.print()
    console.print(Text("Parts", "bold"))
    for part in exercise.parts:
        heading = f"{part.id}: {part.title} ({part.kind}, {part.points:g} points)"
        console.print(Padding(Text(heading), (0, 0, 0, 2), expand=False))
        answer = f"Answer: {shown_shape(part, exercise).in_words()}."
        for text in filter(None, (part.prompt, answer)):
            console.print(Padding(Text(text, "dim"), (0, 0, 0, 4), expand=False))


def _write_figure(exercise: Exercise, file: Path, theme: Theme, *, frames: bool) -> None:
    if exercise.reference is None:
        give_up(f"the exercise {exercise.id} has no robot to draw")
    if frames and not isinstance(exercise.reference, Robot):
        give_up(f"the robot of {exercise.id} is given by screw axes, without frames to draw")
    draw = reference_figure if frames else exercise_figure
    try:
        file.write_text(draw(exercise, theme), encoding="utf-8")
    except OSError as error:
        give_up(f"{file}: cannot be written: {error.strerror}")


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
        give_up(str(error))
    file = write_new(output, exercise_id, text)
    stdout().print(
        f"{file} is written. Edit it, then: dh-grader exercises check {file}", soft_wrap=True
    )


def _list(exercises: Sequence[Exercise], width: int) -> Iterator[Text]:
    """Yield each level, and the id, joints and title of its exercises, with the parts below."""
    ids = max(len(exercise.id) for exercise in exercises)
    joints = max(len("joints"), *(len(exercise.structure or "") for exercise in exercises))
    room = max(width - ids - joints - 4, _NARROWEST)
    yield Text(f"{'id':{ids}}  {'joints':{joints}}  title, and parts (points)", "dim")
    for heading, group in by_level(exercises):
        yield Text(heading, "bold")
        for exercise in group:
            yield from _lines(exercise, ids, joints, room)


def _lines(exercise: Exercise, ids: int, joints: int, room: int) -> Iterator[Text]:
    """Yield the lines of an exercise; ``ids`` and ``joints`` are the widths of the columns."""
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
    """Print the model answers, the link transforms and the pose."""
    solution = solve(exercise)
    links = not any(part.holds_links for part in exercise.parts)
    for heading, shown in _sections(solution, links=links):
        console.print(Text(heading, "bold"))
        # Do not wrap, so that it can be copied and pasted.
        console.print(Text(shown.latex if latex else shown.text), soft_wrap=True)
        console.print()
    if solution.notation:
        console.print(Text("Shorthand", "bold"))
        for name, meaning in solution.notation.items():
            console.print(Text(f"{name} = {meaning}"))


def _sections(solution: ModelSolution, *, links: bool) -> Iterator[tuple[str, Shown]]:
    for part in solution.parts:
        yield f"{part.part}: {part.title} ({part.kind})", part
    if links:
        yield from ((f"Link transform A{link.label}", link) for link in solution.links)
    answered = [part.text for part in solution.parts]
    if solution.pose is not None and solution.pose.text not in answered:
        yield "Pose of the tool in the base frame", solution.pose
