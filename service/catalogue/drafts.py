"""Exercises that are still being written, for the preview in the editor."""

import secrets
import time
from collections import OrderedDict
from collections.abc import Callable, Iterator, Mapping
from pathlib import Path
from threading import Lock
from typing import Final

from service.catalogue.exercise import Exercise
from service.catalogue.load import read_exercise

MOST_DRAFTS: Final = 32
# Seconds since a draft was last written.
KEPT: Final = 3600.0
_PREFIX: Final = "draft-"


class Drafts:
    """The drafts of this process. Only the author of a draft knows its id."""

    def __init__(self, clock: Callable[[], float] = time.monotonic) -> None:
        self._clock = clock
        self._drafts: OrderedDict[str, tuple[float, Exercise]] = OrderedDict()
        self._lock = Lock()

    def put(self, text: str, draft_id: str = "") -> str:
        """Keep an exercise and return its id. ``draft_id`` is the draft that it replaces.

        Raises CatalogueError.
        """
        if draft_id not in self._drafts:
            draft_id = f"{_PREFIX}{secrets.token_hex(16)}"
        exercise = read_exercise(Path(f"{draft_id}.toml"), text)
        with self._lock:
            self._drafts[draft_id] = self._clock(), exercise
            self._drafts.move_to_end(draft_id)
            while len(self._drafts) > MOST_DRAFTS:
                self._drafts.popitem(last=False)
        return draft_id

    def get(self, draft_id: str) -> Exercise | None:
        """Return a draft, or None if it is unknown or too old."""
        written, exercise = self._drafts.get(draft_id, (0.0, None))
        return exercise if self._clock() < written + KEPT else None


class CatalogueWithDrafts(Mapping[str, Exercise]):
    """A catalogue in which drafts are found by their ids. They are not listed."""

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
