"""Reading the folder of exercise files."""

import errno
import os
import re
import stat
import tomllib
from dataclasses import dataclass
from pathlib import Path

from pydantic import ValidationError

from service.catalogue.compile import compile_exercise
from service.catalogue.exercise import Exercise
from service.catalogue.fields import IDENTIFIER
from service.catalogue.formulas import FieldError
from service.catalogue.lines import line_of, value_lines
from service.catalogue.refusals import refusals
from service.catalogue.schema import ExerciseSpec

ID_ADVICE = "write small letters and digits, with - or _ between them, such as elbow-arm"
_LONGEST_ID = 60
# The largest exercise that comes with the program has 8 kB.
_LARGEST = 1024 * 1024


@dataclass(frozen=True, slots=True)
class Fault:
    """One reason why an exercise file is refused: where in the file, and why."""

    file: Path
    field: str
    reason: str
    line: int | None = None

    def __str__(self) -> str:
        """File, field and reason on one line."""
        place = self.field if self.line is None else f"{self.field} (line {self.line})"
        return ": ".join(filter(None, (str(self.file), place, self.reason)))


class CatalogueError(Exception):
    """One or more exercise files cannot be used; ``faults`` says which and why."""

    def __init__(self, faults: list[Fault]) -> None:
        super().__init__("\n".join(str(fault) for fault in faults))
        self.faults = faults


def shipped_folder() -> Path:
    """The folder of the exercises that come with the program.

    A wheel carries it inside the package; a checkout has it at the top.
    """
    package = Path(__file__).parents[1]
    packaged = package / "_exercises"
    return packaged if packaged.is_dir() else package.parent / "exercises"


def exercise_files(*folders: Path) -> list[Path]:
    """The exercise files of folders, folder by folder, in the order of their names.

    Raises CatalogueError where a folder is missing or holds none, or a name stands in two of them.
    """
    files: dict[str, Path] = {}
    faults: list[Fault] = []
    for folder in dict.fromkeys(folders):
        try:
            found = sorted(file for file in folder.iterdir() if file.match("*.toml"))
        except OSError as error:
            faults.append(Fault(folder, "", _folder_reason(error)))
            continue
        if not found:
            faults.append(Fault(folder, "", "holds no exercise file (*.toml)"))
        for file in found:
            if files.setdefault(file.stem, file) is not file:
                reason = f"has the name of {file}; give it another, for it is the id"
                faults.append(Fault(files[file.stem], "", reason))
    if faults:
        raise CatalogueError(faults)
    return list(files.values())


def load_catalogue(*folders: Path) -> dict[str, Exercise]:
    """All exercises of one or more folders by id, in the order of their file names.

    Raises CatalogueError naming the faults of all files, those of shape before those of formulas.
    """
    exercises: dict[str, Exercise] = {}
    faults: list[Fault] = []
    for file in exercise_files(*folders):
        try:
            exercises[file.stem] = load_exercise(file)
        except CatalogueError as error:
            faults.extend(error.faults)
    if faults:
        raise CatalogueError(faults)
    return exercises


def is_exercise_id(name: str) -> bool:
    """Whether ``name`` can be the name of a file, without .toml, and a part of web addresses."""
    return re.fullmatch(IDENTIFIER, name) is not None and len(name) <= _LONGEST_ID


def load_exercise(file: Path) -> Exercise:
    """The exercise of one file; its id is the file's name. Raises CatalogueError."""
    if not is_exercise_id(file.stem):
        reason = f"the name of the file is the exercise's id: {ID_ADVICE}"
        raise CatalogueError([Fault(file, "", reason)])
    text = ""
    try:
        text = _text(file)
        return compile_exercise(file.stem, ExerciseSpec.model_validate(tomllib.loads(text)))
    except (ValidationError, FieldError) as error:
        lines = value_lines(text)
        faults = [Fault(file, *fault, line_of(fault[0], lines)) for fault in refusals(error)]
        raise CatalogueError(faults) from error
    except (OSError, ValueError, RecursionError) as error:
        raise CatalogueError([Fault(file, "", _reason(error))]) from error


def _text(file: Path) -> str:
    """The text of a regular file; of no other, for a pipe or device may never end, or begin."""
    with open(file, encoding="utf-8", opener=_unblocked) as opened:
        status = os.fstat(opened.fileno())
        if not stat.S_ISREG(status.st_mode):
            raise OSError(errno.EINVAL, "it is a pipe or device")
        if status.st_size > _LARGEST:
            raise OSError(errno.EFBIG, f"it is larger than {_LARGEST // 1024} KiB")
        return opened.read()


def _unblocked(name: str, flags: int) -> int:
    return os.open(name, flags | getattr(os, "O_NONBLOCK", 0))


def _folder_reason(error: OSError) -> str:
    match error:
        case FileNotFoundError():
            return "there is no such folder"
        case NotADirectoryError():
            return "is no folder"
        case _:
            return _reason(error)


def _reason(error: Exception) -> str:
    match error:
        case OSError():
            return f"cannot be read: {error.strerror}"
        case UnicodeDecodeError():
            return f"is not UTF-8 text: {error.reason}"
        case RecursionError():
            return "has tables or lists too deep in each other"
        case _:  # of TOML itself, or of a number with thousands of digits
            return f"is not TOML: {error}"
