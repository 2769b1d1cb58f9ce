"""Load exercise files from folders: once, again after a change, as variants, and as drafts.

What a file may contain is in ``schema.py``; how a fault is reported is in ``files.py``.
"""

import hashlib
import json
import logging
import os
import re
import secrets
import shutil
import time
import weakref
from collections.abc import Callable, ItemsView, Iterable, Iterator, Mapping, Sequence, ValuesView
from dataclasses import replace
from functools import partial
from itertools import groupby
from pathlib import Path
from typing import Any, Final

from dh_grader.catalogue.exercise import Exercise, compile_exercise
from dh_grader.catalogue.files import (
    CatalogueError,
    Fault,
    built_of,
    exercise_table,
    fault_reason,
    read_toml,
    temporary_place,
    toml_content,
)
from dh_grader.catalogue.schema import ExerciseSpec
from dh_grader.catalogue.schema_fields import IDENTIFIER, ExerciseLevel
from dh_grader.catalogue.varying import Vary
from dh_grader.regex import regex
from dh_grader.translations import say

# --- Catalogues of a running service: of the files as they were, or as they are now


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


# --- Load exercise files from folders


ID_ADVICE = say("write small letters and digits, with - or _ between them, such as elbow-arm")
_LONGEST_ID = 60
# Among the exercises that come with the program: the digests of the files that the tests have
# checked, by the ids of the exercises.
CHECKED: Final = "checked.json"


def shipped_folder() -> Path:
    """Return the folder of the exercises that come with the program."""
    package = Path(__file__).parents[1]
    # In a wheel, the folder is inside the package; in a checkout, at the top.
    packaged = package / "_exercises"
    return packaged if packaged.is_dir() else package.parents[1] / "exercises"


def exercise_files(*folders: Path) -> list[Path]:
    """Return the exercise files of folders, sorted by name in each folder.

    Raises CatalogueError if there are no files, or if two files have the same name.
    """
    files: dict[str, Path] = {}
    faults: list[Fault] = []
    for folder in dict.fromkeys(folders):
        try:
            found = sorted(file for file in folder.iterdir() if file.match("*.toml"))
        except OSError as error:
            faults.append(Fault(folder, "", _folder_reason(error)))
            continue
        for file in found:
            if files.setdefault(file.stem, file) is not file:
                reason = say(
                    "has the name of {file}; give it another, for it is the id", file=str(file)
                )
                faults.append(Fault(files[file.stem], "", reason))
    # One of several folders may be empty: its first exercise is still to be written.
    if not files and not faults:
        faults = [Fault(each, "", say("holds no exercise file (*.toml)")) for each in folders]
    if faults:
        raise CatalogueError(faults)
    return list(files.values())


def checked_digests() -> Mapping[str, str]:
    """Return the digests of the exercise files that the tests of the program have checked."""
    try:
        found: dict[str, str] = json.loads((shipped_folder() / CHECKED).read_bytes())
    except FileNotFoundError:
        return {}
    return found


def digest_of(content: bytes) -> str:
    """Return the digest of an exercise file, whatever its line ends are."""
    return hashlib.blake2b(content.replace(b"\r\n", b"\n"), digest_size=16).hexdigest()


def load_catalogue(*folders: Path) -> dict[str, Exercise]:
    """Load all exercises of the folders, by id. Raises CatalogueError with all faults."""
    exercises: dict[str, Exercise] = {}
    faults: list[Fault] = []
    for file in exercise_files(*folders):
        try:
            exercises[file.stem] = load_exercise(file)
        except CatalogueError as error:
            faults.extend(error.faults)
    if faults:
        raise CatalogueError(faults)
    return in_order(exercises.values())


def is_exercise_id(name: str) -> bool:
    """True if ``name`` can be an exercise's id (its file name without .toml)."""
    return re.fullmatch(IDENTIFIER, name) is not None and len(name) <= _LONGEST_ID


def load_exercise(file: Path) -> Exercise:
    """Load the exercise of a file; its id is the file's name. Raises CatalogueError."""
    return exercise_in(file, exercise_content(file))


def exercise_content(file: Path) -> bytes:
    """Return the bytes of an exercise file. Raises CatalogueError."""
    _require_id(file)
    return toml_content(file)


def exercise_in(file: Path, content: bytes) -> Exercise:
    """Return the exercise in the bytes of a file; its id is the file's name.

    Raises CatalogueError.
    """
    return built_of(file, content, partial(exercise_of, file.stem), exercise_table)


def read_exercise(file: Path, text: str) -> Exercise:
    """Read an exercise from a text as if it were the content of ``file``. Raises CatalogueError."""
    _require_id(file)
    return read_toml(file, text, partial(exercise_of, file.stem), exercise_table)


def _require_id(file: Path) -> None:
    if not is_exercise_id(file.stem):
        reason = say("the name of the file is the exercise's id: {advice}", advice=ID_ADVICE)
        raise CatalogueError([Fault(file, "", reason)])


def _folder_reason(error: OSError) -> str:
    match error:
        case FileNotFoundError():
            return say("there is no such folder")
        case NotADirectoryError():
            return say("is no folder")
        case _:
            return fault_reason(error)


# --- Build an exercise, or one of its variants, from the content of its file


def exercise_of(exercise_id: str, content: Mapping[str, Any]) -> Exercise:
    """Build an exercise from the content of its file, without choosing a variant.

    Raises ValidationError or FieldError.
    """
    if "vary" not in content:
        return compile_exercise(exercise_id, ExerciseSpec.model_validate(content))
    return _filled(exercise_id, Vary(exercise_id, content), "")


def exercise_of_seed(exercise: Exercise, seed: str) -> Exercise:
    """Build the variant of an exercise for a seed. Raises ValidationError or FieldError."""
    assert exercise.vary is not None, f"{exercise.id} has no variants"
    return _filled(exercise.id, exercise.vary, seed)


def _filled(exercise_id: str, vary: Vary, seed: str) -> Exercise:
    values = vary.values(seed)
    spec = ExerciseSpec.model_validate(vary.content(values))
    built = compile_exercise(exercise_id, spec)
    variant = f"{exercise_id}~{seed}" if seed else exercise_id
    return replace(built, id=variant, version=vary.version(values), vary=vary, seed=seed)


# --- The order of the exercises in the catalogue


_LEVELS: Final = tuple(ExerciseLevel)
_HEADINGS: Final = {
    ExerciseLevel.START: say("Start here"),
    ExerciseLevel.BASICS: say("Basics"),
    ExerciseLevel.ARMS: say("Arms"),
    ExerciseLevel.INDUSTRIAL: say("Industrial robots"),
    None: say("More exercises"),
}


def in_order(exercises: Iterable[Exercise]) -> dict[str, Exercise]:
    """Sort exercises by level, then by ``order``; exercises without these fields come last."""
    return {exercise.id: exercise for exercise in sorted(exercises, key=_place)}


def by_level(exercises: Iterable[Exercise]) -> list[tuple[str, list[Exercise]]]:
    """Return each level's heading with its exercises, in the order of the catalogue."""
    groups = groupby(in_order(exercises).values(), key=lambda exercise: exercise.level)
    return [(_HEADINGS[level], list(group)) for level, group in groups]


def exercise_after(exercise_id: str, exercises: Iterable[Exercise]) -> Exercise | None:
    """Return the exercise after ``exercise_id`` in the catalogue, or None for the last."""
    following = iter(in_order(exercises).values())
    found = any(exercise.id == exercise_id for exercise in following)
    return next(following, None) if found else None


def _place(exercise: Exercise) -> tuple[int, bool, int]:
    level = len(_LEVELS) if exercise.level is None else _LEVELS.index(exercise.level)
    return level, exercise.order is None, exercise.order or 0


# --- Drafts (exercises that are still being written) for the preview in the editor


MOST_DRAFTS: Final = 32
# Seconds since a draft was last written.
KEPT: Final = 3600.0
_DRAFT_ID: Final = regex(r"draft-[0-9a-f]{32}")


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
        if not _DRAFT_ID.fullmatch(draft_id):
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
