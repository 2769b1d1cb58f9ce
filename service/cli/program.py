"""The commands put together."""

import sys
from typing import Annotated, Any

import typer
from typer.core import TyperGroup

from service.authoring import UnusableIdError
from service.catalogue import CatalogueError
from service.cli import exercises, grade, serve
from service.cli.interrupts import INTERRUPTED
from service.cli.terminal import complain, give_up
from service.kinds_check import check_kinds
from service.settings import SettingsError
from service.submissions.lookup import UnknownExerciseError
from service.version import VERSION


class _Commands(TyperGroup):
    """The commands; each ends with the reason where something that it was given is unusable."""

    def invoke(self, ctx: Any) -> Any:
        try:
            return super().invoke(ctx)
        except UnknownExerciseError as error:
            give_up(f"{error} Known are: {', '.join(error.known)}.")
        except (SettingsError, CatalogueError, UnusableIdError) as error:
            give_up(str(error))
        except KeyboardInterrupt:
            complain("Interrupted.")
            raise SystemExit(INTERRUPTED) from None


program = typer.Typer(
    cls=_Commands,
    name="dh-grader",
    help="Grades Denavit-Hartenberg tables, transforms and forward kinematics, and says why.",
    no_args_is_help=True,
    add_completion=False,
    pretty_exceptions_enable=False,
)
program.add_typer(exercises.commands, name="exercises")
program.command("grade")(grade.command)
program.command("serve")(serve.command)


def _show_version(wanted: bool) -> None:
    if wanted:
        typer.echo(f"dh-grader {VERSION}")
        raise typer.Exit


@program.callback()
def _options(
    show_version: Annotated[
        bool,
        typer.Option("--version", help="Show the version.", callback=_show_version, is_eager=True),
    ] = False,
) -> None:
    pass


def main() -> None:
    """Run the command line of this process."""
    check_kinds()
    # What a stream cannot show is replaced, not a reason to stop half-way through a report.
    for stream in (sys.stdout, sys.stderr):
        if hasattr(stream, "reconfigure"):
            stream.reconfigure(errors="replace")
    program(prog_name="dh-grader")
