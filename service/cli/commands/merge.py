"""`dh-grader merge`: combine results of a class that several machines have graded."""

import json
from collections.abc import Iterable, Iterator
from pathlib import Path
from typing import Annotated

import typer

from service.cli.files.output import write
from service.cli.files.written_files import require_no_input, require_own
from service.cli.running.shards import UnusableShardsError, merged
from service.cli.terminal import BELOW_PASS_MARK, UNUSABLE, give_up

commands = typer.Typer(add_completion=False)


@commands.command("merge")
def command(
    shards: Annotated[
        list[Path],
        typer.Argument(
            metavar="SHARD",
            show_default=False,
            help="The files of all shards, in any order.",
        ),
    ],
    output: Annotated[
        Path | None, typer.Option(metavar="F", help="Write to this file.", show_default=False)
    ] = None,
    force: Annotated[
        bool,
        typer.Option(
            "--force", help="Let --output replace an existing file that is no earlier report."
        ),
    ] = False,
) -> None:
    """Merge the shards that `grade --shard` has written into the JSON lines of one run.

    The lines and the exit code are the same as without --shard.
    """
    if output is not None:
        require_no_input(output, shards)
        require_own(output, [], force=force)
    run = _Run(merged(shards))
    try:
        write(run.lines(), output, at_once=True)
    except UnusableShardsError as error:
        give_up(error)
    raise SystemExit(run.exit_code)


class _Run:
    def __init__(self, lines: Iterable[bytes]) -> None:
        self._lines = lines
        self.exit_code = 0

    def lines(self) -> Iterator[bytes]:
        for line in self._lines:
            entry = json.loads(line)
            if "error" in entry:
                self.exit_code = UNUSABLE
            elif not entry["passed"]:
                self.exit_code = max(self.exit_code, BELOW_PASS_MARK)
            yield line
