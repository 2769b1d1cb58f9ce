"""Typed text -> plain characters, each with its position in the typed text.

It knows Unicode, Greek letters, LaTeX commands and decimal commas, but no grammar.
"""

import re
import unicodedata
from collections.abc import Mapping
from dataclasses import dataclass
from itertools import product
from typing import Final

from dh_grader.expressions.errors import LIMITS, Cause, Span, UnreadableError
from dh_grader.regex import regex

# --- Greek letters and their ASCII names


NAMES: Final = {
    "α": "alpha", "β": "beta", "γ": "gamma", "δ": "delta", "ε": "epsilon", "ζ": "zeta",
    "η": "eta", "θ": "theta", "ι": "iota", "κ": "kappa", "λ": "lambda", "μ": "mu", "ν": "nu",
    "ξ": "xi", "ρ": "rho", "σ": "sigma", "τ": "tau", "υ": "upsilon", "φ": "phi",
    "χ": "chi", "ψ": "psi", "ω": "omega", "π": "pi",
    "Γ": "Gamma", "Δ": "Delta", "Θ": "Theta", "Λ": "Lambda", "Ξ": "Xi", "Π": "Pi", "Σ": "Sigma",
    "Φ": "Phi", "Ψ": "Psi", "Ω": "Omega",
}  # fmt: skip
LETTERS: Final = {name: letter for letter, name in NAMES.items()}
# Variants of the same letter: ϑ is θ, ϕ is φ, the micro sign is μ.
VARIANTS: Final = {"ϑ": "θ", "ϕ": "φ", "ϵ": "ε", "ϱ": "ρ", "ς": "σ", "ϖ": "π", "µ": "μ", "Ω": "Ω",
                   "∆": "Δ", "ϰ": "κ"}  # fmt: skip
CLASS: Final = "".join(NAMES)
# A letter's name must begin a word: theta1, but not the eta in beta.
_SPELLED: Final = "|".join(sorted(LETTERS, key=len, reverse=True))
_PARTS: Final = regex(rf"(?<![^\W\d_])(?:{_SPELLED})|.", re.DOTALL)


def spellings(name: str) -> set[str]:
    """Return all ways to write ``name``: each Greek letter as a letter or as its name."""
    # Student texts are not converted this way, because ``bη`` (b times η) would become ``beta``.
    both = NAMES | LETTERS
    parts = [{part, both.get(part, part)} for part in _PARTS.findall(name)]
    return {"".join(choice) for choice in product(*parts)}


# --- Single characters: their plain spellings, and look-alikes of plain characters


# Brackets around a fraction with a bar, and the star that marks a joint variable. No student can
# type them: a typed character of Unicode's private area is refused.
OPEN: Final = "\ue000"
CLOSE: Final = "\ue001"
MARKER: Final = "\ue002"

_OPERATORS: Final = {
    **dict.fromkeys("×·⋅∙∗•⁎✕✖⨯⨉", "*"),
    **dict.fromkeys("÷∕⁄", "/"),
    **dict.fromkeys("−–—‐‑‒―˗﹣", "-"),
    **dict.fromkeys("º˚∘◦°", "°"),
    "√": "√",
    "﹢": "+",
    "﹙": "(",
    "﹚": ")",
    # The accent in 90 degrés.
    "é": "e",
    "ˆ": "^",
    "ℓ": "l",
    "度": "°",
    # Word's invisible brackets, and the invisible signs that MathML and Word put between a function
    # and its argument, and between factors. As blanks, they make sin⁡2⁢q the sine of 2q.
    "〖": "{",
    "〗": "}",
    "\u2061": " ",
    "\u2062": " ",
}
_SPELLINGS: Final = _OPERATORS | VARIANTS
SUPERSCRIPTS: Final = dict(
    zip(
        "⁰¹²³⁴⁵⁶⁷⁸⁹⁺⁻⁽⁾ᵃᵇᶜᵈᵉᶠᵍʰⁱʲᵏˡᵐⁿᵖʳˢᵗᵘᵛʷˣʸᶻ",
        "0123456789+-()abcdefghijklmnprstuvwxyz",
        strict=True,
    )
)
SUBSCRIPTS: Final = dict(
    zip("₀₁₂₃₄₅₆₇₈₉ₐₑₕᵢⱼₖₗₘₙₒₚᵣₛₜᵤᵥₓᵦᵧᵨᵩᵪ", "0123456789aehijklmnoprstuvxβγρφχ", strict=True)
)
LOOK_ALIKES: Final = dict(
    zip(
        "аеорсухіјѕԁԛӏһԝАВЕКМНОРСТХІЅЈΑΒΕΖΗΙΚΜΝΟΡΤΥΧοßɑ∝ɵѳӨөϴп∏ℼᴨ",
        "aeopcyxijsdqlhwABEKMHOPCTXISJABEZHIKMNOPTYXoβααθθθθθππππ",
        strict=True,
    )
)
# These characters are blank, but not invisible by their Unicode category.
_BLANKS: Final = frozenset("\u115f\u1160\u2800\u3164\uffa0")
_CAUSES: Final[dict[str, Cause]] = {
    **dict.fromkeys("±∓", "plus_minus"),
    **dict.fromkeys("′″‴’‘ʹ´`ᵀ⊤", "transpose"),
    **dict.fromkeys("∛∜", "cube_root"),
    **dict.fromkeys("∞", "not_finite"),
    **dict.fromkeys("ᵒ⁰", "raised_zero"),
    **dict.fromkeys(LOOK_ALIKES, "look_alike"),
}
_FRACTION: Final = regex("[0-9]⁄[0-9]+")


def is_invisible(letter: str) -> bool:
    """True if ``letter`` is a control character, a format character or a combining mark."""
    return letter in _BLANKS or unicodedata.category(letter) in {"Cf", "Cc", "Mn", "Me"}


def plain(letter: str) -> str | None:
    """Return the plain spelling of one character, or None if it has none."""
    if " " <= letter <= "~" or letter in NAMES:
        return letter
    if letter in _SPELLINGS:
        return _SPELLINGS[letter]
    if letter.isspace():
        return " "
    if letter in _CAUSES or is_invisible(letter):
        return None
    return _compatible(letter)


def _compatible(letter: str) -> str | None:
    form = unicodedata.normalize("NFKC", letter)
    if _FRACTION.fullmatch(form):
        return f"{OPEN}{form.replace('⁄', '/')}{CLOSE}"
    form = VARIANTS.get(form, form)
    is_styled = 0xFF01 <= ord(letter) <= 0xFF5E or 0x1D400 <= ord(letter) <= 0x1D7FF
    return form if is_styled and (" " <= form <= "~" or form in NAMES) else None


def cause(letter: str) -> Cause:
    """Return the reason why a character without a plain spelling cannot be read."""
    return _CAUSES.get(letter) or ("invisible" if is_invisible(letter) else "character")


# --- LaTeX commands and their plain spellings


FUNCTIONS: Final = {
    **{name: name for name in ("sin", "cos", "tan", "exp", "atan", "asin", "acos", "tg", "abs")},
    **{name: name for name in ("arcsin", "arccos", "arctan", "arctg", "sind", "cosd", "tand")},
    **{name: name for name in ("sec", "csc", "cosec", "cot", "cotg", "ctg", "sen", "arcsen")},
    # These are refused by their names, which is clearer than an unknown command.
    **{name: name for name in ("log", "ln", "lg", "sinh", "cosh", "tanh", "coth", "max", "min")},
    **{name: name for name in ("det", "gcd", "sgn", "arsinh", "arcosh")},
}
PLAIN: Final = {
    **LETTERS,
    **{f"up{name}": letter for name, letter in LETTERS.items() if name.islower()},
    **{f"var{name}": letter for name, letter in LETTERS.items() if name[0].isupper()},
    "vartheta": "θ", "varphi": "φ", "varepsilon": "ε", "varrho": "ρ", "varsigma": "σ",
    "cdot": "*", "times": "*", "ast": "*", "bullet": "*", "div": "/", "ell": "l",
    "ldotp": "*", "cdotp": "*", "slash": "/",
    "degree": "°", "degrees": "°", "textdegree": "°", "circ": "°", "deg": " deg ", "rad": " rad ",
    "lbrace": "{", "rbrace": "}", "lbrack": "[", "rbrack": "]",
    "vert": "|", "lvert": "|", "rvert": "|", "mid": "|", "star": MARKER,
}  # fmt: skip
FRACTIONS: Final = frozenset({"frac", "tfrac", "dfrac", "cfrac", "nicefrac", "sfrac", "flatfrac"})
# Numbers and units in the package siunitx.
QUANTITIES: Final = frozenset({"SI", "qty", "si", "unit", "num"})
UNITS: Final = frozenset({"si", "unit"})
ANGLE_UNITS: Final = {
    **dict.fromkeys(("degree", "deg", "°", "degrees", "arcdegree"), "°"),
    **dict.fromkeys(("radian", "rad"), " rad "),
}
# Commands that only style their argument.
STYLES: Final = frozenset({
    "mathrm", "mathit", "mathbf", "mathsf", "mathtt", "mathnormal", "boldsymbol", "bm",
    "text", "textrm", "textit", "textnormal", "mbox", "operatorname", "mathop", "mathord",
})  # fmt: skip
# Commands that mean nothing by themselves.
SPACES: Final = frozenset({
    "quad", "qquad", "thinspace", "medspace", "thickspace", "enspace", "enskip", "displaystyle",
    "textstyle", "scriptstyle", "limits", "nolimits", "left", "right", "big", "Big", "bigg", "Bigg",
    "bigl", "Bigl", "biggl", "Biggl", "bigr", "Bigr", "biggr", "Biggr", "bigm", "middle",
    "mleft", "mright", "relax", "nonumber", "notag", "strut", "allowbreak",
})  # fmt: skip
# Commands that style the rest of their group: {\it q}.
SWITCHES: Final = frozenset({
    "rm", "it", "bf", "sf", "tt", "sl", "em", "cal", "mit", "normalfont", "upshape", "bfseries",
})  # fmt: skip
# Commands that are skipped together with their argument.
IGNORED: Final = frozenset({"hspace", "vspace", "phantom", "hphantom", "vphantom", "label"})
BLANK_SYMBOLS: Final = frozenset(",;:!> /()[]")

COMMAND: Final = regex(r"\\(?:([A-Za-z]+)\*?|(.))", re.DOTALL)
# Environments around one formula.
ENVIRONMENT: Final = regex(
    r"\s*\{\s*(?:equation|displaymath|math|align|aligned|gather|gathered|split|multline)\*?\s*\}"
)
# The product sign of SymPy's latex(..., mul_symbol="ldot").
DOT_BETWEEN_SPACES: Final = regex(r"\\,\s*\.\s*\\,")
# A letter as Mathematica writes it in plain text: \[Theta].
NAMED_LETTER: Final = regex(r"\\\[(Capital|Curly)?([A-Z][a-z]+)\]")
_BRACE: Final = regex(r"\\.|[{}]", re.DOTALL)
RAISED_CIRCLE: Final = regex(
    r"\^\s*(?:\\(?:circ|degree)(?![A-Za-z])|\{\s*\\(?:circ|degree)\s*\}|[°∘◦]|\{\s*[°∘◦]\s*\})"
)
_STAR: Final = r"(?:[*∗⋆]|\\(?:ast|star)(?![A-Za-z]))"
RAISED_STAR: Final = regex(rf"\^\s*(?:{_STAR}(?!\*)|\{{\s*{_STAR}\s*\}})|⋆")


def known_prefix(name: str) -> str | None:
    """Return the longest known command at the beginning of ``name`` (cos in cosq), or None."""
    for end in range(len(name) - 1, 1, -1):
        if name[:end] in FUNCTIONS or name[:end] in PLAIN:
            return name[:end]
    return None


def brace_partners(source: str) -> dict[int, int]:
    """Map the position of each opening brace to the position of its closing brace.

    Braces without a partner are left out.
    """
    partners: dict[int, int] = {}
    opened: list[int] = []
    for match in _BRACE.finditer(source):
        if match.group() == "{":
            opened.append(match.start())
        elif match.group() == "}" and opened:
            partners[opened.pop()] = match.start()
    return partners


# --- Convert typed text to plain characters, each with its position in the typed text
#
# Unambiguous characters (× · − ² ₁ ½ ° π, variants of Greek letters) and LaTeX are converted.
# Look-alike or invisible characters are errors. \frac{a}{b} becomes ⟨{a}/{b}⟩, where ⟨ and ⟩ are
# private brackets that no student can type.


_DECIMAL_COMMA: Final = regex(r"(?<=[0-9])\{,\}(?=[0-9])")
# Words in braces that are longer cannot be the stem of a name.
_LONGEST_STEM: Final = 24
_POWER: Final = regex(r"[+-]?[0-9]+|[A-Za-z]")
# These separate cells or lines, so they do not stand for a product.
BREAKS: Final = frozenset("\t\n\r\v\f\x1c\x1d\x1e\x85\u2028\u2029")
_PLAIN: Final = regex(r"[ -#%-\[\]^_a-z|]*")
_CHUNK: Final = regex(rf"[A-Za-z0-9{CLASS} +\-*/().,|\[\]{{}}]+")
_INDEX: Final = regex(rf"[A-Za-z0-9{CLASS} _*]*")
# An index as Word writes it in one line: θ_(1).
_BRACKETED_INDEX: Final = regex(r"\(\s*([A-Za-z0-9]+)\s*\)")
_PLAIN_INDEX: Final = regex(r"_[A-Za-z0-9]+")
# An index with a blank before the underscore, or in round brackets.
_SPACED_INDEX: Final = regex(r" _|_\(")


@dataclass(frozen=True, slots=True)
class Characters:
    """Plain text, and the position [start, end) of each of its characters in the typed text.

    ``starts`` and ``ends`` are None if the text was not changed.
    """

    text: str
    starts: list[int] | None = None
    ends: list[int] | None = None


def normalise(source: str) -> Characters:
    """Return ``source`` in plain characters. Raises UnreadableError for an unreadable character."""
    if (
        _PLAIN.fullmatch(source)
        and "^*" not in source
        and ("_" not in source or not _SPACED_INDEX.search(source))
    ):
        return Characters(source)
    return _Normaliser(source).run()


class _Normaliser:
    # It collects plain characters; ``partners`` are the pairs of braces in ``source``, if known.

    def __init__(self, source: str, partners: dict[int, int] | None = None) -> None:
        self.source = source
        self.letters: list[str] = []
        self.starts: list[int] = []
        self.ends: list[int] = []
        self.dollars = source.count("$") % 2 == 0
        self.commas = [] if "{,}" not in source else list(_DECIMAL_COMMA.finditer(source))[::-1]
        self.partners = partners

    def run(self) -> Characters:
        self._range(0, len(self.source), 0)
        return Characters("".join(self.letters), self.starts, self.ends)

    def _range(self, position: int, end: int, depth: int) -> None:
        if depth > LIMITS.depth:
            raise UnreadableError("beyond", (position, end), limit="depth")
        while position < end:
            chunk = _CHUNK.match(self.source, position, end)
            if chunk is None:
                position = self._step(position, end, depth)
            elif self.commas and (comma := self.commas[-1]).start() < chunk.end():
                self.commas.pop()
                if comma.start() < position:
                    continue
                self._copy(position, comma.start())
                position = self._emit(".", *comma.span())
            else:
                self._copy(position, chunk.end())
                position = chunk.end()

    def _step(self, at: int, end: int, depth: int) -> int:
        letter = self.source[at]
        if letter == "\\":
            return self._command(at, end, depth)
        if letter in "^⋆":
            return self._caret(at, end, depth)
        if letter == "_":
            return self._underscore(at, end, depth)
        if letter in SUBSCRIPTS or letter in "₊₋":
            return self._subscript_run(at)
        if letter in SUPERSCRIPTS:
            return self._superscript_run(at)
        if letter == "~" or (letter == "$" and self.dollars):
            return self._emit(" ", at, at + 1)
        text = plain(letter)
        if text is None:
            raise UnreadableError(cause(letter), (at, at + 1))
        return self._emit(text, at, at + 1)

    # --- indices and powers

    def _caret(self, at: int, stop: int, depth: int) -> int:
        """Read the sign ^ as a power, a degree sign or the star of a joint variable."""
        if circle := RAISED_CIRCLE.match(self.source, at):
            return self._emit("°", at, circle.end())
        star = RAISED_STAR.match(self.source, at)
        if star is None:
            return self._emit("^", at, at + 1)
        end = star.end()
        # The index may follow the star: θ^*_1.
        index = _PLAIN_INDEX.match(self.source, end)
        if index is not None:
            self._copy(*index.span())
            end = index.end()
        elif self.source[end : end + 2] == "_{":
            end = self._underscore(end, stop, depth)
        self._emit(MARKER, at, star.end())
        return end

    def _underscore(self, at: int, end: int, depth: int) -> int:
        r"""Read _1, _{12}, _\alpha and _{\theta_1}: an index of letters and digits."""
        self._attach_index()
        start = self._skip_blanks(at + 1, end)
        if start < end and self.source[start] == "{":
            stop = self._partner(start, end)
            inside, after = (start + 1, stop), stop + 1
        elif bracketed := _BRACKETED_INDEX.match(self.source, start, end):
            inside, after = bracketed.span(1), bracketed.end()
        elif command := COMMAND.match(self.source, start, end):
            after = command.end()
            if command[1] in STYLES:
                after = self._argument(start, after, end)[2]
            inside = start, after
        else:
            return self._emit("_", at, at + 1)
        content = _Normaliser(self.source, self.partners)
        content._range(*inside, depth + 1)
        text = "".join(content.letters)
        if not text.strip() or not _INDEX.fullmatch(text):
            raise UnreadableError("subscript", (at, after), index=self.source[slice(*inside)])
        self._emit("_", at, inside[0])
        stars: list[Span] = []
        # An underscore before each letter keeps the index whole: l_{1h} is not l_1 times h.
        mark = "_" if not text.isdigit() else ""
        written = ""
        for letter, place in zip(text, zip(content.starts, content.ends, strict=True), strict=True):
            if letter == "*":
                stars.append(place)
            elif letter not in " _":
                self._emit(f"{written}{letter}", *place)
                written = mark
        self.ends[-1] = after
        # Add a blank so that q_{1}2 does not become q12.
        self._emit(" " if self.source[after : after + 1].isdigit() else "", at, at)
        for star in stars:
            self._emit(MARKER, *star)
        return after

    def _subscript_run(self, at: int) -> int:
        """Read subscript characters such as ₁₂ as one index; return the position after them."""
        self._attach_index()
        end = self._end_of_run(at, SUBSCRIPTS)
        if self.source[end : end + 1] in {"₊", "₋"}:
            raise UnreadableError("subscript", (at, end + 1), index=self.source[at:end])
        for place in range(at, end):
            digit = SUBSCRIPTS[self.source[place]]
            # As in ``_underscore``: l₁ₕ is not l₁ times h.
            self._emit(digit if digit.isdigit() and place > at else f"_{digit}", place, place + 1)
        if self.source[end : end + 1].isdigit():
            self._emit(" ", end, end)
        return end

    def _superscript_run(self, at: int) -> int:
        """Read superscript characters such as ⁻¹ as one power; return the position after them."""
        end = self._end_of_run(at, SUPERSCRIPTS)
        if self.source[at:end] == "⁰" and self.source[at - 1 : at].isdigit():
            raise UnreadableError("raised_zero", (at, end))
        power = "".join(SUPERSCRIPTS[letter] for letter in self.source[at:end])
        is_simple = _POWER.fullmatch(power) is not None
        self._emit("^" if is_simple else "^(", at, at)
        self._spell(SUPERSCRIPTS, at, end)
        # Add a blank so that x²3 does not become x^23.
        self._emit(" " if is_simple else ")", end, end)
        return end

    def _end_of_run(self, at: int, table: Mapping[str, str]) -> int:
        end = at
        while end < len(self.source) and self.source[end] in table:
            end += 1
        return end

    def _spell(self, table: Mapping[str, str], at: int, end: int) -> None:
        for place in range(at, end):
            self._emit(table[self.source[place]], place, place + 1)

    def _attach_index(self) -> None:
        r"""Remove blanks and braces before an index: \theta _1, {\theta}_1, {\rm c}_1."""
        letters = self.letters
        while letters and letters[-1] == " " and self.source[self.starts[-1]] in " \\":
            self._drop(len(letters) - 1)
        if not letters or letters[-1] != "}":
            return
        for at in range(len(letters) - 2, max(-1, len(letters) - _LONGEST_STEM - 2), -1):
            if letters[at] == "{":
                # After these, a brace encloses an index, a power or the operand of a root.
                if at + 2 < len(letters) and (at == 0 or letters[at - 1] not in "_^√"):
                    letters[at] = " "
                    self._drop(len(letters) - 1)
                return
            if not letters[at].isalpha() and letters[at] != " ":
                return

    # --- LaTeX

    def _command(self, at: int, end: int, depth: int) -> int:
        match = COMMAND.match(self.source, at, end)
        if match is None:
            raise UnreadableError("command", (at, at + 1), name="")
        name, symbol = match.groups()
        after = match.end()
        if symbol is not None:
            return self._symbol(symbol, at, after, end)
        if self.source[after - 1] == "*" and name not in STYLES:
            after -= 1
        if name in PLAIN:
            # Empty braces only end the name of a command.
            after += 2 * self.source.startswith("{}", after)
            return self._emit(PLAIN[name], at, after)
        if name in FUNCTIONS:
            return self._function(FUNCTIONS[name], at, after)
        if name in SPACES:
            return self._emit(" ", at, after)
        return self._structure(name, at, after, end, depth)

    def _structure(self, name: str, at: int, after: int, end: int, depth: int) -> int:
        if name in STYLES:
            is_word = name == "operatorname"
            return self._styled(self._argument(at, after, end), at, depth, is_word=is_word)
        if name in SWITCHES:
            return self._switch(at, after, end, depth)
        if name in FRACTIONS:
            return self._fraction(at, after, end, depth)
        if name == "sqrt":
            return self._root(at, after, end, depth)
        if name == "over":
            return self._over(at, after, depth)
        if name == "ang":
            return self._emit("°", after, self._braced(at, after, end, depth))
        if name in QUANTITIES:
            return self._quantity(name, at, after, end, depth)
        if (stop := self._without_meaning(name, at, after, end)) is not None:
            return self._emit(" ", at, stop)
        causes: dict[str, Cause] = {"pm": "plus_minus", "mp": "plus_minus", "infty": "not_finite"}
        raise UnreadableError(causes.get(name, "command"), (at, after), name=name)

    def _without_meaning(self, name: str, at: int, after: int, end: int) -> int | None:
        if name in IGNORED:
            return self._argument(at, after, end)[2]
        environment = ENVIRONMENT.match(self.source, after, end)
        return environment.end() if environment and name in {"begin", "end"} else None

    def _symbol(self, symbol: str, at: int, after: int, end: int) -> int:
        if symbol == "," and (dot := DOT_BETWEEN_SPACES.match(self.source, at, end)):
            return self._emit("*", at, dot.end())
        named = NAMED_LETTER.match(self.source, at, end) if symbol == "[" else None
        if named is not None:
            name = named[2] if named[1] == "Capital" else named[2].lower()
            plain = PLAIN.get(name)
            if plain is None:
                raise UnreadableError("command", named.span(), name="")
            return self._emit(plain, at, named.end())
        if symbol in "{}_*":
            return self._emit(symbol, at, after)
        if symbol in BLANK_SYMBOLS:
            return self._emit(" ", at, after)
        raise UnreadableError("command", (at, after), name=symbol)

    def _function(self, name: str, at: int, after: int) -> int:
        r"""Emit a function's name between blanks, so that a\sin x is not read as asin x."""
        if self.letters and self.letters[-1].isalpha():
            self._emit(" ", at, at)
        self._emit(name, at, after)
        following = self.source[after : after + 1]
        if following not in {"_", "^"} and not following.isdigit():
            self._emit(" ", after, after)
        return after

    def _styled(
        self, argument: tuple[int, int, int], at: int, depth: int, *, is_word: bool = False
    ) -> int:
        start, stop, after = argument
        inside = self.source[start:stop]
        is_word = is_word or sum(map(str.isalpha, inside)) > 1
        if is_word and self.letters and self.letters[-1].isalpha():
            self._emit(" ", at, at)
        first = len(self.letters)
        self._range(start, stop, depth + 1)
        if "$" in inside:
            self._without_blanks(first)
        following = self.source[after : after + 1]
        if is_word and (following.isalpha() or following == "\\"):
            self._emit(" ", after, after)
        return after

    def _without_blanks(self, first: int) -> None:
        r"""Remove the blanks that Mathematica prints in names: \text{$\theta $1}."""
        kept = [i for i in range(first, len(self.letters)) if self.letters[i] != " "]
        letters, starts, ends = self.letters, self.starts, self.ends
        places = [(letters[i], starts[i], ends[i]) for i in kept]
        self._drop(first)
        for place in places:
            self._emit(*place)

    def _switch(self, at: int, after: int, end: int, depth: int) -> int:
        r"""Read {\rm cos} as \mathrm{cos}."""
        if not self.letters or self.letters[-1] != "{" or self.source[self.starts[-1]] != "{":
            return self._emit(" ", at, after)
        opener = self.starts[-1]
        stop = self._partner(opener, len(self.source))
        if stop >= end:
            return self._emit(" ", at, after)
        self._drop(len(self.letters) - 1)
        start = self._skip_blanks(after, stop)
        inner = stop
        if self.source[start] == "{" and self._partner(start, end) == stop - 1:
            start, inner = start + 1, stop - 1
        return self._styled((start, inner, stop + 1), opener, depth)

    def _over(self, at: int, after: int, depth: int) -> int:
        r"""Read {a \over b} as \frac{a}{b}."""
        level = 0
        for place in range(len(self.letters) - 1, -1, -1):
            letter = self.letters[place]
            level += (letter == "}") - (letter == "{")
            if level < 0:
                break
        if level >= 0 or self.source[self.starts[place]] != "{":
            raise UnreadableError("argument", (at, after), name=self.source[at:after])
        opener = self.starts[place]
        stop = self._partner(opener, len(self.source))
        self.letters.insert(place, OPEN)
        self.starts.insert(place, opener)
        self.ends.insert(place, opener)
        self._emit("}/{", at, after)
        self._range(after, stop, depth + 1)
        self._emit("}", stop, stop + 1)
        return self._emit(CLOSE, stop, stop + 1)

    def _fraction(self, at: int, after: int, end: int, depth: int) -> int:
        self._emit(OPEN, at, after)
        after = self._braced(at, after, end, depth)
        self._emit("/", at, at)
        after = self._braced(at, after, end, depth)
        self._emit(CLOSE, after - 1, after)
        return after

    def _root(self, at: int, after: int, end: int, depth: int) -> int:
        start = self._skip_blanks(after, end)
        if self.source[start : start + 1] == "[":
            raise UnreadableError("cube_root", (at, start + 1))
        self._emit("√", at, after)
        return self._braced(at, after, end, depth)

    def _quantity(self, name: str, at: int, after: int, end: int, depth: int) -> int:
        r"""Read \SI{90}{\degree} as 90°, \si{\degree} as °, and \num{0.3} as 0.3.

        Raises UnreadableError if the unit is not a unit of angles.
        """
        if name == "num":
            return self._braced(at, after, end, depth)
        has_number = name not in UNITS
        unit_at = self._argument(at, after, end)[2] if has_number else after
        unit, unit_end = self._angle_unit(at, unit_at, end)
        if has_number:
            self._braced(at, after, end, depth)
        return self._emit(unit, unit_at if has_number else at, unit_end)

    def _angle_unit(self, at: int, after: int, end: int) -> tuple[str, int]:
        start, stop, unit_end = self._argument(at, after, end)
        unit = ANGLE_UNITS.get(self.source[start:stop].strip().lstrip("\\"))
        if unit is None:
            raise UnreadableError("quantity", (at, unit_end))
        return unit, unit_end

    def _braced(self, at: int, after: int, end: int, depth: int) -> int:
        start, stop, after = self._argument(at, after, end)
        braced = stop < after
        self._emit("{", start - braced, start)
        self._range(start, stop, depth + 1)
        self._emit("}", stop, after)
        return after

    def _argument(self, at: int, after: int, end: int) -> tuple[int, int, int]:
        start = self._skip_blanks(after, end)
        if start >= end or self.source[start] in "}+-*/)]":
            raise UnreadableError("argument", (at, after), name=self.source[at:after])
        if self.source[start] == "{":
            stop = self._partner(start, end)
            return start + 1, stop, stop + 1
        command = COMMAND.match(self.source, start, end)
        stop = command.end() if command else start + 1
        return start, stop, stop

    def _skip_blanks(self, at: int, end: int) -> int:
        while at < end and self.source[at].isspace():
            at += 1
        return at

    def _partner(self, at: int, end: int) -> int:
        if self.partners is None:
            self.partners = brace_partners(self.source)
        place = self.partners.get(at, end)
        if place >= end:
            raise UnreadableError("unclosed", (at, at + 1))
        return place

    # --- writing

    def _copy(self, start: int, end: int) -> None:
        self.letters.extend(self.source[start:end])
        self.starts.extend(range(start, end))
        self.ends.extend(range(start + 1, end + 1))

    def _emit(self, text: str, start: int, end: int) -> int:
        for letter in text:
            self.letters.append(letter)
            self.starts.append(start)
            self.ends.append(end)
        return end

    def _drop(self, at: int) -> None:
        del self.letters[at:], self.starts[at:], self.ends[at:]


# --- Numbers with a decimal comma, for exercises that allow it: 1,5 is 1.5
#
# A semicolon separates arguments: atan2(1,5; 2).


# A number with one comma. In 1,2,3 and in 1.5,2 a comma separates values.
_NUMBER: Final = regex(r"(?<![0-9A-Za-z_.])(?<![0-9],)([0-9]+),([0-9]+)(?![0-9]|[.,][0-9])")
# A semicolon between the arguments of a function.
_BETWEEN_ARGUMENTS: Final = regex(r";(?=[^();]*(?:\([^()]*\)[^();]*)*\))")


def with_points(text: str) -> str:
    """Replace each decimal comma by a point: 1,5 becomes 1.5. All other characters stay."""
    return _NUMBER.sub(r"\1.\2", text) if "," in text else text


def with_points_and_commas(text: str) -> str:
    """Replace decimal commas by points, and semicolons between arguments by commas."""
    text = with_points(text)
    return _BETWEEN_ARGUMENTS.sub(",", text) if ";" in text else text
