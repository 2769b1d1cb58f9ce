"""The command `dh-grader`."""

import gc


def main() -> None:
    """Run the command-line program."""
    # Loaded modules stay to the end: searching them for garbage takes a tenth of a short run.
    gc.disable()
    try:
        # Import here, so that Ctrl-C during the import shows no traceback.
        from service.cli.program import run

        run()
    except KeyboardInterrupt:
        from service.cli.running.interrupts import INTERRUPTED

        raise SystemExit(INTERRUPTED) from None


__all__ = ["main"]
