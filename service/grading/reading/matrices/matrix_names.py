r"""Find the place of a link transform by its name, such as A_2, T_{12}, {}^{1}T_2 or "Link 2"."""

from collections.abc import Callable, Sequence
from typing import Final

from service.regex import regex
from service.translations import template

_COMMAND: Final = regex(r"\\[A-Za-z]{1,20}")
# The arguments of A_2(q_2), in contrast to the indices of A(2) and A{2}.
_ARGUMENTS: Final = regex(r"\([^()]{0,40}[A-Za-zθ\\][^()]{0,40}\)")
_INDEX: Final = regex(r"\d{1,4}|(?<![a-z])(?:ee|EE|e|E|n|tool|TCP)(?![A-Za-z])")

_CHANGED: Final = regex(
    r"(?i:inv|transp)|['’′]|\.T(?![A-Za-z])|\\top(?![a-z])|\\intercal"
    # The T in {}^T A is a frame and not a transpose.
    r"|(?<![\s{}^])\s?\^\s?\{?\s?(?:-|T(?!\w)|\\(?:mathrm|text|mathsf)\s?\{?\s?T)"
    r"|\}(?<!\{\})\^\s?\{?\s?(?:-|T(?!\w))"
)
_PRODUCT: Final = regex(r"[*@]|\\(?:cdot|times)(?![a-z])")
# Two matrices, as in A_1 A_2, but not two frames of one matrix, as in T_{0 TCP}.
_SIDE_BY_SIDE: Final = regex(
    r"(?<![\^_])(?<![\^_]\{)[A-Z]\s?_?\{?\d+\}?[\s_^{}\d]*(?!EE?|TCP)[A-Z](?![A-Za-z])"
)

# The indices in the name of a matrix, as they are written.
Indices = tuple[str, ...]
# The place of a matrix, counted from 1; None if its indices do not give one.
_Place = int | None


def indices_of(name: str) -> Indices:
    r"""Return the indices in a name: "1" and "2" for ^1T_2, "0" and "e" for ^0T_e."""
    return tuple(_INDEX.findall(_COMMAND.sub(" ", _ARGUMENTS.sub(" ", name))))


def is_changed(name: str) -> bool:
    """True if a name means an inverse or a transpose: inv(A1), A1', A_1^{-1}."""
    return _CHANGED.search(name) is not None


def is_product(name: str) -> bool:
    """True if a name means a product of matrices: A1*A2, A_1 A_2."""
    plain = _ARGUMENTS.sub(" ", name)
    return (_PRODUCT.search(plain) or _SIDE_BY_SIDE.search(_COMMAND.sub(" ", plain))) is not None


def places_of(names: Sequence[Indices], numbers: range) -> tuple[tuple[_Place, ...], str]:
    """Return the place (or None) of each named link transform, and a note on unusual counting."""
    # ``numbers`` are the robot's own numbers of its links. There are several ways to count: by the
    # robot's numbers or from 1, A0 may be the first link, and 12 may be the twelfth link or the
    # link between frames 1 and 2. The way that gives the most link transforms is chosen, of equal
    # ways the first. The note is empty for usual counting.
    from_one = range(1, len(numbers) + 1)
    readings = [
        (tuple(_place(way(name, counted[-1]), counted) for name in names), unusual)
        for counted, ways in ((numbers, _WAYS[:2]), (from_one, _WAYS))
        for way, unusual in ways
    ]
    return max(readings, key=lambda reading: len(set(reading[0]) - {None}))


def _place(number: int | None, numbers: range) -> _Place:
    return numbers.index(number) + 1 if number is not None and number in numbers else None


def _number(index: str, last: int) -> int:
    return int(index) if index.isdigit() else last


def _by_number(name: Indices, last: int) -> int | None:
    # A_2 has the link's number, T^1_2 the link's two frames.
    numbers = [_number(index, last) for index in name]
    if len(numbers) == 1 and (len(name[0]) == 1 or name[0][0] != "0"):
        return numbers[0]
    if len(numbers) == 2 and abs(numbers[0] - numbers[1]) == 1:
        return max(numbers)
    return None


def _by_frames(name: Indices, last: int) -> int | None:
    # T_{12} and T_{910} have the link's two frames in one number.
    if len(name) == 1 and len(name[0]) > 1 and name[0].isdigit():
        links = range(1, last + 1)
        return next((i for i in links if name[0] in (f"{i - 1}{i}", f"{i}{i - 1}")), None)
    return _by_number(name, last)


def _from_zero(name: Indices, last: int) -> int | None:
    # The first link is A_0.
    return int(name[0]) + 1 if len(name) == 1 and name[0].isdigit() else _by_number(name, last)


def _from_frame_one(name: Indices, last: int) -> int | None:
    # The first link is T_{12}.
    pair = tuple(name[0]) if len(name) == 1 and name[0].isdigit() else name
    numbers = [_number(index, last + 1) for index in pair]
    return min(numbers) if len(numbers) == 2 and abs(numbers[0] - numbers[1]) == 1 else None


def _by_last_frame(name: Indices, last: int) -> int | None:
    # All names start from frame 0: T_{02} is the second matrix.
    pair = tuple(name[0]) if len(name) == 1 else name
    return _number(pair[1], last) if len(pair) == 2 and pair[0] == "0" else None


# Ways to count, the most usual first, each with the template of its note. A way gives the number
# of a link; the number of the last link is its second argument.
_WAYS: Final[tuple[tuple[Callable[[Indices, int], int | None], str], ...]] = (
    (_by_number, ""),
    (_by_frames, ""),
    (_from_zero, template("The names count from 0; the matrices were read as {matrices}.")),
    (_by_last_frame, ""),
    (
        _from_frame_one,
        template("The names count frames from 1; the matrices were read as {matrices}."),
    ),
)
