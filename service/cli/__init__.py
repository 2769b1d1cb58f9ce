"""The command `dh-grader`."""

import gc


def main() -> None:
    """Run the command line of this process."""
    # What is loaded stays to the end: looking through it for garbage costs a tenth of a short run.
    gc.disable()
    try:
        # Only here, so that Ctrl-C while it is loaded shows no traceback either.
        from service.cli.program import run

        run()
    except KeyboardInterrupt:
        from service.cli.running.interrupts import INTERRUPTED

        raise SystemExit(INTERRUPTED) from None


__all__ = ["main"]
