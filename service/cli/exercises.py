"""`dh-grader exercises`: the catalogue, its solutions, and the making of more exercises."""

import textwrap
from collections.abc import Iterator, Sequence
from typing import Annotated

import typer
from rich.padding import Padding
from rich.table import Table
from rich.text import Text

from service.catalogue import Exercise
from service.cli import check, new
from service.cli.solution import write_solution
from service.cli.terminal import catalogue_or_exit, exercise_or_exit, stdout

commands = typer.Typer(help="The catalogue of exercises.", no_args_is_help=True)


@commands.command("list")
def list_exercises() -> None:
    """List the exercises."""
    exercises = catalogue_or_exit().values()
    console = stdout()
    for line in _list(list(exercises), console.width):
        console.print(line, soft_wrap=True)


@commands.command("show")
def show_exercise(
    exercise_id: Annotated[str, typer.Argument(metavar="ID", show_default=False)],
    solution: Annotated[
        bool, typer.Option("--solution", help="Show the model solution instead.")
    ] = False,
    latex: Annotated[
        bool, typer.Option("--latex", help="Show the model solution in LaTeX.")
    ] = False,
) -> None:
    """Show one exercise: its statement, symbols and parts. No answer, unless it is asked for."""
    exercise = exercise_or_exit(exercise_id)
    console = stdout()
    if solution or latex:
        write_solution(exercise, console, latex=latex)
        return
    console.print(Text(exercise.title, "bold"))
    name = ", ".join(filter(None, (exercise.id, exercise.structure)))
    console.print(Text(f"{name}. {exercise.source}", "dim"))
    console.print()
    console.print(Text(_paragraphs(exercise.statement)))
    console.print()
    console.print(Text("Symbols", "bold"))
    console.print(Padding(_symbols(exercise), (0, 0, 0, 2), expand=False))
    console.print()
    console.print(Text("Parts", "bold"))
    for part in exercise.parts:
        heading = f"{part.id}: {part.title} ({part.kind}, {part.points:g} points)"
        console.print(Padding(Text(heading), (0, 0, 0, 2), expand=False))
        for text in filter(
            None, (part.prompt, f"Answer: {part.shape(exercise.reference).in_words()}.")
        ):
            console.print(Padding(Text(text, "dim"), (0, 0, 0, 4), expand=False))


def _list(exercises: Sequence[Exercise], width: int) -> Iterator[Text]:
    """Each exercise's id, joints and title, and its parts below the title."""
    ids = max(len(exercise.id) for exercise in exercises)
    joints = max(len("joints"), *(len(exercise.structure or "") for exercise in exercises))
    indent = " " * (ids + joints + 4)
    room = max(width - len(indent), _NARROWEST)
    yield Text(f"{'id':{ids}}  {'joints':{joints}}  title, and parts (points)", "dim")
    for exercise in exercises:
        first, *more = textwrap.wrap(exercise.title, room)
        yield Text(f"{exercise.id:{ids}}  {exercise.structure or '':{joints}}  {first}")
        # A part and its points stay together: their blank is none that a line may break at.
        parts = ", ".join(
            f"{part.id}\N{NO-BREAK SPACE}({part.points:g})" for part in exercise.parts
        )
        below = textwrap.wrap(parts, room, break_on_hyphens=False)
        yield from (Text(indent + line) for line in more)
        yield from (Text(indent + line.replace("\N{NO-BREAK SPACE}", " "), "dim") for line in below)


_NARROWEST = 24


def _paragraphs(statement: str) -> str:
    """The statement with its line breaks left to the terminal."""
    return "\n\n".join(" ".join(block.split()) for block in statement.split("\n\n"))


def _symbols(exercise: Exercise) -> Table:
    table = Table.grid(padding=(0, 2, 0, 0))
    for variable in exercise.variables:
        table.add_row(variable.name, variable.unit, variable.description)
    return table


commands.command("check")(check.command)
commands.command("new")(new.command)
