"""The words by which a search finds an exercise in the catalogue."""

from collections.abc import Iterable, Iterator
from typing import Final

from service.catalogue import Exercise
from service.kinematics.dh import Convention
from service.translations import ENGLISH, Language, say, told

_KIND_NAMES: Final = {
    "dh_table": say("DH table"),
    "dh_row": say("DH row"),
    "frames": say("placing frames"),
    "find_slip": say("finding the slip"),
    "link_transforms": say("link transforms"),
    "euler_angles": say("Euler angles"),
    "screw_axes": say("screw axes"),
    "matrix": say("matrix"),
    "position": say("position"),
    "rotation": say("rotation"),
    "transform": say("transform"),
    "vector": say("vector"),
}
# The words that lectures and books use.
_CONVENTIONS: Final = {
    Convention.STANDARD: "standard distal",
    Convention.MODIFIED: "modified proximal Craig",
}
_JOINTS: Final = {"R": "revolute rotary turning", "P": "prismatic linear sliding"}


def kinds_of(exercise: Exercise) -> Iterable[str]:
    """Return the kinds of answers that an exercise asks for, such as a DH table."""
    # Each kind once.
    return dict.fromkeys(_KIND_NAMES.get(part.kind, part.kind) for part in exercise.parts)


def words_of(
    exercise: Exercise, language: Language = ENGLISH, original: Exercise | None = None
) -> str:
    """Return all words of an exercise by which a search may find it.

    The words of the English ``original`` are included.
    """
    texts = [told(each, language.translation) for each in _texts(exercise)]
    if language.translation:
        texts += _texts(original or exercise)
    return " ".join(dict.fromkeys(" ".join(texts).split()))


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
