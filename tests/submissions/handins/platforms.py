"""Name the files of a class as Moodle, Canvas, Brightspace and Blackboard name them."""

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field
from types import MappingProxyType
from typing import Final, Protocol

_FIRST: Final = (
    "Ada", "Ben", "Chloé", "Dušan", "Emmy", "Fatıma", "Grace", "Hedy", "Ida", "Jürgen",
    "Karl-Heinz", "Lise", "María José", "Noether", "Ola", "Priya", "Quentin", "Rosalind",
    "Søren", "Tú", "Ursula",
    "Vera", "王", "Xènia", "Yuki", "Zoë",
)  # fmt: skip
_LAST: Final = (
    "Lovelace", "Okri", "O'Brien", "de Souza", "García-Márquez", "Müller", "Hopper", "Nguyễn",
    "Smith", "小明", "Lamarr", "van der Berg", "Ng", "Curie",
)  # fmt: skip


@dataclass(frozen=True)
class Student:
    """A student with the files that the student handed in, by their own names."""

    number: int
    files: Mapping[str, bytes] = field(default_factory=dict)
    # The web page of a text that the student typed on the platform.
    text: bytes | None = None

    @property
    def name(self) -> str:
        """The first and last name; no two students of a class have the same."""
        first = _FIRST[self.number % len(_FIRST)]
        last = _LAST[self.number % len(_LAST)]
        return f"{first} {last}"

    @property
    def id(self) -> int:
        """The number of the student on the platform."""
        return 104_729 + 7_919 * self.number

    @property
    def user(self) -> str:
        """The username."""
        return f"u{self.id}"

    @property
    def is_late(self) -> bool:
        """True if the platform marks the submission as late."""
        return self.number % 3 == 1


class Platform(Protocol):
    """A platform that names the files of its students."""

    # The files of the export that belong to no student.
    others: Mapping[str, bytes]

    def files(self, student: Student) -> dict[str, bytes]:
        """Return the files of a student by their names in the export."""

    def learner(self, student: Student) -> str:
        """Return the identifier of a student in the gradebook."""


class _Platform:
    others: Mapping[str, bytes] = MappingProxyType({})


class Moodle(_Platform):
    """Folders, also for texts; older versions end their names with ``_``."""

    def __init__(self, *, in_folders: bool = True, end: str = "_") -> None:
        self._in_folders = in_folders
        self._end = end

    def files(self, student: Student) -> dict[str, bytes]:
        start = f"{student.name}_{student.id}_assignsubmission"
        between = f"{self._end}/" if self._in_folders else "_"
        found = {f"{start}_file{between}{name}": own for name, own in student.files.items()}
        if student.text is not None:
            found[f"{start}_onlinetext{between}onlinetext.html"] = student.text
        return found

    def learner(self, student: Student) -> str:
        return f"Participant {student.id}"


class Canvas(_Platform):
    """Flat files; the name has only letters, digits and ``_``."""

    def files(self, student: Student) -> dict[str, bytes]:
        first, _, last = student.name.rpartition(" ")
        own = "".join(sign for sign in f"{last}{first}".lower() if sign.isalnum())
        start = f"{own}{'_LATE' if student.is_late else ''}_{student.id}"
        found = {
            f"{start}_{9_000_000 + 11 * student.number + i}_{name}": content
            for i, (name, content) in enumerate(student.files.items())
        }
        if student.text is not None:
            found[f"{start}_text.html"] = student.text
        return found

    def learner(self, student: Student) -> str:
        return str(student.id)


class Brightspace(_Platform):
    """Folders, or flat files in other versions, and an index of the submissions."""

    others: Mapping[str, bytes] = MappingProxyType(
        {"index.html": b"<table><tr><td>Lovelace, Ada</td><td>Nov 20, 2026</td></tr></table>"}
    )

    def __init__(self, *, in_folders: bool = True) -> None:
        self._in_folders = in_folders

    def files(self, student: Student) -> dict[str, bytes]:
        start = f"{student.id}-84321 - {student.name} - Nov {1 + student.number % 28}, 2026 531 PM"
        between = "/" if self._in_folders else " - "
        files = dict(student.files)
        if student.text is not None:
            files["Text Submission.html"] = student.text
        return {f"{start}{between}{name}": content for name, content in files.items()}

    def learner(self, student: Student) -> str:
        return student.name


class Blackboard(_Platform):
    """Flat files, and a text file about each attempt, which holds what the student typed."""

    def files(self, student: Student) -> dict[str, bytes]:
        start = f"HW1_{student.user}_attempt_2026-11-20-17-31-{student.number % 60:02}"
        found = {f"{start}_{name}": content for name, content in student.files.items()}
        found[f"{start}.txt"] = self._receipt(student, list(found)).encode()
        return found

    def _receipt(self, student: Student, names: Sequence[str]) -> str:
        typed = "There is no student submission text data for this assignment."
        if student.text is not None:
            typed = student.text.decode()
        lines = [
            f"Name: {student.name} ({student.user})",
            "Assignment: HW1",
            "Date Submitted: Friday, November 20, 2026 5:31:02 PM CET",
            "Current Grade: Needs Grading", "",
            "Submission Field:", typed, "",
            "Comments:", "There are no student comments for this assignment.", "",
            "Files:",
        ]  # fmt: skip
        for own, name in zip(student.files, names, strict=True):
            lines += [f"\tOriginal filename: {own}", f"\tFilename: {name}", ""]
        return "\n".join([*lines, *([] if student.files else ["\tNo files are attached."])])

    def learner(self, student: Student) -> str:
        return student.user


PLATFORMS: Final[Mapping[str, Platform]] = {
    "Moodle": Moodle(),
    "Canvas": Canvas(),
    "Brightspace": Brightspace(),
    "Blackboard": Blackboard(),
    "Moodle, flat": Moodle(in_folders=False),
    "Moodle, without _": Moodle(end=""),
    "Brightspace, flat": Brightspace(in_folders=False),
}
