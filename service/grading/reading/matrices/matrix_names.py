r"""The names of link transforms, such as A_2, T_{12}, {}^{1}T_2 or "Link 2" -> their places."""

import re
from collections.abc import Callable, Sequence
from typing import Final

_COMMAND: Final = re.compile(r"\\[A-Za-z]{1,20}")
# The arguments of A_2(q_2) are no index; those of A(2) and A{2} are.
_ARGUMENTS: Final = re.compile(r"\([^()]{0,40}[A-Za-zθ\\][^()]{0,40}\)")
_INDEX: Final = re.compile(r"\d{1,4}|(?<![a-z])(?:ee|EE|e|E|n|tool|TCP)(?![A-Za-z])")

_CHANGED: Final = re.compile(
    r"(?i:inv|transp)|['’′]|\.T(?![A-Za-z])|\\top(?![a-z])|\\intercal"
    # The T of {}^T stands in front of what it belongs to, and is a frame.
    r"|(?<![\s{}^])\s?\^\s?\{?\s?(?:-|T(?!\w)|\\(?:mathrm|text|mathsf)\s?\{?\s?T)"
    r"|\}(?<!\{\})\^\s?\{?\s?(?:-|T(?!\w))"
)
_PRODUCT: Final = re.compile(r"[*@]|\\(?:cdot|times)(?![a-z])")
# A_1 A_2; but the frames of a matrix are no matrices: T_{0 TCP}.
_SIDE_BY_SIDE: Final = re.compile(
    r"(?<![\^_])(?<![\^_]\{)[A-Z]\s?_?\{?\d+\}?[\s_^{}\d]*(?!EE?|TCP)[A-Z](?![A-Za-z])"
)

# A name -> its place, counted from 1; None where the index tells none.
Indices = tuple[str, ...]
_Place = int | None


def indices_of(name: str) -> Indices:
    r"""The numbers in a name, and the letters that stand for the last frame: "1", "2" of ^1T_2."""
    return tuple(_INDEX.findall(_COMMAND.sub(" ", _ARGUMENTS.sub(" ", name))))


def is_changed(name: str) -> bool:
    """Whether a name is that of an inverse or a transpose: inv(A1), A1', A_1^{-1}."""
    return _CHANGED.search(name) is not None


def is_product(name: str) -> bool:
    """Whether a name is that of a product of matrices: A1*A2, A_1 A_2."""
    plain = _ARGUMENTS.sub(" ", name)
    return (_PRODUCT.search(plain) or _SIDE_BY_SIDE.search(_COMMAND.sub(" ", plain))) is not None


def places_of(names: Sequence[Indices], count: int) -> tuple[tuple[_Place, ...], str]:
    """The places 1 to ``count`` that the names give; and what is unusual in the way they count.

    An index is the number of the link, or the two frames that the link stands between. Of several
    ways to count, the one that gives most places is meant: A0 may be the first link, and 12 the
    twelfth or the one between frames 1 and 2. None where a name gives no place.
    """
    readings = [
        (tuple(_valid(way(name, count), count) for name in names), unusual)
        for way, unusual in _WAYS
    ]
    return max(readings, key=lambda reading: len(set(reading[0]) - {None}))


def _valid(place: _Place, count: int) -> _Place:
    return place if place is not None and 1 <= place <= count else None


def _number(index: str, count: int) -> int:
    return int(index) if index.isdigit() else count


def _by_number(name: Indices, count: int) -> _Place:
    """A_2; or the frames on either side, T^1_2."""
    numbers = [_number(index, count) for index in name]
    if len(numbers) == 1 and (len(name[0]) == 1 or name[0][0] != "0"):
        return numbers[0]
    if len(numbers) == 2 and abs(numbers[0] - numbers[1]) == 1:
        return max(numbers)
    return None


def _by_frames(name: Indices, count: int) -> _Place:
    """T_{12}, the frames on either side in one number."""
    if len(name) == 1 and len(name[0]) == 2 and name[0].isdigit():
        return _by_number(tuple(name[0]), count)
    return _by_number(name, count)


def _from_zero(name: Indices, count: int) -> _Place:
    """A_0 for the first link."""
    return int(name[0]) + 1 if len(name) == 1 and name[0].isdigit() else _by_number(name, count)


def _from_frame_one(name: Indices, count: int) -> _Place:
    """T_{12} for the first link."""
    pair = tuple(name[0]) if len(name) == 1 and name[0].isdigit() else name
    numbers = [_number(index, count + 1) for index in pair]
    return min(numbers) if len(numbers) == 2 and abs(numbers[0] - numbers[1]) == 1 else None


def _by_last_frame(name: Indices, count: int) -> _Place:
    """T_{02} for the second matrix."""
    pair = tuple(name[0]) if len(name) == 1 else name
    return _number(pair[1], count) if len(pair) == 2 and pair[0] == "0" else None


# Ways to count, the most usual first, each with what a note says of it.
_WAYS: Final[tuple[tuple[Callable[[Indices, int], _Place], str], ...]] = (
    (_by_number, ""),
    (_by_frames, ""),
    (_from_zero, "The names count from 0"),
    (_by_last_frame, ""),
    (_from_frame_one, "The names count frames from 1"),
)
