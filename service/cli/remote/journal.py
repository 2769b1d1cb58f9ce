"""The journal of reports from a server, with which an interrupted run can continue.

Each line is a JSON object with a report, and the digest of its submission and options.
"""

import hashlib
import json
from collections.abc import Sequence
from pathlib import Path
from threading import Lock
from typing import Final

from service.cli.terminal import complain
from service.formats.documents.json import read_report, rendered
from service.grading import Report
from service.regex import regex
from service.translations import say

_LINE: Final = regex(rb'\{"digest": "([0-9a-f]{64})", "report": (\{.*\})\}\n')
# The name of a journal without an output file.
_DEFAULT_NAME: Final = "dh-grader"


def journal_beside(output: Path | None) -> Path:
    """Return the path of the journal of a run that writes to ``output``."""
    # The name begins with a dot, so that no run takes the journal for a submission.
    if output is None or (output.exists() and not (output.is_file() or output.is_dir())):
        return Path(f".{_DEFAULT_NAME}.graded")
    named = output.resolve() if output.name in ("", "..") else output
    return named.with_name(f".{named.name}.graded")


def digest(content: Sequence[object]) -> str:
    """Return the SHA-256 digest of the JSON text of ``content``."""
    return hashlib.sha256(json.dumps(content).encode()).hexdigest()


class Journal:
    """Reads the reports of earlier runs from a file, and appends the reports of this run."""

    # Several threads may use one journal. If the file cannot be written, a warning is printed and
    # the run continues.

    def __init__(self, path: Path) -> None:
        self.path = path
        self._lock = Lock()
        self._places = dict(_places(path))
        self._is_writable = True

    def report(self, of: str) -> Report | None:
        """Return the report that an earlier run wrote for this digest, or None."""
        if of not in self._places:
            return None
        try:
            with self.path.open("rb") as file:
                file.seek(self._places[of])
                found = _LINE.fullmatch(file.readline())
            return read_report(found[2]) if found else None
        except (OSError, ValueError):
            return None

    def add(self, of: str, report: Report) -> None:
        """Append a report and its digest to the journal."""
        # Begin with a line break: the last line may be incomplete.
        line = b'\n{"digest": "%b", "report": %b}\n' % (of.encode(), rendered(report))
        with self._lock:
            if not self._is_writable:
                return
            try:
                with self.path.open("ab") as file:
                    file.write(line)
            except OSError as error:
                self._is_writable = False
                complain(
                    say(
                        "{file}: cannot be written: {reason}. If this run is interrupted, the next "
                        "one sends every submission again.",
                        file=str(self.path),
                        reason=str(error.strerror),
                    )
                )

    def remove(self) -> None:
        """Delete the journal."""
        self.path.unlink(missing_ok=True)


def _places(path: Path) -> list[tuple[str, int]]:
    # Return the digests, and the offsets of their lines; other lines are ignored.
    found = []
    try:
        with path.open("rb") as file:
            place = 0
            for line in file:
                if match := _LINE.fullmatch(line):
                    found.append((match[1].decode(), place))
                place += len(line)
    except OSError:
        return []
    return found
