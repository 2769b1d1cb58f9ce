"""The commands put together."""

import gc
import os
import sys
from importlib import import_module
from typing import Annotated, Any, Final

import typer
from typer.core import TyperGroup

# Each is a file of ``commands/`` whose ``commands`` are loaded when the command is called: the help
# of the program needs neither the grader nor the web framework.
COMMANDS: Final = {
    "serve": "Start the service; the environment variables DH_GRADER_… set it up.",
    "exercises": "The catalogue of exercises.",
    "assignments": "Several exercises that are set together.",
    "grade": "Grade submissions: JSON, TOML, or the pasted answer to one part (csv, md, tex, m, "
    "py, …).",
    "attempts": "Recorded attempts: read, export, regrade, forget.",
    "keys": "Who may use the service, and for what: create, list, revoke keys.",
    "bundle": "Write the zip file that a grading platform takes.",
}


class _Commands(TyperGroup):
    """The commands; each ends with the reason where something that it was given is unusable."""

    def resolve_command(self, ctx: Any, args: list[str]) -> Any:
        name, _, rest = super().resolve_command(ctx, args)
        commands: typer.Typer = import_module(f"service.cli.commands.{name}").commands
        if not gc.isenabled():
            gc.freeze()
            gc.enable()
        return name, typer.main.get_command(commands), rest

    def invoke(self, ctx: Any) -> Any:
        # Only here, for the same reason.
        from service.catalogue import CatalogueError
        from service.cli.running.interrupts import INTERRUPTED
        from service.cli.terminal import BROKEN_PIPE, complain, give_up
        from service.kinds_check import check_kinds
        from service.settings import SettingsError
        from service.submissions.lookup import UnknownExerciseError

        check_kinds()
        try:
            return super().invoke(ctx)
        except UnknownExerciseError as error:
            give_up(f"{error} Known are: {', '.join(error.known)}.")
        except (SettingsError, CatalogueError) as error:
            give_up(str(error))
        except KeyboardInterrupt:
            complain("Interrupted.")
            raise SystemExit(INTERRUPTED) from None
        except BrokenPipeError:
            _forget_output()
            raise SystemExit(BROKEN_PIPE) from None


program = typer.Typer(
    cls=_Commands,
    name="dh-grader",
    help="Grades Denavit-Hartenberg tables, transforms and forward kinematics, and says why.",
    no_args_is_help=True,
    add_completion=False,
    pretty_exceptions_enable=False,
)


def _stand_in() -> None:
    """Stand in the program's help for a command that is not loaded."""


for _name, _line in COMMANDS.items():
    program.command(_name, help=_line)(_stand_in)


def _show_version(wanted: bool) -> None:
    if wanted:
        from service.version import VERSION

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


def _forget_output() -> None:
    """Drop what standard output still holds: Python would fail over it again at its end."""
    nowhere = os.open(os.devnull, os.O_WRONLY)
    os.dup2(nowhere, 1)
    os.close(nowhere)


def _open_closed_streams() -> None:
    """Let what is written to a stream that was closed before the start go nowhere."""
    for name in ("stdout", "stderr"):
        if getattr(sys, name) is None:
            setattr(sys, name, open(os.devnull, "w", encoding="utf-8"))  # noqa: SIM115, PTH123


def run() -> None:
    """Run the command line of this process."""
    _open_closed_streams()
    # What a stream cannot show is replaced, not a reason to stop half-way through a report.
    for stream in (sys.stdout, sys.stderr):
        if hasattr(stream, "reconfigure"):
            stream.reconfigure(errors="replace")
    try:
        program(prog_name="dh-grader")
    except OSError as error:  # of a full disk, or of a name that no file can have
        from service.cli.terminal import give_up

        _forget_output()
        give_up(f"{error.filename or 'The output'}: cannot be written: {error.strerror}")
