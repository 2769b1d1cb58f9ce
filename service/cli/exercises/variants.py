"""`dh-grader exercises check --seeds` and `deploy`: many variants of one exercise."""

from collections import Counter, defaultdict
from collections.abc import Iterable, Mapping, Sequence
from dataclasses import asdict
from pathlib import Path
from typing import Annotated, Final

import typer
from rich.console import Console
from rich.table import Table
from rich.text import Text

from service.authoring import Level
from service.catalogue import Exercise, load_exercise
from service.cli.language import spoken
from service.cli.terminal import give_up, installed_file, stdout, unwritable
from service.figures.figure import exercise_figure
from service.translations import joined, say
from service.variants.deployment import (
    CheckedVariant,
    TooFewVariantsError,
    checked_variant,
    deploy,
    with_deployed,
)
from service.variants.variant import NoVariantError, built

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
                "{file}: cannot be edited here; write deployed = {seeds} below [vary]",
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
