"""Drafts (exercises that are still being written) for the preview in the editor."""

import os
import secrets
import shutil
import time
import weakref
from collections.abc import Callable, Iterator, Mapping
from pathlib import Path
from typing import Final

from service.catalogue.exercise import Exercise
from service.catalogue.files.temporary import temporary_place
from service.catalogue.load import read_exercise
from service.regex import regex

MOST_DRAFTS: Final = 32
# Seconds since a draft was last written.
KEPT: Final = 3600.0
_ID: Final = regex(r"draft-[0-9a-f]{32}")


def drafts_folder() -> Path:
    """Return a new path for a folder of drafts. The folder does not exist yet."""
    return temporary_place() / f"dh-grader-drafts-{secrets.token_hex(16)}"


class Drafts:
    """The drafts (unfinished exercises) in a folder. Several processes may share the folder.

    Without ``folder``, the drafts are in a temporary folder, which is removed at the end.
    """

    def __init__(self, folder: Path | None = None, clock: Callable[[], float] = time.time) -> None:
        self._folder = folder or drafts_folder()
        if folder is None:
            weakref.finalize(self, shutil.rmtree, self._folder, ignore_errors=True)
        self._clock = clock
        # The exercises that this process has read, each with the time at which it was written.
        self._read: dict[str, tuple[int, Exercise]] = {}

    def put(self, text: str, draft_id: str = "") -> str:
        """Store a draft and return its id. ``draft_id`` is the id of a draft to replace.

        Raises CatalogueError if the text is no exercise.
        """
        if self._written(draft_id) is None:
            draft_id = f"draft-{secrets.token_hex(16)}"
        file = self._file(draft_id)
        read_exercise(file, text)
        self._folder.mkdir(mode=0o700, exist_ok=True)
        # Another process never finds half a file.
        new = file.with_suffix(f".{secrets.token_hex(8)}")
        new.write_bytes(text.encode())
        now = self._clock()
        os.utime(new, (now, now))
        new.replace(file)
        self._drop_oldest()
        return draft_id

    def get(self, draft_id: str) -> Exercise | None:
        """Return a draft, or None if it is unknown or too old."""
        written = self._written(draft_id)
        if written is None:
            self._read.pop(draft_id, None)
            return None
        known = self._read.get(draft_id)
        if known is not None and known[0] == written:
            return known[1]
        file = self._file(draft_id)
        try:
            exercise = read_exercise(file, file.read_bytes().decode())
        except OSError:
            # Another process has dropped it just now.
            return None
        while len(self._read) >= MOST_DRAFTS:
            self._read.pop(next(iter(self._read)))
        self._read[draft_id] = written, exercise
        return exercise

    def _written(self, draft_id: str) -> int | None:
        if not _ID.fullmatch(draft_id):
            return None
        try:
            written = self._file(draft_id).stat().st_mtime_ns
        except OSError:
            return None
        return written if self._clock() < written / 1e9 + KEPT else None

    def _file(self, draft_id: str) -> Path:
        return self._folder / f"{draft_id}.toml"

    def _drop_oldest(self) -> None:
        files = sorted(self._folder.glob("*.toml"), key=_age)
        for file in files[:-MOST_DRAFTS]:
            file.unlink(missing_ok=True)


def _age(file: Path) -> int:
    try:
        return file.stat().st_mtime_ns
    except OSError:
        return 0


class CatalogueWithDrafts(Mapping[str, Exercise]):
    """A catalogue that also finds drafts (unfinished exercises) by id, but does not list them."""

    def __init__(self, catalogue: Mapping[str, Exercise], drafts: Drafts) -> None:
        self._catalogue = catalogue
        self._drafts = drafts

    def __getitem__(self, exercise_id: str) -> Exercise:
        draft = self._drafts.get(exercise_id)
        return self._catalogue[exercise_id] if draft is None else draft

    def __iter__(self) -> Iterator[str]:
        return iter(self._catalogue)

    def __len__(self) -> int:
        return len(self._catalogue)
