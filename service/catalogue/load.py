"""Load exercise files from folders."""

import hashlib
import json
import re
from collections.abc import Mapping
from functools import partial
from pathlib import Path
from typing import Final

from service.catalogue.exercise import Exercise
from service.catalogue.files.fields import IDENTIFIER
from service.catalogue.files.refusals import exercise_table
from service.catalogue.files.toml_file import (
    CatalogueError,
    Fault,
    built_of,
    fault_reason,
    read_toml,
    toml_content,
)
from service.catalogue.order import in_order
from service.catalogue.varying.build import exercise_of
from service.translations import say

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
    return packaged if packaged.is_dir() else package.parent / "exercises"


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
