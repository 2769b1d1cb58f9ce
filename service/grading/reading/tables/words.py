"""Words in headers and row labels, in English, German, Spanish, French, Italian and Chinese.

Words are in small letters without accents: "articulación" is "articulacion".
"""

# "ß" is "ss". A word that means different parameters in different books, such as "Abstand", is a
# filler: the letter next to it decides, and without a letter the header is unknown.

import re
import unicodedata
from collections.abc import Mapping
from typing import Final

from service.expressions import AngleUnit
from service.regex import regex

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
