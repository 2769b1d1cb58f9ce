"""Catalogues of a running service: of the files as they were, or as they are now."""

import logging
import time
from collections.abc import Callable, ItemsView, Iterator, Mapping, Sequence, ValuesView
from pathlib import Path
from typing import Final

from service.catalogue.exercise import Exercise
from service.catalogue.files.toml_file import CatalogueError, Fault
from service.catalogue.load import (
    checked_digests,
    digest_of,
    exercise_content,
    exercise_files,
    exercise_in,
    load_catalogue,
    load_exercise,
)
from service.catalogue.order import in_order

# The time between two checks of the files (seconds).
REFRESH_SECONDS: Final = 1.0

Stamp = tuple[int, int, int]

_log = logging.getLogger(__name__)


def open_catalogue(folders: Sequence[Path], *, reload: bool) -> Mapping[str, Exercise]:
    """Return the exercises of these folders. With ``reload``, changed files are read again.

    Raises CatalogueError for a faulty file.
    """
    return LiveCatalogue(folders) if reload else LateCatalogue(folders)


class LateCatalogue(Mapping[str, Exercise]):
    """The exercises by id, as their files were at the start.

    Files that the tests of the program have checked are compiled when they are first used, or when
    all exercises are listed. All others are compiled at once; CatalogueError has their faults.
    """

    def __init__(self, folders: Sequence[Path]) -> None:
        checked = checked_digests()
        self._compiled: dict[str, Exercise] = {}
        self._waiting: dict[str, tuple[Path, bytes]] = {}
        faults: list[Fault] = []
        files = exercise_files(*folders)
        for file in files:
            try:
                content = exercise_content(file)
                if checked.get(file.stem) == digest_of(content):
                    self._waiting[file.stem] = file, content
                else:
                    self._compiled[file.stem] = exercise_in(file, content)
            except CatalogueError as error:
                faults.extend(error.faults)
        if faults:
            raise CatalogueError(faults)
        self._ids = [file.stem for file in files]
        # All exercises, once they are compiled.
        self._in_order: Mapping[str, Exercise] = {}

    def __getitem__(self, exercise_id: str) -> Exercise:
        waiting = self._waiting.get(exercise_id)
        if waiting is not None and exercise_id not in self._compiled:
            # If two threads come at once, both get the first one's exercise.
            self._compiled.setdefault(exercise_id, exercise_in(*waiting))
            self._waiting.pop(exercise_id, None)
        return self._compiled[exercise_id]

    def __iter__(self) -> Iterator[str]:
        if not self._in_order:
            self._in_order = in_order(self[exercise_id] for exercise_id in self._ids)
        return iter(self._in_order)

    def __len__(self) -> int:
        return len(self._ids)

    def compile_one_by_one(self) -> Iterator[Exercise]:
        """Compile the exercises that were not used yet, one at each step."""
        for exercise_id in list(self._waiting):
            yield self[exercise_id]


class LiveCatalogue(Mapping[str, Exercise]):
    """The exercises by id; changed files are read again.

    If a changed file is faulty, the last usable version stays.
    """

    def __init__(
        self, folders: Sequence[Path], clock: Callable[[], float] = time.monotonic
    ) -> None:
        self._folders = tuple(folders)
        self._clock = clock
        self._stamps = _stamps(exercise_files(*self._folders))
        self._exercises: Mapping[str, Exercise] = load_catalogue(*self._folders)
        self._complaint = ""
        self._next_check = clock() + REFRESH_SECONDS

    def __getitem__(self, exercise_id: str) -> Exercise:
        return self._current()[exercise_id]

    def __iter__(self) -> Iterator[str]:
        return iter(self._current())

    def __len__(self) -> int:
        return len(self._current())

    # All exercises of one moment: in the default implementation, a file could vanish in between.
    def values(self) -> ValuesView[Exercise]:
        """The current exercises."""
        return self._current().values()

    def items(self) -> ItemsView[str, Exercise]:
        """The current exercises with their ids."""
        return self._current().items()

    def _current(self) -> Mapping[str, Exercise]:
        now = self._clock()
        if now >= self._next_check:
            self._next_check = now + REFRESH_SECONDS
            self._refresh()
        return self._exercises

    def _refresh(self) -> None:
        try:
            stamps = _stamps(exercise_files(*self._folders))
        except CatalogueError as error:
            self._complain(str(error))
            return
        self._complaint = ""
        if stamps == self._stamps:
            return
        found: dict[str, Exercise] = {}
        for file, stamp in stamps.items():
            exercise = self._exercises.get(file.stem)
            if stamp != self._stamps.get(file):
                exercise = _reread(file, exercise)
            if exercise is not None:
                found[file.stem] = exercise
        self._stamps, self._exercises = stamps, in_order(found.values())

    def _complain(self, complaint: str) -> None:
        if complaint != self._complaint:
            _log.error("The exercises stay as they were:\n%s", complaint)
        self._complaint = complaint


def _stamps(files: Sequence[Path]) -> dict[Path, Stamp]:
    stamps = {}
    for file in files:
        try:
            status = file.stat()
        except OSError:
            continue
        stamps[file] = (status.st_mtime_ns, status.st_size, status.st_ino)
    return stamps


def _reread(file: Path, last_good: Exercise | None) -> Exercise | None:
    try:
        return load_exercise(file)
    except CatalogueError as error:
        stays = "its last good version stays" if last_good else "it is left out"
        _log.error("%s cannot be used, so %s:\n%s", file.name, stays, error)
        return last_good
