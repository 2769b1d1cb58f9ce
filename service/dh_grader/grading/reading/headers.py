"""Read headers and row labels of tables, in six languages: columns, units, order of rows.

This file knows words, not tables: each function takes the text of one cell, or the labels of rows.
"""

import re
import unicodedata
from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field
from typing import Final, NamedTuple

from dh_grader.expressions import AngleUnit, Kind
from dh_grader.grading.report import Finding, reading_note
from dh_grader.pasting import GridCell, GridError
from dh_grader.regex import regex
from dh_grader.translations import say

# --- Words in headers and row labels, in English, German, Spanish, French, Italian and Chinese
#
# Words are in small letters without accents: "articulación" is "articulacion", "ß" is "ss". A word
# that means different parameters in different books, such as "Abstand", is a filler: the letter
# next to it decides, and without a letter the header is unknown.


LETTERS: Final[Mapping[str, str]] = {
    "a": "a", "r": "a", "alpha": "alpha", "al": "alpha", "alfa": "alpha", "d": "d",
    "theta": "theta", "th": "theta", "teta": "theta", "tita": "theta", "q": "theta",
    "vartheta": "theta", "phi": "theta", "varphi": "theta", "φ": "theta",
    # The link length, or the number of the link.
    "l": "l",
}  # fmt: skip
TERMS: Final[Mapping[str, str]] = {
    **dict.fromkeys(("length", "lange", "gliedlange", "armlange", "armteillange"), "a"),
    **dict.fromkeys(("longitud", "longueur", "lunghezza"), "a"),
    **dict.fromkeys(("twist", "verdrehung", "verwindung", "verdrehwinkel", "torsion"), "alpha"),
    **dict.fromkeys(("gliedverdrehung", "gliedverwindung", "armteilverdrehung"), "alpha"),
    **dict.fromkeys(("verdrehungswinkel", "verwindungswinkel"), "alpha"),
    **dict.fromkeys(("torsione", "vrillage"), "alpha"),
    **dict.fromkeys(("offset", "versatz", "gelenkversatz", "gliedversatz", "gelenkabstand"), "d"),
    **dict.fromkeys(("desplazamiento", "decalage"), "d"),
    **dict.fromkeys(("angle", "rotation", "winkel", "gelenkwinkel", "angulo", "angolo"), "theta"),
}  # fmt: skip
PLACES: Final = frozenset(
    {"link", "joint", "row", "frame", "axis", "index", "no", "nr", "number", "name", "label", "#"}
    | {"links", "joints", "rows", "frames", "axes"}
    | {"kinematics", "id"}
    | {"gelenk", "glied", "achse", "arm", "armteil", "zeile", "reihe", "korper", "nummer"}
    | {"gelenknummer", "gliednummer", "achsnummer", "zeilennummer"}
    | {"articulacion", "eslabon", "eje", "fila", "numero", "num", "indice"}
    | {"articulation", "liaison", "segment", "corps", "axe", "ligne"}
    | {"giunto", "braccio", "asse", "membro", "riga"}
)
FILLERS: Final = frozenset(
    {"of", "the", "about", "along", "parameter", "value", "in", "um", "der", "des", "entlang"}
    | {"abstand", "distanz", "distancia", "distance", "distanza", "entfernung", "verschiebung"}
    | {"de", "del", "la", "el", "du", "le", "di", "articular", "articulaire", "parametro"}
    | {"drehwinkel", "drehung", "giro", "rotacion", "traslacion", "translation", "en"}
)
ASIDES: Final = regex(
    r"(?:joint )?(?:type|var\.?|variables?|range|limits?)|comments?|notes?|remarks?"
    # Limits of a joint, and numbers that follow from an angle.
    r"|(?:(?:q|theta|d|joint|lower|upper)(?: ?i)? ?)?(?:min|max|limit|bound)(?: ?i)?"
    r"|(?:cos|sin)[ (]{1,2}(?:alpha|theta)(?: ?i)?[ )]{0,2}"
    r"|home(?: position)?|dynamics|mass(?: [(\[]kg[)\]])?|cent(?:er|re) of mass"
    # The joint type of Khalil and the Robotics Toolbox: 0 turns, 1 slides.
    r"|sigma(?: [ijn])?|σ(?: ?[ijn])?"
    r"|(?:gelenk)?(?:typ|variable|art)|(?:bemerkung|anmerkung|kommentar|hinweis)(?:en|e)?"
    r"|tipo(?: de articulacion| di giunto)?|observacion(?:es)?|comentarios?|notas?|rango|limites?"
    r"|type (?:d'articulation|de liaison)|remarques?|commentaires?|variable articulaire"
    r"|variable (?:de articulacion|articular)|osservazion[ei]|aside"
)

ANGLE_UNITS: Final[Mapping[str, AngleUnit]] = {
    **dict.fromkeys(("deg", "degs", "degree", "degrees", "°"), "degrees"),
    **dict.fromkeys(("degre", "degres", "grados", "grado", "gradi"), "degrees"),
    **dict.fromkeys(("rad", "rads", "radian", "radians"), "radians"),
    **dict.fromkeys(("radiant", "bogenmass", "radianes", "radianti"), "radians"),
}  # fmt: skip
METRES: Final[Mapping[str, float]] = {
    **dict.fromkeys(("m", "metre", "metres", "meter", "meters"), 1.0),
    **dict.fromkeys(("dm",), 0.1),
    **dict.fromkeys(("cm", "centimetre", "centimetres", "centimeter", "centimeters"), 0.01),
    **dict.fromkeys(("mm", "millimetre", "millimetres", "millimeter", "millimeters"), 0.001),
    **dict.fromkeys(("metern", "metro", "metros", "metri"), 1.0),
    **dict.fromkeys(("zentimeter", "zentimetern", "centimetros", "centimetri"), 0.01),
    **dict.fromkeys(("millimetern", "milimetros", "millimetri"), 0.001),
    **dict.fromkeys(("in", "inch", "inches"), 0.0254),
    **dict.fromkeys(("ft", "foot", "feet"), 0.3048),
}

# Chinese has no blanks between words: each word becomes the English word of the tables above.
_CHINESE: Final = {
    **dict.fromkeys(("连杆长度", "杆件长度", "杆长", "长度"), "length"),
    **dict.fromkeys(("连杆扭角", "连杆扭转角", "连杆转角", "杆件扭角", "扭转角", "扭角"), "twist"),
    **dict.fromkeys(("连杆偏距", "连杆偏置", "关节偏距", "关节偏置", "偏距", "偏置"), "offset"),
    **dict.fromkeys(("连杆偏移", "关节偏移", "偏移量", "偏移"), "offset"),
    **dict.fromkeys(("关节角度", "关节转角", "关节角", "连杆夹角"), "angle"),
    **dict.fromkeys(("关节", "连杆", "杆件", "坐标系", "序号", "编号", "关节号", "轴"), "joint"),
    **dict.fromkeys(("连杆号", "轴号", "行号", "行"), "row"),
    **dict.fromkeys(("末端执行器", "末端", "工具"), "tool"),
    **dict.fromkeys(("关节变量", "变量", "关节类型", "类型", "备注", "说明", "关节范围"), "aside"),
    **dict.fromkeys(("运动范围", "变量范围", "范围"), "aside"),
    **dict.fromkeys(("距离", "转角", "旋转角", "角度", "角", "参数"), "value"),
    **dict.fromkeys(("弧度",), "rad"), **dict.fromkeys(("度",), "deg"),
    "毫米": "mm", "厘米": "cm", "米": "m",
}  # fmt: skip
_CHINESE_WORD: Final = regex("|".join(sorted(_CHINESE, key=len, reverse=True)))
# The preposition in "angolo di giunto" is not d_i.
_DI: Final = regex(r"(?<=[a-z]{3}) di (?=[a-z]{3})", re.IGNORECASE)
_HYPHEN: Final = regex(r"(?<=[a-z]{3})-(?=[a-z]{2})", re.IGNORECASE)
_ACCENTED: Final = regex(r"[à-öø-ÿßāăąćčēęěīńňōőřśšūůűźžÀ-ÖØ-ß]")
# In French, "grad" is a gon. The German noun has a capital.
_GERMAN_DEGREES: Final = regex(r"(?<![^\W\d_])Grad(?![^\W\d_])")


def in_plain_words(text: str) -> str:
    """Return a header in small letters without accents, with English words for Chinese ones."""
    text = _GERMAN_DEGREES.sub("deg", text)
    text = _CHINESE_WORD.sub(lambda word: f" {_CHINESE[word[0]]} ", text)
    text = _HYPHEN.sub(" ", _DI.sub(" ", text))
    return _ACCENTED.sub(lambda letter: _without_accent(letter[0]), text).lower()


def _without_accent(letter: str) -> str:
    return "ss" if letter == "ß" else unicodedata.normalize("NFD", letter)[0]


# --- Read the headers of a pasted DH table: the parameter in a column, and its unit


LABEL: Final = "label"
ASIDE: Final = "aside"
# A number that is added to θ, or to the variable of the joint.
THETA_OFFSET: Final = "theta offset"
OFFSET: Final = "offset"
# The letter l, which heads the link lengths or the numbers of the links.
LENGTH_OR_LABEL: Final = "l"
QUANTITIES: Final[Mapping[str, Kind]] = {
    "a": "length", "alpha": "angle", "d": "length", "theta": "angle",
}  # fmt: skip

# The names of the columns in messages.
SHOWN: Final = {"a": "a", "alpha": "α", "d": "d", "theta": "θ"}

_LONGEST_HEADER: Final = 60
# Characters that NFKC leaves alone, or replaces by wrong ones.
_SIGNS: Final = str.maketrans(
    {"⍺": "α", "∝": "α", "−": "-", "–": "-", "‐": "-", "‑": "-", "º": "°", "˚": "°"}
)
# An accent in LaTeX: \'e. And "n°", a number in French, Spanish and Italian.
_ACCENT: Final = regex(r"\\['`\"^~](?=[a-z{])")
_NUMERO_SIGN: Final = regex(r"(?<![a-z])n\.?\s?°")
# The preposition in "n° d'articulation" and "numéro de l'axe" is not d.
_OF: Final = regex(r"(?<=no|ro)\s(?:de\s)?[dl]['’](?=[a-z]{3})")
_STYLE: Final = regex(
    r"\\(?:mathrm|mathbf|mathit|mathsf|text|textbf|textit|textrm|operatorname|boldsymbol|bm|rm|bf"
    r"|boldmath|bfseries|itshape|makecell|thead)(?![a-z])|\\[,;:! ]"
)
# A unit of the package siunitx: \si{\milli\metre}.
_SIUNITX: Final = regex(r"\\(?:si|unit)\s?\{([\\a-z ]{1,30})\}")
_CIRCLE: Final = regex(r"\^\s?\(?\s?\{?\s?(?:\\circ|∘|°|o)\s?\}?\)?(?![a-z])|\\degree|∘")
_MARKER: Final = regex(r"\^\s?\{?\s?\*\s?\}?")
_SHIFTED: Final = regex(r"(?<![a-z])([ijkn])\s?-\s?1(?!\d)|([a-z])([ijkn])\s?-\s?1(?!\d)")
_WORD: Final = regex(r"[a-z]+~?|#|[^\sa-z#]")
_GLUED: Final = regex(r"(a|r|d|q|th|alpha|theta)([ijkn]~?)")
_INDEX: Final = regex(r"[ijkn]~?")
# The axis of a parameter: d_z, a_x, but d_x is the length along x.
_ALONG: Final = regex(r"(?<![a-z])(?:(a|r|d)\s?x|(d)\s?z|(alpha)\s?x|(theta|φ|phi)\s?z)(?![a-z])")
# The number of a row after the name of a parameter: θ_1, a_{2}, d(3); but not a_{i-1}.
_ROW_NUMBER: Final = regex(r"(?<=[^\W\d]|[_({])([0-9]{1,2})[)}\s*]*$")
_IGNORED: Final = frozenset(".,:;()[]{}|'\"/?_")
_DIGITS_OR_OPERATORS: Final = regex(r"[0-9+\-*/=^]")

_UNIT_NAMES: Final = "|".join(sorted((*ANGLE_UNITS, *METRES), key=len, reverse=True))
_BRACKETED_UNIT: Final = regex(rf"[(\[]\s{{0,4}}(?:(?:in|en)\s)?({_UNIT_NAMES})\s{{0,4}}[)\]]")
# "in" or "en" before a unit is a preposition, not inches.
_TRAILING_UNIT: Final = regex(
    rf"(?:[\s,;:/_]|(?<=[^a-z]))(?:(?:in|en)\s)?({_UNIT_NAMES})\s{{0,4}}$|(°)\s{{0,4}}$"
)


@dataclass(frozen=True, slots=True)
class Header:
    """The meaning of a header; ``unit`` is in small letters.

    ``column`` is a, alpha, d, theta, "label", or "aside" for a column that is ignored; it is
    "theta offset" for a number that is added to θ, and "l" for the letter l. ``shifted`` is true
    for an index such as in a_{i-1}. ``is_word`` is true for the word "offset", which means d, or
    beside a column d a number that is added to the variable of the joint.
    """

    column: str
    unit: str = ""
    shifted: bool = False
    is_word: bool = field(default=False, compare=False)

    @property
    def angle_unit(self) -> AngleUnit | None:
        """The unit of angles in the header, or None."""
        return ANGLE_UNITS.get(self.unit)

    @property
    def metres(self) -> float | None:
        """The unit of length in the header, in metres, or None: 0.001 for mm."""
        return METRES.get(self.unit)


class NamedParameter(NamedTuple):
    """The column of a parameter, and the number of its row if its name has one."""

    column: str
    row: int | None


def named_parameter(name: str) -> NamedParameter | None:
    r"""Return the DH parameter with a name such as a, \alpha_1, θ₁, d_{i}; None for other names."""
    plain = unicodedata.normalize("NFKC", name[: _LONGEST_HEADER + 1])
    number = _ROW_NUMBER.search(plain)
    header = read_header(plain[: number.start()] if number else plain)
    if header is None or header.column not in QUANTITIES or header.unit:
        return None
    return NamedParameter(header.column, int(number[1]) if number else None)


def read_header(text: str) -> Header | None:
    r"""Return the header in a cell; None if the cell is not a header.

    Examples: ``a``, ``a_{i-1}``, ``α_i (deg)``, ``link length [mm]``, ``$\theta_i$``, ``#``.
    """
    if len(text) > _LONGEST_HEADER:
        return None
    plain, unit = _plain(text)
    if ASIDES.fullmatch(plain):
        return Header(ASIDE)
    plain = _ALONG.sub(_without_axis, plain)
    found: set[str] = set()
    terms: set[str] = set()
    indices: list[str] = []
    places = False
    for word in _WORD.findall(plain):
        if glued := _GLUED.fullmatch(word):
            found.add(LETTERS[glued[1]])
            indices.append(glued[2])
        elif word in LETTERS:
            found.add(LETTERS[word])
        elif word in TERMS:
            terms.add(TERMS[word])
        elif _INDEX.fullmatch(word):
            indices.append(word)
        elif word in PLACES:
            places = True
        elif word not in FILLERS and word not in _IGNORED:
            return None
    return _decided(found, terms, unit, indices, places=places)


def _decided(
    found: set[str], terms: set[str], unit: str, indices: list[str], *, places: bool
) -> Header | None:
    if found == {"theta"} and terms == {"d"}:
        return Header(THETA_OFFSET, unit)
    if terms == {"a"}:
        # The letter of "link length l".
        found = found - {LENGTH_OR_LABEL}
    if "alpha" in found | terms:
        # "angle" in "twist angle" does not mean θ.
        terms = terms - {"theta"}
    if len(found | terms) == 1:
        [column] = found | terms
        shifted = any(index.endswith("~") for index in indices)
        return Header(column, unit, shifted, is_word="d" in terms - found)
    if not found and not terms and (places or indices) and not unit:
        return Header(LABEL)
    return None


def _without_axis(named: re.Match[str]) -> str:
    across, along, twist, turn = named.groups()
    return "a" if across else along or twist or turn


def is_wordy(text: str) -> bool:
    """True if a cell might be a header: a word or a name, but not a number or formula."""
    plain, _ = _plain(text[:_LONGEST_HEADER])
    return bool(plain.strip()) and _DIGITS_OR_OPERATORS.search(plain) is None


def _plain(text: str) -> tuple[str, str]:
    # ``~`` replaces -1.
    plain = unicodedata.normalize("NFKC", text.translate(_SIGNS)).translate(_SIGNS)
    plain = _OF.sub(" ", _NUMERO_SIGN.sub("no", _ACCENT.sub("", in_plain_words(plain))))
    plain = _SIUNITX.sub(lambda unit: unit[1].replace("\\", "").replace(" ", ""), plain)
    plain = _CIRCLE.sub("°", _MARKER.sub(" ", _STYLE.sub(" ", plain)))
    plain = plain.replace("α", " alpha ").replace("θ", " theta ")
    for mark in "\\$`*":
        plain = plain.replace(mark, " ")
    plain = plain.replace("{", "").replace("}", "")
    unit = ""
    if found := _BRACKETED_UNIT.search(plain):
        plain, unit = plain[: found.start()] + " " + plain[found.end() :], found[1]
    else:
        plain = plain.replace("_", " ")
        if trailing := _TRAILING_UNIT.search(plain.rstrip()):
            plain, unit = plain[: trailing.start()], trailing[1] or trailing[2]
    plain = " ".join(plain.replace("_", " ").split())
    return _SHIFTED.sub(lambda match: "".join(filter(None, match.groups())) + "~", plain), unit


# --- Order the rows of a pasted table by their labels: 1, 2, 3 … and e for the end effector


LAST: Final = 10_000
_LONGEST_LABEL: Final = 30
_WORDS: Final = "|".join(sorted(PLACES - {"#", "name", "label"}, key=len, reverse=True))
# Glied Nr. 1, articulation n° 1.
_NUMERO: Final = r"(?:n[or°]|num|nummer|number|numero|#)\.?\s?"
_LABEL_NUMBER: Final = regex(
    rf"(?:(?:{_WORDS}|[ijklnta#])[\s.]?)?(\d{{1,2}})\.?|(?:{_WORDS})?\s?{_NUMERO}(\d{{1,2}})"
)
# 1. Gelenk, 第1关节, and the numbers of Chinese.
_ORDINAL: Final = regex(rf"第\s?(\d{{1,2}})(?:\s?joint)?|(\d{{1,2}})\.\s?(?:{_WORDS})")
_NUMERALS: Final = str.maketrans("一二三四五六七八九", "123456789")
_STEP: Final = regex(r"(\d{1,2})\s?(?:-|→|->|to)\s?(\d{1,2})")
_END: Final = frozenset(
    {"e", "ee", "tool", "tcp", "tip", "end", "effector", "end effector", "end-effector", "n+1"}
    | {"endeffektor", "werkzeug", "effecteur", "outil", "efector final", "herramienta"}
)


def label_place(text: str) -> int | None:
    """Return the number in a row's label, LAST for an end effector; None if it is not a label.

    Examples: ``1``, ``Link 1``, ``J1``, ``{1}``, ``0→1``; ``e``, ``tool``, ``end effector``.
    """
    if len(text) > _LONGEST_LABEL:
        return None
    plain = in_plain_words(unicodedata.normalize("NFKC", text).translate(_NUMERALS))
    for mark in "${}_\\()*`":
        plain = plain.replace(mark, "")
    plain = " ".join(plain.split())
    if plain in _END:
        return LAST
    if step := _STEP.fullmatch(plain):
        return int(step[2]) if int(step[2]) == int(step[1]) + 1 else None
    number = _LABEL_NUMBER.fullmatch(plain) or _ORDINAL.fullmatch(plain)
    return int(number[number.lastindex or 1]) if number else None


def is_label(text: str) -> bool:
    """True if a cell is the label of a row."""
    return label_place(text) is not None


def in_order(labels: Sequence[GridCell]) -> tuple[list[int], tuple[Finding, ...]]:
    """Return the indices of the rows in the order of their labels, and findings on the order.

    Rows keep their order if a row has no label. Raises GridError if two rows share a label.
    """
    typed = list(range(len(labels)))
    places = [label_place(label.text) for label in labels]
    known = [place for place in places if place is not None]
    if len(known) < len(places):
        if not any(label.text for label in labels):
            return typed, ()
        unknown = next(i for i in typed if places[i] is None)
        message = say(
            "Not all rows have a number, so the rows were read in the order in which they stand."
        )
        return typed, (reading_note("row_labels", message, labels[unknown].whole),)
    if len(set(known)) < len(known):
        again = next(i for i in typed if known[i] in known[:i])
        raise GridError(
            "duplicate_row",
            say(
                "Two rows have the label {label}. Give each row its own.",
                label=labels[again].text[:_LONGEST_LABEL],
            ),
            labels[again].whole,
        )
    order = sorted(typed, key=known.__getitem__)
    if order == typed:
        return typed, ()
    moved = next(i for i in typed if order[i] != i)
    message = say("The rows were put in the order of their labels.")
    return order, (reading_note("rows_reordered", message, labels[moved].whole),)
