"""The words by which the search of the catalogue finds an exercise."""

from collections.abc import Iterable, Iterator
from typing import Final

from service.catalogue import Exercise
from service.kinematics.dh import Convention

_KIND_NAMES: Final = {
    "dh_table": "DH table",
    "dh_row": "DH row",
    "frames": "placing frames",
    "find_slip": "finding the slip",
    "link_transforms": "link transforms",
    "euler_angles": "Euler angles",
    "screw_axes": "screw axes",
}
# The words that lectures and books use.
_CONVENTIONS: Final = {
    Convention.STANDARD: "standard distal",
    Convention.MODIFIED: "modified proximal Craig",
}
_JOINTS: Final = {"R": "revolute rotary turning", "P": "prismatic linear sliding"}


def kinds_of(exercise: Exercise) -> Iterable[str]:
    """Return the names of the kinds of its parts, each once."""
    return dict.fromkeys(_KIND_NAMES.get(part.kind, part.kind) for part in exercise.parts)


def words_of(exercise: Exercise) -> str:
    """Return all words of an exercise that a student may search for."""
    return " ".join(dict.fromkeys(" ".join(_texts(exercise)).split()))


def _texts(exercise: Exercise) -> Iterator[str]:
    yield from (exercise.id, exercise.title, exercise.summary, *exercise.keywords)
    yield from (_CONVENTIONS[convention] for convention in exercise.conventions)
    if joints := exercise.structure:
        letters = dict.fromkeys(joints)
        # A "6R" arm has six joints that turn. The search reads "6 dof" as "6dof".
        yield from (joints, f"{len(joints)}dof", *(_JOINTS[letter] for letter in letters))
        if len(letters) == 1:
            yield f"{len(joints)}{joints[0]}"
    yield from kinds_of(exercise)
    for part in exercise.parts:
        yield from (part.title, part.prompt)
