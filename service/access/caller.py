"""Who asks, and what they may do."""

from dataclasses import dataclass
from enum import StrEnum
from hashlib import sha256
from typing import Final


class Scope(StrEnum):
    """What a key is for. Each key may grade, whatever else it may do."""

    GRADE = "grade"
    RECORD = "record"
    TUTOR = "tutor"


@dataclass(frozen=True, slots=True)
class Caller:
    """Who asks: the holder of a key, of a token that a key has made, or anybody.

    ``exercises`` and ``learner`` are what they are bound to; None is no bound.
    """

    scopes: frozenset[Scope]
    exercises: frozenset[str] | None = None
    learner: str | None = None
    key_id: str = ""

    def reaches(self, exercise: str) -> bool:
        """Whether what is asked for may be of this exercise."""
        return self.exercises is None or exercise in self.exercises

    @property
    def owner(self) -> str:
        """Whom requests and what they record belong to, 32 characters at most.

        All of a key's own requests are of one owner, those by its tokens of one for each learner;
        it is empty for anybody.
        """
        if self.learner is None:
            return self.key_id
        return sha256(f"{self.key_id} {self.learner}".encode()).hexdigest()[:32]


NOBODY: Final = Caller(frozenset())
