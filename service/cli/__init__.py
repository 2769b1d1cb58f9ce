"""The command `dh-grader`."""

from service.cli.program import main

__all__ = ["main"]
