"""Find the place in a list that a name such as x, p_y, φ or pitch means."""

# A name may mean several places.

import unicodedata
from collections.abc import Iterable, Mapping, Sequence
from dataclasses import dataclass, field
from functools import lru_cache
from typing import Final

from service.expressions import Kind, LeftSide, Symbol, Vocabulary
from service.expressions.characters import greek
from service.expressions.vocabulary.symbols import normal_form
from service.grading.reading.written_names import Places
from service.regex import regex
from service.translations import say

_STYLE: Final = regex(
    r"\\(?:mathrm|mathbf|mathit|mathsf|text|boldsymbol|bm|vec)(?![a-z])|\\begin\{[a-z]+\*?\}"
    r"|\b(?:let|const|var|double|float|auto)\s"
)
# The name of x(q1, q2) is x, without the arguments.
_ARGUMENTS: Final = regex(r"[(\[][^()\[\]]*[^\W\d][^()\[\]]*[)\]]")
_GREEK: Final = regex(f"[{greek.CLASS}]")
_WORD: Final = regex(r"[a-z]+|[0-9]+")
# x, p_x, px, x_e, x_{ee}, but not xy.
_COORDINATE: Final = regex(r"(?:[a-w]|pos)?([xyz])|([xyz])(?:e|ee|ef|eff|end|p|o|n|t|tcp|tip|tool)")
_NO_MARKS: Final = str.maketrans("", "", "{}$*^' ")


@dataclass(frozen=True, slots=True)
class ListNames:
    """The names that the values of a list may have.

    ``labels`` are the expected names and ``quantities`` the expected quantities, in order.
    """

    # ``places`` maps the plain form of each name (``_key``) to places; ``coordinates`` maps x, y
    # and z to places.
    labels: tuple[str, ...]
    quantities: tuple[Kind, ...]
    places: Mapping[str, tuple[int, ...]] = field(default_factory=dict)
    coordinates: Mapping[str, tuple[int, ...]] = field(default_factory=dict)

    def places_of(self, names: Sequence[LeftSide | None], vocabulary: Vocabulary) -> list[Places]:
        """Return the places in the list that each name may mean; None if a name means no place."""
        words = [_words(name.name) if name else [] for name in names]
        letters = [letter for each in words if (letter := _coordinate(each))]
        # x_1 and y_1 are coordinates in frame 1, but x_1 and x_2 are numbered values.
        of_frames = 1 < len(letters) == len(set(letters))
        return [
            self._places(name.name, each, self.quantities[i], vocabulary, of_frames=of_frames)
            if name
            else None
            for i, (name, each) in enumerate(zip(names, words, strict=True))
        ]

    def _places(
        self,
        name: str,
        words: Sequence[str],
        quantity: Kind,
        vocabulary: Vocabulary,
        *,
        of_frames: bool,
    ) -> Places:
        key = _key(words)
        if key in self.places:
            return self.places[key]
        symbol = _symbol(name, vocabulary)
        if symbol is not None and symbol.name in self.places:
            return self.places[symbol.name]
        letter = _coordinate(words)
        if letter and letter in self.coordinates and (of_frames or not words[-1].isdigit()):
            return self.coordinates[letter]
        return () if symbol is not None and _is_another(symbol, quantity) else None


@lru_cache(maxsize=256)
def names_of_coordinates(letters: str) -> ListNames:
    """Return the names of a point's coordinates, expected in the order of ``letters``."""
    lengths: tuple[Kind, ...] = tuple("length" for _ in letters)
    return ListNames((*letters,), lengths, coordinates=_by_letter(letters))


@lru_cache(maxsize=256)
def names_of_components(
    components: tuple[tuple[str, Kind], ...], vocabulary: Vocabulary
) -> ListNames:
    """Return the names of a vector's components, each given as (name, quantity)."""
    names = tuple(name for name, _ in components)
    keys: dict[str, list[int]] = {}
    for i, name in enumerate(names):
        symbol = _symbol(name, vocabulary)
        for key in {_key(_words(name)), symbol.name if symbol else ""} - {""}:
            keys.setdefault(key, []).append(i)
    letters = [_coordinate(_words(name)) for name in names]
    known = [letter for letter in letters if letter]
    # In (v_x, ω_x) x is ambiguous, and a single z is not a point.
    is_point = len(known) > 1 and len(set(known)) == len(known)
    return ListNames(
        names,
        tuple(quantity for _, quantity in components),
        {key: tuple(places) for key, places in keys.items()},
        _by_letter(letters) if is_point else {},
    )


@lru_cache(maxsize=256)
def names_of_angles(turns: str, *, fixed: bool) -> ListNames:
    """Return the names of three angles about the axes ``turns``, which are fixed or moving."""
    # Textbooks differ in the order of α and γ (about fixed axes), of φ and ψ (about three different
    # axes), and of roll and yaw. So each of these names has two possible places.
    is_euler = turns[0] == turns[2]
    inner, outer = (1,), (0, 2)
    places: dict[str, tuple[int, ...]] = {"beta": inner, "theta": inner}
    places |= dict.fromkeys(("alpha", "gamma"), outer) if fixed else {"alpha": (0,), "gamma": (2,)}
    places |= {"phi": (0,), "psi": (2,)} if is_euler else dict.fromkeys(("phi", "psi"), outer)
    if not is_euler:
        about_y = turns.index("Y")
        others = tuple(i for i in range(3) if i != about_y)
        places |= {"pitch": (about_y,), "roll": others, "yaw": others}
    first, second, third = list(turns.lower())
    # Translators: a part of "This is named `phi`, but the first angle, about z, is asked for here".
    labels = (
        say("the first angle, about {axis},", axis=first),
        say("the second angle, about {axis},", axis=second),
        say("the third angle, about {axis},", axis=third),
    )
    coordinates = {} if is_euler else _by_letter(turns.lower())
    return ListNames(labels, ("angle",) * 3, places, coordinates)


def _by_letter(letters: Iterable[str | None]) -> dict[str, tuple[int, ...]]:
    listed = list(letters)
    return {axis: tuple(i for i, each in enumerate(listed) if each == axis) for axis in "xyz"}


def _is_another(symbol: Symbol, quantity: Kind) -> bool:
    # An angle where a length is expected, or vice versa.
    return quantity != "number" and symbol.kind != "number" and symbol.kind != quantity


def _words(name: str) -> list[str]:
    # In small letters, Greek letters spelled out.
    plain = _GREEK.sub(lambda found: f" {greek.NAMES[found[0]]} ", _plain(name)).lower()
    words = _WORD.findall(plain.replace("\\var", "\\"))
    # A leading superscript is a frame: {}^0 p_x.
    return words[1:] if len(words) > 1 and words[0].isdigit() else words


def _key(words: Sequence[str]) -> str:
    return "".join(words)


def _plain(name: str) -> str:
    return unicodedata.normalize("NFKC", _ARGUMENTS.sub(" ", _STYLE.sub(" ", name)))


def _symbol(name: str, vocabulary: Vocabulary) -> Symbol | None:
    plain = _plain(name)
    return vocabulary.by_name.get(normal_form(plain.translate(_NO_MARKS)))


def _coordinate(words: Sequence[str]) -> str | None:
    # x for p_x and x_e; None unless there is just one coordinate.
    found = [match[1] or match[2] for word in words if (match := _COORDINATE.fullmatch(word))]
    return found[0] if len(found) == 1 else None
