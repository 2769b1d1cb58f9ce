"""The caller of a request and its rights."""

from dataclasses import dataclass
from enum import StrEnum
from hashlib import sha256
from typing import Final


class Scope(StrEnum):
    """A right of a key. Every key has the right to grade."""

    GRADE = "grade"
    RECORD = "record"
    TUTOR = "tutor"


@dataclass(frozen=True, slots=True)
class Caller:
    """The caller of a request: the holder of a key or token, or an anonymous client.

    ``exercises``, ``learner`` and ``course`` restrict the caller; None means no restriction.
    """

    scopes: frozenset[Scope]
    exercises: frozenset[str] | None = None
    learner: str | None = None
    key_id: str = ""
    course: str | None = None

    def reaches(self, exercise: str) -> bool:
        """True if the caller may use this exercise; ``exercise`` may be the id of a variant."""
        return self.exercises is None or exercise.partition("~")[0] in self.exercises

    @property
    def reaches_all(self) -> bool:
        """True if the caller is restricted neither to exercises nor to a course."""
        return self.exercises is None and self.course is None

    @property
    def owner(self) -> str:
        """The id under which requests and attempts of the caller are recorded.

        The id of an anonymous client is "".
        """
        # At most 32 characters: the id of a key, or a hash for each learner with a token. A
        # course's learner stays the same owner when the personal link is renewed.
        if self.learner is None:
            return self.key_id
        by = self.key_id if self.course is None else f"course {self.course}"
        return sha256(f"{by} {self.learner}".encode()).hexdigest()[:32]


NOBODY: Final = Caller(frozenset())
