"""`dh-grader exercises` and `bundle`: list, check, import, export, deploy and pack exercises.

What a check finds is in ``dh_grader.authoring``, what a bundle holds in ``dh_grader.bundles``; this
file knows options and lines of output.
"""

import os
import sys
import textwrap
from collections import Counter, defaultdict
from collections.abc import Iterable, Iterator, Mapping, Sequence
from dataclasses import asdict
from enum import StrEnum
from pathlib import Path
from secrets import token_hex
from typing import Annotated, Final

import click
import numpy as np
import typer
from rich.console import Console
from rich.padding import Padding
from rich.table import Table
from rich.text import Text

from dh_grader.authoring import Level, Remark, UnusableIdError, examine, exercise_template, summary
from dh_grader.bundles import BUNDLES, BundleError, content_of, zipped
from dh_grader.catalogue import (
    CatalogueError,
    Exercise,
    by_level,
    exercise_files,
    in_language,
    is_exercise_id,
    load_exercise,
    shipped_folder,
)
from dh_grader.catalogue.files import line_of, read_regular, value_lines, with_line
from dh_grader.catalogue.robot import Robot
from dh_grader.cli.grade import chosen_assignment, write
from dh_grader.cli.options import installed, installed_exercise, installed_file, named_exercise
from dh_grader.cli.terminal import (
    UNUSABLE,
    complain,
    give_up,
    spoken,
    stdout,
    unreadable,
    unwritable,
    user_language,
)
from dh_grader.figures import exercise_figure, reference_figure
from dh_grader.figures.drawing import Theme
from dh_grader.figures.mechanism import drawing_numbers
from dh_grader.grading.kinds.tables import shown_shape
from dh_grader.importing import (
    ImportedRobot,
    ImportOptions,
    RefusedRobotError,
    SeveralTipsError,
    imported_table,
    imported_urdf,
)
from dh_grader.importing.exercise_text import HomeRobot, toolbox_text, urdf_text
from dh_grader.importing.pasted_robot import Question
from dh_grader.importing.urdf import MOST_BYTES
from dh_grader.kinematics import Convention
from dh_grader.regex import regex
from dh_grader.settings import load_settings
from dh_grader.solutions import ModelSolution, Shown, solve
from dh_grader.translations import joined, say, say_count
from dh_grader.variants import NoVariantError, built
from dh_grader.variants.deployment import (
    CheckedVariant,
    TooFewVariantsError,
    checked_variant,
    deploy,
    with_deployed,
)

# --- `dh-grader exercises import`: a robot from a URDF file or a pasted table -> an exercise file


def import_robot_command(
    file: Annotated[Path, typer.Argument(help="A URDF file, or with --table a DH table.")],
    exercise_id: Annotated[
        str, typer.Option("--id", metavar="ID", help="The id of the exercise: its file's name.")
    ] = "",
    tip: Annotated[str, typer.Option(metavar="LINK", help="The link of the tool.")] = "",
    base: Annotated[
        str, typer.Option(metavar="LINK", help="The first link. Default: the root of the file.")
    ] = "",
    table: Annotated[
        bool, typer.Option("--table", help="The file has a DH table, as students paste it.")
    ] = False,
    letters: Annotated[
        bool, typer.Option("--letters", help="Write letters for the lengths instead of numbers.")
    ] = False,
    convention: Annotated[
        Convention | None,
        typer.Option(
            help="The convention of the exercise and of a table. Default: as the table says, or "
            "standard.",
            show_default=False,
        ),
    ] = None,
    order: Annotated[
        str,
        typer.Option(
            metavar="COLUMNS",
            help='The order of the columns of a table without headers, such as "a alpha d theta".',
        ),
    ] = "",
    unit: Annotated[
        str,
        typer.Option(
            metavar="UNIT",
            help="The unit of lengths in a table without units: m, cm, mm, in or ft.",
        ),
    ] = "",
    degrees: Annotated[
        bool | None,
        typer.Option(
            "--degrees/--radians",
            help="The unit of angles in a table without units.",
            show_default=False,
        ),
    ] = None,
    title: Annotated[str, typer.Option(help="The title of the exercise.")] = "",
    source: Annotated[str, typer.Option(help="Where the robot comes from.")] = "",
    output: Annotated[
        Path, typer.Option(metavar="FOLDER", help="The folder; created if missing.")
    ] = Path(),
) -> None:
    """Make an exercise from a robot's URDF file, or from a DH table.

    Prints each number that was rounded, and the largest difference between the exercise and the
    file at 100 random poses. Refuses more than 1 mm for a URDF file, and more than 1e-9 for a
    table. Asks for what a table does not say.
    """
    name = exercise_id or file.stem
    try:
        exercise_template(name)
        data = read_regular(file, MOST_BYTES)
    except UnusableIdError as error:
        give_up(error)
    except OSError as error:
        give_up(unreadable(file, error))
    if not data:
        give_up(say("{file}: the file is empty", file=str(file)))
    options = ImportOptions(
        title=title or name,
        source=source or f"Imported from {file.name}",
        convention=convention,
        base=base,
        tip=tip,
        letters=letters,
        order=order,
        unit=unit,
        angles="" if degrees is None else "degrees" if degrees else "radians",
    )
    try:
        if table:
            found = _imported_table(file, data.decode("utf-8", errors="replace"), options)
        else:
            found = imported_urdf(data, options)
    except SeveralTipsError as error:
        give_up(say("{file}: {reason}. Use --tip LINK.", file=str(file), reason=error.args[0]))
    except RefusedRobotError as error:
        give_up(joined(": ", [str(file), str(error.args[0])]))
    made = write_new(output, name, found.text)
    for remark in found.remarks:
        stdout().print(spoken(remark), soft_wrap=True)
    written = say(
        "{file} is written. Read its statement, then: dh-grader exercises check {file}",
        file=str(made),
    )
    stdout().print(spoken(written), soft_wrap=True)


def _imported_table(file: Path, text: str, options: ImportOptions) -> ImportedRobot:
    """Return the robot of a table. Asks on a terminal for what the table does not say."""
    found = imported_table(text, options)
    while found.questions:
        if not is_terminal():
            asked = [
                say(
                    "{file}: {question} Use one of these options: {options}.",
                    file=str(file),
                    question=question.text,
                    options=", ".join(_option(question.name, each) for each in question.usual),
                )
                for question in found.questions
            ]
            give_up(joined("\n", asked))
        options = options.with_answers({each.name: _answer(each) for each in found.questions})
        found = imported_table(text, options)
    return found


def is_terminal() -> bool:
    """True if a person can answer at the terminal."""
    return sys.stdin.isatty()


def _option(name: str, choice: str) -> str:
    """Return the option that answers a question.

    >>> _option("angles", "degrees"), _option("order", "a alpha d theta")
    ('--degrees', '--order "a alpha d theta"')
    """
    if name == "angles":
        return f"--{choice}"
    return f'--{name} "{choice}"' if " " in choice else f"--{name} {choice}"


def _answer(question: Question) -> str:
    text = f"{spoken(question.text)} ({', '.join(question.usual)})"
    choices = click.Choice(question.choices)
    return str(typer.prompt(text, type=choices, show_choices=False))


# --- `dh-grader exercises export`: the robot of an exercise as URDF or as a script


class ExportFormat(StrEnum):
    """The format of an exported robot: a URDF file, or a script for the Robotics Toolbox."""

    URDF = "urdf"
    TOOLBOX = "toolbox"


def export_robot_command(
    exercise_id: Annotated[str, typer.Argument(metavar="ID|FILE", show_default=False)],
    target: Annotated[
        ExportFormat,
        typer.Option("--format", help="A URDF file, or a script for the Robotics Toolbox."),
    ] = ExportFormat.URDF,
) -> None:
    """Print the robot of an exercise as URDF, or as a Python script for the Robotics Toolbox.

    Letters get the lengths with which the robot is drawn.
    """
    exercise = named_exercise(exercise_id)
    robot = exercise.reference
    if not isinstance(robot, Robot):
        give_up(say("the exercise {id} has no robot with a DH table", id=exercise.id))
    table = robot.tables.get(Convention.STANDARD)
    if table is None:
        give_up(say("the robot of {id} has no standard DH table", id=exercise.id))
    numbers = drawing_numbers(exercise.variables)
    numbers |= {joint.variable: 0.0 for joint in robot.joints}
    values = table.values({name: np.array([number]) for name, number in numbers.items()}, 1)
    at_home = HomeRobot(values[:, :, 0], robot.structure, {})
    write = urdf_text if target is ExportFormat.URDF else toolbox_text
    stdout().print(write(at_home, exercise.id), soft_wrap=True, end="")


# --- `dh-grader exercises check`: find faults in exercise files


FAILED = 1

STYLES = {Level.FAILED: "red", Level.WARNING: "yellow"}


def check_command(
    path: Annotated[
        Path | None,
        typer.Argument(help="A file, a folder or an id; by default the whole catalogue."),
    ] = None,
    strict: Annotated[bool, typer.Option("--strict", help="Let warnings fail as well.")] = False,
    seeds: Annotated[
        int | None,
        typer.Option(min=1, max=10_000, help="Check this many variants of one exercise."),
    ] = None,
) -> None:
    """Check exercise files: their fields, model answers and own checks; warn of likely mistakes.

    Exit code 0: every file can be used and passes, with or without warnings.

    Exit code 1: a check failed, or there is a warning and --strict is given.

    Exit code 2: a file cannot be used; the other files are still checked.
    """
    console = stdout()
    if path is not None and not path.exists() and is_exercise_id(str(path)):
        path = installed_file(str(path))
    if seeds is not None:
        if path is None or path.is_dir():
            give_up(say("--seeds is for one exercise: name its file or its id."))
        raise SystemExit(FAILED if check_seeds(load_exercise(path), seeds, console) else 0)
    if path is None:
        files = exercise_files(*load_settings().exercises_dir)
    else:
        files = exercise_files(path) if path.is_dir() else [path]
    levels = [_check(file, console) for file in files]
    unusable = levels.count(None)
    found = Counter(level for remarked in levels for level in remarked or ())
    if len(files) > 1:
        console.print(Text(_summary(len(files), unusable, found), "bold"))
    if unusable:
        raise SystemExit(UNUSABLE)
    raise SystemExit(FAILED if found[Level.FAILED] or (strict and found[Level.WARNING]) else 0)


def _check(file: Path, console: Console) -> set[Level] | None:
    try:
        exercise = load_exercise(file)
    except CatalogueError as error:
        complain(error)
        return None
    remarks = examine(exercise)
    for line in _check_lines(exercise, remarks, file):
        # Do not wrap long lines: other programs read this, too.
        console.print(line, soft_wrap=True)
    return {remark.level for remark in remarks}


def _check_lines(exercise: Exercise, remarks: list[Remark], file: Path) -> Iterator[Text]:
    failed = any(remark.level is Level.FAILED for remark in remarks)
    verdict = (spoken(say("ok")), "green")
    if failed:
        verdict = (spoken(say("failed")), STYLES[Level.FAILED])
    yield Text.assemble((exercise.id, "bold"), ": ", verdict, f", {spoken(summary(exercise))}")
    lines = value_lines(file.read_text(encoding="utf-8")) if remarks else {}
    for remark in remarks:
        place = with_line(remark.field, line_of(remark.field, lines))
        told = spoken(joined(": ", [place, remark.text]))
        level = say("failed") if remark.level is Level.FAILED else say("warning")
        yield Text.assemble("  ", (spoken(level), STYLES[remark.level]), f": {told}")


def _summary(files: int, unusable: int, found: Counter[Level]) -> str:
    failed = found[Level.FAILED]
    warned = found[Level.WARNING]
    ok = say_count(
        "{count} exercise: {ok} ok",
        "{count} exercises: {ok} ok",
        count=files,
        ok=files - unusable - failed,
    )
    others = [
        say("{number} failed", number=failed) if failed else "",
        say("{number} cannot be used", number=unusable) if unusable else "",
        say("{number} with warnings", number=warned) if warned else "",
    ]
    return spoken(joined(", ", [ok, *filter(None, others)]))


# --- `dh-grader exercises check --seeds` and `deploy`: many variants of one exercise


# The most faults that are printed, each with the first seed that has it.
_SHOWN = 10
# Variants are of about equal difficulty if their scores differ by at most this share.
_SPREAD = 0.2
# The rows of the table, by the fields of VariantDifficulty.
_ROWS: Final[Mapping[str, str]] = {
    "joints": say("joints"),
    "sliding": say("sliding"),
    "turns": say("turns"),
    "odd_twists": say("odd twists"),
    "lengths": say("lengths"),
    "free": say("free"),
}


def check_seeds(exercise: Exercise, count: int, console: Console) -> bool:
    """Check ``count`` variants and print how they differ; return True if a variant fails."""
    try:
        checked = [checked_variant(exercise, str(seed)) for seed in range(1, count + 1)]
    except NoVariantError as error:
        give_up(error)
    faults: dict[str, list[str]] = defaultdict(list)
    for each in checked:
        for remark in each.remarks:
            if remark.level is Level.FAILED:
                faults[joined(": ", [remark.field, remark.text])].append(each.seed)
    different = len({each.form for each in checked})
    scores = Counter(each.difficulty.score for each in checked)
    found = spoken(say("{count} seeds, {different} different", count=count, different=different))
    console.print(Text.assemble((exercise.plain_id, "bold"), f": {found}"), soft_wrap=True)
    console.print(_table(checked))
    low, high = min(scores), max(scores)
    if high - low > _SPREAD * high:
        _warn(
            console,
            say(
                "the scores differ from {low} to {high}; deploy chooses variants of one difficulty",
                low=str(low),
                high=str(high),
            ),
        )
    warned = sum(any(r.level is Level.WARNING for r in each.remarks) for each in checked)
    if warned:
        _warn(
            console,
            say(
                "{warned} of {count} variants give much for an answer of only zeros and joint "
                "variables",
                warned=warned,
                count=count,
            ),
        )
    for fault, seeds in list(faults.items())[:_SHOWN]:
        line = say(
            "{count} variants, such as {variant}: {fault}",
            count=len(seeds),
            variant=f"{exercise.plain_id}~{seeds[0]}",
            fault=fault,
        )
        told = spoken(say("failed: {fault}", fault=line))
        console.print(Text(f"  {told}", "red"), soft_wrap=True)
    return bool(faults)


def _warn(console: Console, warning: str) -> None:
    console.print(Text("  " + spoken(say("warning: {warning}", warning=warning)), "yellow"))


def _table(checked: Sequence[CheckedVariant]) -> Table:
    table = Table.grid(padding=(0, 2, 0, 2))
    rows: dict[str, list[float]] = defaultdict(list)
    for each in checked:
        for name, number in asdict(each.difficulty).items():
            rows[_ROWS[name]].append(number)
        rows[say("score")].append(each.difficulty.score)
        rows[say("lazy points")].append(round(each.lazy, 2))
    heads = (say("least"), say("greatest"), say("the usual one"))
    table.add_row("", *map(spoken, heads), style="dim")
    for name, numbers in rows.items():
        usual, times = Counter(numbers).most_common(1)[0]
        share = say(
            "{usual} ({times} of {count})", usual=f"{usual:g}", times=times, count=len(numbers)
        )
        table.add_row(spoken(name), f"{min(numbers):g}", f"{max(numbers):g}", spoken(share))
    return table


def deploy_command(
    exercise_id: Annotated[str, typer.Argument(metavar="ID", show_default=False)],
    count: Annotated[
        int, typer.Option(min=1, max=500, help="The number of variants to deploy.")
    ] = 24,
    without: Annotated[
        list[str] | None, typer.Option(help="A seed to strike out. Repeatable.")
    ] = None,
    figures: Annotated[
        Path | None, typer.Option(metavar="DIR", help="Draw the variants into this folder.")
    ] = None,
    only_print: Annotated[
        bool, typer.Option("--print", help="Print the seeds, and leave the file as it is.")
    ] = False,
) -> None:
    r"""Choose the variants of which each learner gets one: different, and equally hard.

    Their seeds are written into the file, as \[vary] deployed. Seeds that are there already stay.
    """
    file = installed_file(exercise_id) if not Path(exercise_id).is_file() else Path(exercise_id)
    exercise = load_exercise(file)
    if exercise.vary is None:
        give_up(say("The exercise {id} has no variants: its file has no [vary].", id=exercise.id))
    try:
        seeds = deploy(exercise, count, without or ())
        checked = [checked_variant(exercise, seed) for seed in seeds]
    except (TooFewVariantsError, NoVariantError) as error:
        give_up(error)
    console = stdout()
    for each in checked:
        faults = [remark.text for remark in each.remarks if remark.level is Level.FAILED]
        told = [each.title, *(say("failed: {fault}", fault=fault) for fault in faults)]
        console.print(f"{exercise.id}~{each.seed}: {'; '.join(map(spoken, told))}", soft_wrap=True)
    console.print(_table(checked))
    if figures is not None:
        _draw(exercise, seeds, figures)
    if only_print:
        return
    text = with_deployed(file.read_text(encoding="utf-8"), seeds)
    if text is None:
        give_up(
            say(
                "{file} cannot be edited here; write deployed = {seeds} below [vary]",
                file=str(file),
                seeds=str(seeds),
            )
        )
    try:
        file.write_text(text, encoding="utf-8")
    except OSError as error:
        give_up(unwritable(file, error))
    written = say("{file}: deployed = {count} seeds", file=str(file), count=len(seeds))
    console.print(spoken(written), soft_wrap=True)


def _draw(exercise: Exercise, seeds: Iterable[str], folder: Path) -> None:
    if exercise.reference is None:
        give_up(say("the exercise {id} has no robot to draw", id=exercise.id))
    try:
        folder.mkdir(parents=True, exist_ok=True)
        for seed in seeds:
            variant = built(exercise, seed)
            (folder / f"{variant.id}.svg").write_text(exercise_figure(variant), encoding="utf-8")
    except OSError as error:
        give_up(unwritable(folder, error))


# --- `dh-grader exercises`: all its commands; list, show and new


_NARROWEST = 24

exercises_commands = typer.Typer(
    help="The catalogue of exercises.", no_args_is_help=True, add_completion=False
)


@exercises_commands.command("list")
def list_exercises() -> None:
    """List the exercises."""
    console = stdout()
    language = user_language()
    exercises = [in_language(each, language) for each in installed().values()]
    for line in _list(exercises, console.width):
        console.print(line, soft_wrap=True)


@exercises_commands.command("show")
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


exercises_commands.command("check")(check_command)
exercises_commands.command("deploy")(deploy_command)
exercises_commands.command("import")(import_robot_command)
exercises_commands.command("export")(export_robot_command)


@exercises_commands.command("new")
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
        text = exercise_template(exercise_id, None if like is None else installed_file(like))
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
            yield from _exercises_lines(exercise, ids, joints, room)


def _exercises_lines(exercise: Exercise, ids: int, joints: int, room: int) -> Iterator[Text]:
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


# --- Write new exercise files without replacing existing ones


def write_new(folder: Path, exercise_id: str, text: str) -> Path:
    """Write the file of a new exercise and return its path; exit if the file exists."""
    file = folder / f"{exercise_id}.toml"
    try:
        folder.mkdir(parents=True, exist_ok=True)
        with file.open("x", encoding="utf-8") as new:
            new.write(text)
    except FileExistsError:
        give_up(
            say(
                "{file} already exists and was not changed; choose another id or folder",
                file=str(file),
            )
        )
    except OSError as error:
        give_up(unwritable(file, error))
    return file


def warn_of_unread(exercises: Iterable[str]) -> None:
    """Warn that a running service may not have read these new exercises yet."""
    shipped = shipped_folder()
    own = [each for each in exercises if not (shipped / f"{each}.toml").is_file()]
    if own and not load_settings().reload_exercises:
        complain(
            say(
                "{ids}: if the file is new, restart the service. It reads new files only "
                "when it starts, or at once with DH_GRADER_RELOAD_EXERCISES=true.",
                ids=", ".join(own),
            )
        )


# --- `dh-grader bundle`: write a zip file for a grading platform


_SECRET: Final = regex(r"[0-9a-f]{64}")

bundle_commands = typer.Typer(
    help="Write a zip file for a grading platform.",
    no_args_is_help=True,
    add_completion=False,
)

_Exercise = Annotated[
    str | None,
    typer.Option(
        metavar="ID|FILE",
        help="The exercise to grade: its id, or an exercise file (….toml).",
        show_default=False,
    ),
]
_Assignment = Annotated[
    Path | None, typer.Option(metavar="F", help="An assignment file with several exercises.")
]
_Output = Annotated[
    Path, typer.Option(metavar="F", help="The zip file to write.", show_default=False)
]
_Secret = Annotated[
    Path | None,
    typer.Option(
        metavar="F",
        help="The file with the secret of the students' variants; a new one is written if it is "
        "missing. Keep it: with another secret, students get other variants.",
    ),
]


@bundle_commands.command("gradescope")
def gradescope(
    output: _Output,
    exercise: _Exercise = None,
    assignment: _Assignment = None,
    secret: _Secret = None,
) -> None:
    """Write an autograder to upload to Gradescope under "Configure Autograder"."""
    _write("gradescope", output, exercise, assignment, secret_file=secret)


@bundle_commands.command("prairielearn")
def prairielearn(
    output: _Output,
    image: Annotated[
        str,
        typer.Option(
            metavar="NAME",
            help="The name of the grader's image in your registry.",
            show_default=False,
        ),
    ],
    exercise: _Exercise = None,
    assignment: _Assignment = None,
    secret: _Secret = None,
) -> None:
    """Write a folder `image`, which builds the grader, and a folder `question` for a course."""
    _write("prairielearn", output, exercise, assignment, image, secret)


@bundle_commands.command("ci")
def ci(output: _Output, exercise: _Exercise = None, assignment: _Assignment = None) -> None:
    """Write a folder with the grader for CI jobs of GitHub, GitLab and others."""
    _write("ci", output, exercise, assignment)


def _write(
    platform: str,
    output: Path,
    exercise: str | None,
    file: Path | None,
    image: str = "",
    secret_file: Path | None = None,
) -> None:
    chosen = chosen_assignment(exercise, file, None, installed_exercise)
    catalogue = {found.stem: found for found in exercise_files(*load_settings().exercises_dir)}
    has_secret = chosen.variants and platform != "ci"
    secret = _secret(secret_file) if has_secret else ""
    try:
        content = content_of(chosen, file, catalogue, image, secret)
        files = BUNDLES[platform](content)
    except (BundleError, NoVariantError) as error:
        give_up(error)
    write([zipped(files)], output, at_once=True)


def _secret(file: Path | None) -> str:
    if file is None:
        give_up(
            say(
                "The assignment has variants: name a file for their secret, --secret F. It is "
                "written if it is missing; keep it, or students get other variants with the next "
                "bundle."
            )
        )
    try:
        # Nobody else may read it.
        descriptor = os.open(file, os.O_WRONLY | os.O_CREAT | os.O_EXCL, 0o600)
        with os.fdopen(descriptor, "w", encoding="utf-8") as opened:
            opened.write(f"{token_hex(32)}\n")
    except FileExistsError:
        pass
    except OSError as error:
        give_up(unwritable(file, error))
    try:
        found = file.read_text(encoding="utf-8").strip()
    except (OSError, ValueError):
        found = ""
    if not _SECRET.fullmatch(found):
        give_up(
            say("{file}: contains no secret; name another file, and it is written.", file=str(file))
        )
    return found
