"""The reports that a server gave to a run which broke off, so that the next asks for the rest.

Lines of JSON, each with a report and the digest of what it is the report on.
"""

import hashlib
import json
import re
from collections.abc import Sequence
from pathlib import Path
from threading import Lock
from typing import Final

from service.cli.terminal import complain
from service.formats.documents.json import read_report, rendered
from service.grading import Report

_LINE: Final = re.compile(rb'\{"digest": "([0-9a-f]{64})", "report": (\{.*\})\}\n')
# Where there is no file that it could stand beside.
_USUAL: Final = "dh-grader"


def journal_beside(output: Path | None) -> Path:
    """The place of the journal of a run with this output.

    Its name begins with a dot, so that it is no submission in a folder of them.
    """
    if output is None or (output.exists() and not (output.is_file() or output.is_dir())):
        return Path(f".{_USUAL}.graded")
    named = output.resolve() if output.name in ("", "..") else output
    return named.with_name(f".{named.name}.graded")


def digest(content: Sequence[object]) -> str:
    """The digest of JSON content, which no other content has."""
    return hashlib.sha256(json.dumps(content).encode()).hexdigest()


class Journal:
    """The reports of earlier runs, which stay in the file, and those of this one, added to it.

    Several threads may use it. Where the file cannot be written the run goes on, and says so.
    """

    def __init__(self, path: Path) -> None:
        self.path = path
        self._lock = Lock()
        self._places = dict(_places(path))
        self._is_kept = True

    def report(self, of: str) -> Report | None:
        """The report that an earlier run was given on what has this digest, or None."""
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
        """Keep a report for the next run."""
        # A line of its own, even after one that was broken off.
        line = b'\n{"digest": "%b", "report": %b}\n' % (of.encode(), rendered(report))
        with self._lock:
            if not self._is_kept:
                return
            try:
                with self.path.open("ab") as file:
                    file.write(line)
            except OSError as error:
                self._is_kept = False
                complain(
                    f"{self.path}: cannot be written: {error.strerror}. If the run breaks off, the "
                    "next one begins anew."
                )

    def remove(self) -> None:
        """Forget everything: nothing is left to be graded."""
        self.path.unlink(missing_ok=True)


def _places(path: Path) -> list[tuple[str, int]]:
    """The digests in a journal, each with the place of its line; what is no such line is passed."""
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
