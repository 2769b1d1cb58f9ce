"""A catalogue that follows its files while the service runs."""

import logging
import time
from collections.abc import Callable, ItemsView, Iterator, Mapping, Sequence, ValuesView
from pathlib import Path
from typing import Final

from service.catalogue.exercise import Exercise
from service.catalogue.files.toml_file import CatalogueError
from service.catalogue.load import exercise_files, load_catalogue, load_exercise

# The seconds between two looks at the disk.
REFRESH_SECONDS: Final = 1.0

Stamp = tuple[int, int, int]

_log = logging.getLogger(__name__)


def open_catalogue(folders: Sequence[Path], *, reload: bool) -> Mapping[str, Exercise]:
    """The exercises of these folders; with ``reload`` as their files are from now on.

    Raises CatalogueError: a service never starts with a file that is broken.
    """
    return LiveCatalogue(folders) if reload else load_catalogue(*folders)


class LiveCatalogue(Mapping[str, Exercise]):
    """The exercises by id, read again where a file has changed.

    A question looks at the files' times, at most once in ``REFRESH_SECONDS``, and reads the files
    that differ. A file that cannot be used keeps its last good version, and the log says why.
    """

    def __init__(
        self, folders: Sequence[Path], clock: Callable[[], float] = time.monotonic
    ) -> None:
        self._folders = tuple(folders)
        self._clock = clock
        self._stamps = _stamps(exercise_files(*self._folders))
        self._exercises: Mapping[str, Exercise] = load_catalogue(*self._folders)
        self._complaint = ""
        self._look_at = clock() + REFRESH_SECONDS

    def __getitem__(self, exercise_id: str) -> Exercise:
        return self._current()[exercise_id]

    def __iter__(self) -> Iterator[str]:
        return iter(self._current())

    def __len__(self) -> int:
        return len(self._current())

    # All exercises at one time: one by one, a file could vanish in between.
    def values(self) -> ValuesView[Exercise]:
        """The exercises as they are now."""
        return self._current().values()

    def items(self) -> ItemsView[str, Exercise]:
        """The exercises as they are now, with their ids."""
        return self._current().items()

    def _current(self) -> Mapping[str, Exercise]:
        now = self._clock()
        if now >= self._look_at:
            self._look_at = now + REFRESH_SECONDS
            self._follow()
        return self._exercises

    def _follow(self) -> None:
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
        self._stamps, self._exercises = stamps, found

    def _complain(self, complaint: str) -> None:
        """Log the fault of the folders, once as long as it lasts."""
        if complaint != self._complaint:
            _log.error("The exercises stay as they were:\n%s", complaint)
        self._complaint = complaint


def _stamps(files: Sequence[Path]) -> dict[Path, Stamp]:
    """The stamp of each file, which changes with it; none while the file is being replaced."""
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
