"""The exercise files that the editor opens, and the folder in which it saves them."""

import hashlib
import os
import tempfile
from collections.abc import Sequence
from dataclasses import dataclass
from http import HTTPStatus
from itertools import chain, count
from pathlib import Path
from threading import Lock
from typing import Annotated, Final

from pydantic import Field

from service.api.http.problems import ProblemError
from service.catalogue import (
    ID_ADVICE,
    CatalogueError,
    exercise_files,
    is_exercise_id,
    read_regular,
)
from service.translations import say
from service.web.tutor.exercise_check import MAX_CHARACTERS, CheckRequest, exercise_of

# A character of the text has four bytes at most.
_LARGEST: Final = 4 * MAX_CHARACTERS
# The most characters of an id before "-copy" and a number.
_LONGEST_START: Final = 50


class SaveRequest(CheckRequest):
    """The text of an exercise file to save.

    ``before`` is the hash of the file that it replaces, or "".
    """

    before: Annotated[str, Field(max_length=64)] = ""


@dataclass(frozen=True, slots=True)
class OpenedFile:
    """The text of an exercise file, and the hash of the file."""

    # ``mark`` is the hash, or "" if the file is not in the editor's folder.

    text: str
    mark: str


class ExerciseFolder:
    """The files in the catalogue's folders and in the editor's own folder."""

    def __init__(self, folders: Sequence[Path], written: Path | None) -> None:
        self._folders = folders
        self._written = written
        self._writing = Lock()

    @property
    def can_write(self) -> bool:
        """True if the editor may save files."""
        return self._written is not None

    def opened(self, exercise_id: str) -> OpenedFile | None:
        """Return the file of an exercise, or None."""
        # A file in the editor's own folder is preferred.
        if not is_exercise_id(exercise_id):
            return None
        own = self._own(exercise_id)
        if own is not None:
            return OpenedFile(own.decode(errors="replace"), _mark(own))
        found = self._files().get(exercise_id)
        if found is None:
            return None
        return OpenedFile(read_regular(found, _LARGEST).decode(errors="replace"), "")

    def free_id(self, exercise_id: str) -> str:
        """Return an unused id for a copy of an exercise."""
        copies = (f"{exercise_id[:_LONGEST_START]}-copy{i}" for i in chain([""], count(2)))
        taken = self._files()
        return next(each for each in copies if each not in taken and self._own(each) is None)

    def _files(self) -> dict[str, Path]:
        """Return the files in the catalogue's folders, by exercise id."""
        try:
            return {file.stem: file for file in exercise_files(*self._folders)}
        except CatalogueError:
            return {}

    def save(self, body: SaveRequest) -> str:
        """Save a file, and return the hash of its content. Raises ProblemError."""
        # At any time, the file has either the whole old content or the whole new content.
        if self._written is None:
            raise _refused(say("This service cannot save files: DH_GRADER_EDITOR_DIR is not set."))
        if not is_exercise_id(body.id):
            raise _refused(say("This cannot be the id of an exercise: {advice}.", advice=ID_ADVICE))
        try:
            exercise_of(body.id, body.text)
        except CatalogueError as error:
            raise _refused(say("The file cannot be used. Fix it before you save it.")) from error
        content = body.text.encode()
        with self._writing:
            try:
                self._write(self._written / f"{body.id}.toml", content, body)
            except OSError as error:
                raise _refused(
                    say("The file cannot be saved: {reason}.", reason=str(error.strerror))
                ) from error
        return _mark(content)

    def _write(self, file: Path, content: bytes, body: SaveRequest) -> None:
        handle, name = tempfile.mkstemp(prefix=f".{body.id}-", dir=file.parent)
        written = Path(name)
        try:
            with os.fdopen(handle, "wb") as output:
                output.write(content)
                output.flush()
                os.fsync(output.fileno())
            written.chmod(0o644)
            own = self._own(body.id)
            if (_mark(own) if own is not None else "") != body.before:
                raise _changed(body.id)
            if own is None:
                if body.id in self._files():
                    raise _refused(say("The id {id} is taken. Choose another one.", id=body.id))
                # Unlike a move, this fails if the file was created meanwhile.
                os.link(written, file)
            else:
                written.replace(file)
        except FileExistsError as error:
            raise _changed(body.id) from error
        finally:
            written.unlink(missing_ok=True)

    def _own(self, exercise_id: str) -> bytes | None:
        if self._written is None:
            return None
        try:
            return read_regular(self._written / f"{exercise_id}.toml", _LARGEST)
        except FileNotFoundError:
            return None


def _mark(content: bytes) -> str:
    return hashlib.sha256(content).hexdigest()


def _refused(detail: str) -> ProblemError:
    return ProblemError(HTTPStatus.CONFLICT, detail, "not-saved", say("The file is not saved"))


def _changed(exercise_id: str) -> ProblemError:
    return _refused(
        say(
            "{exercise}.toml has changed since you opened it, so it was not overwritten. Download "
            "your text, open the file again, and merge the two.",
            exercise=exercise_id,
        )
    )
