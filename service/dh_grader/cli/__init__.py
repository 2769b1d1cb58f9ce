"""The command `dh-grader`, which imports the file of a command when it is called.

It knows the names of the commands, their one line of help, and where they are.
"""

import gc
import os
import sys
from pkgutil import resolve_name
from typing import Annotated, Any, Final

import typer
from typer.core import TyperGroup

from dh_grader.cli.terminal import spoken, translate_help
from dh_grader.translations import paragraph, say

# The help of each command. The help of the program needs neither the grader nor the web framework.
COMMANDS: Final = {
    "serve": "Start the service. Configure it by environment variables DH_GRADER_….",
    "exercises": "The catalogue of exercises.",
    "assignments": "Assignments of several exercises.",
    "grade": "Grade submissions: JSON, TOML, or the pasted answer to one part (csv, md, tex, m, "
    "py, …).",
    "merge": "Merge the shards that `grade --shard` has written into the JSON lines of one run.",
    "attempts": "Recorded attempts: read, export, regrade, forget.",
    "courses": "Courses: learners, links, assignments, gradebook.",
    "lti": "LTI 1.3: platforms that launch courses, and the keys for them.",
    "keys": "API keys of the service: create, list, revoke.",
    "learners": "Learners: export all that is known of one.",
    "backup": "Copy the database to a file, also while the service runs.",
    "restore": "Put a backup in the place of the database, while no service runs.",
    "doctor": "Check this installation, and say how to mend it. Nothing is changed.",
    "bundle": "Write a zip file for a grading platform.",
}
# Where each command is. It is imported when it is called.
PLACES: Final = {
    "serve": "dh_grader.cli.operate:serve_commands",
    "exercises": "dh_grader.cli.exercises:exercises_commands",
    "assignments": "dh_grader.cli.courses:assignments_commands",
    "grade": "dh_grader.cli.grade:grade_commands",
    "merge": "dh_grader.cli.grade:merge_commands",
    "attempts": "dh_grader.cli.attempts:attempts_commands",
    "courses": "dh_grader.cli.courses:courses_commands",
    "lti": "dh_grader.cli.lti:lti_commands",
    "keys": "dh_grader.cli.operate:keys_commands",
    "learners": "dh_grader.cli.attempts:learners_commands",
    "backup": "dh_grader.cli.attempts:backup_commands",
    "restore": "dh_grader.cli.attempts:restore_commands",
    "doctor": "dh_grader.cli.operate:doctor_commands",
    "bundle": "dh_grader.cli.exercises:bundle_commands",
}


def commands_of(name: str | None) -> typer.Typer:
    """Import the file of a command and return its typer application."""
    found: typer.Typer = resolve_name(PLACES[name or ""])
    return found


class _Commands(TyperGroup):
    def main(self, *args: Any, **extra: Any) -> Any:
        translate_help(self)
        return super().main(*args, **extra)

    def resolve_command(self, ctx: Any, args: list[str]) -> Any:
        name, _, rest = super().resolve_command(ctx, args)
        commands = commands_of(name)
        if not gc.isenabled():
            gc.freeze()
            gc.enable()
        return name, translate_help(typer.main.get_command(commands)), rest

    def invoke(self, ctx: Any) -> Any:
        # Import here: the help of the program needs none of this.
        from dh_grader.catalogue import CatalogueError
        from dh_grader.cli.terminal import BROKEN_PIPE, INTERRUPTED, complain, give_up
        from dh_grader.settings import SettingsError
        from dh_grader.submissions.bodies import UnknownExerciseError

        try:
            return super().invoke(ctx)
        except UnknownExerciseError as error:
            known = say("Known are: {names}.", names=", ".join(error.known))
            give_up(paragraph(error.args[0], known))
        except (SettingsError, CatalogueError) as error:
            give_up(error)
        except KeyboardInterrupt:
            complain(say("Interrupted."))
            raise SystemExit(INTERRUPTED) from None
        except BrokenPipeError:
            _discard_output()
            raise SystemExit(BROKEN_PIPE) from None


program = typer.Typer(
    cls=_Commands,
    name="dh-grader",
    help="Grades Denavit-Hartenberg tables, transforms and forward kinematics, and says why.",
    no_args_is_help=True,
    pretty_exceptions_enable=False,
)


def _placeholder() -> None:
    """Do nothing. The help of the program lists this function in place of a command."""


for _name, _line in COMMANDS.items():
    program.command(_name, help=_line)(_placeholder)


def _show_version(wanted: bool) -> None:
    if wanted:
        from dh_grader import VERSION

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


def _discard_output() -> None:
    # Otherwise Python would fail again when it flushes standard output at exit.
    nowhere = os.open(os.devnull, os.O_WRONLY)
    os.dup2(nowhere, 1)
    os.close(nowhere)


def _open_closed_streams() -> None:
    for name in ("stdout", "stderr"):
        if getattr(sys, name) is None:
            setattr(sys, name, open(os.devnull, "w", encoding="utf-8"))  # noqa: SIM115, PTH123


def run() -> None:
    """Run the program, and exit with a message if a stream or a file cannot be written."""
    _open_closed_streams()
    # Replace characters that a stream cannot encode instead of failing within a report.
    for stream in (sys.stdout, sys.stderr):
        if hasattr(stream, "reconfigure"):
            stream.reconfigure(errors="replace")
    try:
        program(prog_name="dh-grader")
    except OSError as error:  # of a full disk, or of a name that no file can have
        from dh_grader.cli.terminal import give_up, unwritable

        _discard_output()
        give_up(unwritable(error.filename or spoken(say("The output")), error))


def main() -> None:
    """Run the program; Ctrl-C shows no traceback."""
    # Loaded modules stay to the end: searching them for garbage takes a tenth of a short run.
    gc.disable()
    try:
        run()
    except KeyboardInterrupt:
        from dh_grader.cli.terminal import INTERRUPTED

        raise SystemExit(INTERRUPTED) from None


__all__ = ["main"]
