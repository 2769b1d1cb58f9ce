"""What an exercise leaves to the student."""

from dataclasses import dataclass


@dataclass(frozen=True, slots=True)
class Freedom:
    """What an exercise leaves to the student, beyond the frames on the joints."""

    base: bool = False
    tool: bool = False
    directions: bool = False
