"""What stands around a pasted table or matrix: sentences, code fences, assignments.

A sentence that names a unit or corrects the table is an error, because it may change it.
"""

import re
import unicodedata
from bisect import bisect_left
from collections import Counter
from collections.abc import Callable, Iterator, Sequence, Set
from dataclasses import dataclass
from typing import Final

from dh_grader.expressions.errors import Note, Span
from dh_grader.pasting.program import begins_as_matrix, text_around, without_remarks
from dh_grader.pasting.remarks import may_change
from dh_grader.pasting.source import BARS, GridError, SourceText, joined, split_blanks
from dh_grader.regex import regex
from dh_grader.translations import say

# --- Remove sentences around a pasted table or matrix
#
# A line with words but without a separator of cells is a sentence. A sentence that names a unit is
# an error, because the unit may apply to the table. So is a sentence that may correct the table.


_QUOTED: Final = regex(r"^[ \t]{0,3}>(?!>)(?=[ \t|]) ?", re.MULTILINE)
_FENCE: Final = regex(r"[ \t]*(?:```|~~~)[`~]{0,3}[ \t]*[\w+-]{0,20}[ \t]*")
# The separators of rows; the first that at least two lines have is the one of the table.
_SEPARATORS: Final = (BARS, "\t", "&", ";", ",")
# A bracket that is not the unit in a header.
_PROGRAM: Final = regex(r"\[(?!(?:in )?(?:[cm]?m|deg|rad|°)\])|■|<<|(?<!\w)(?:dict|np|sp)(?!\w)")
_ENVIRONMENT: Final = regex(r"\\(?:begin|end) ?\{(?!document\})|\\[\[\]]|\$\$")
_PADDING: Final = " \t;,"
_EMPTY_CELLS: Final = frozenset({"\t\t", ";;", ",,"})
# A line of one or two words, which may be short: "DH", "% DH", "End".
_FEW_WORDS: Final = regex(
    r"[%#*\s]*(?:(?!pi\b)[^\W\d_]{2,}(?: [^\W\d_]+)?"
    r"|[A-Z]\w{0,3} (?:[Mm]atri[xz]|[Mm]atrice|[Tt]able|[Tt]ab(?:elle|la|leau)))\s?[.!:]?"
)
_MOST_WORDS: Final = 2
_FEWEST_ROWS: Final = 2
# A rule, a mail address or an address on the web.
_ASIDE: Final = regex(r"[-=_*~#+\s]{2,200}|[\w.+-]{1,64}@[\w.-]{1,64}|https?://\S{1,200}")
_DOCSTRING: Final = regex(r"^[ \t]*[rRuU]?(\"{3}|'{3})", re.MULTILINE)
# A number that is no student's.
_NUMBER: Final = regex(r"(?<![\w.])\d{1,4}(?:\.\d{1,12})?(?!\w)")
_PLAIN_WORD: Final = regex(r"[(\"„“]?(?:[^\W\d_]+(?:['’-][^\W\d_]+)*|\d{5,9})[).,:;!?\"“”]{0,3}")
# Signs of a sentence or of a student's name, which the words of headers do not have.
_SENTENCE: Final = regex(
    r"[.,:;!?'’]|\d{5}|(?<!\w)(?:is|are|this|the|here|my|ist|sind|das|hier|meine?|und|viele"
    r"|est|voil[aà]|voici|mon|ma|es|est[ae]|mi|gracias|merci|danke|thanks)(?!\w)|我的|答案|谢谢",
    re.IGNORECASE,
)
# A function's call in a program.
_CALL: Final = regex(r"\w\(")
# Signs of a row with several values.
_SEVERAL: Final = regex(r"[\s,;\[\]]")
# Signs of a formula, a row or a program.
_SIGNS: Final = regex(rf"[{BARS}\t&;=\\\[\]{{}}@■<>]")
# A name in a sentence of Markdown or LaTeX, a reference, or an escaped star.
_INLINE: Final = regex(
    r"\$[^$=\n]{1,60}\$|\\\([^=\n]{1,60}?\\\)|~?\\(?:(?:eq)?ref|label|cite)\{[^{}]{0,40}\}|\\(?=[*_#])"
    r"|\\(?:documentclass|usepackage)(?:\[[^][]{0,80}\])?\{[\w,]{1,80}\}|\\(?:begin|end)\{document\}"
)
# A command of LaTeX with words in it.
_COMMAND: Final = regex(
    r"\\(?:(?:sub){0,2}section|(?:sub)?paragraph|chapter|title|emph|text(?:bf|it))\*?\{([^{}]{0,200})\}"
)
_ONLY_COMMAND: Final = regex(r"\\[a-z][^$]*\Z")
# A legend of the stars that mark joint variables.
_LEGEND: Final = regex(r"\*+\)?\s?[=:]")
_WORD: Final = regex(
    r"(?<!\w)(?!(?:alpha|theta|sqrt|atan2?)(?!\w))[^\W\d_]{4,}(?!\w)|[\u4e00-\u9fff]{2}"
)
_PARAMETER: Final = regex(r"(?<!\w)(?:alpha|alfa|theta|th|[adrqθα])(?=_|[^\w']|\Z)")
_CONTROL: Final = regex(r"[ \t]*(?:for|while|if|elif|else|def|class|try|with|lambda)(?!\w)")
_TITLE: Final = regex(
    r"[ \t]*(?:#|\*\*|(?:table|tabelle|tab\.|tabla|tableau|tabella|表) ?\d)|.*[:：][ \t]*\Z"
    # A footnote, or a sentence.
    r"|[ \t]*(?:[*∗†‡]{1,2} ?[^\W\d_]{4}|(?:note|hinweis|nota|remarque)\b)|[^\d=\n]{20,200}\.\Z",
    re.IGNORECASE,
)
_FREEDOM: Final = regex(
    r"degrees? of freedom|freiheitsgrade?|grados de libertad|degrés? de liberté|自由度",
    re.IGNORECASE,
)
UNIT: Final = regex(
    r"(?<![^\W\d_])(?:deg(?:rees?)?|degrés?|grad|grados?|gradi|rad(?:ian\w{0,4})?|bogenma(?:ß|ss)"
    r"|[cmd]m|(?:milli|centi|mili|zenti)?m(?:et(?:er|re|ro)s?|ètres?)|inch(?:es)?)(?![^\W\d_])"
    r"|°|弧度|度|毫米|厘米|米|(?<!\w)(?:in|en) m(?!\w)",
    re.IGNORECASE,
)
# Words of a sentence after the table, by which something in it should be different.
_CORRECTS: Final = regex(
    r"correction|erratum|typo|mistake|wrong|(?:should|must)(?: \w+){0,3} be(?!\w)|instead"
    r"|rather than|(?<!\w)not (?:0|[+-]?\d|[a-zαθ]_?\w?(?!\w))"
    r"|korrektur|korrigier|berichtig|falsch|fehler|stattdessen|(?<!\w)statt(?!\w)|sollte|muss(?!\w)"
    r"|erreur|corrig|au lieu|devrait|faute|faux"
    r"|errata|corrección|correg|en (?:lugar|vez) de|debería|equivoc|更正|纠正|错误|应为|应该|改为",
    re.IGNORECASE,
)


def without_titles(
    source: SourceText, *, of_table: bool = False
) -> tuple[SourceText, tuple[Note, ...]]:
    """Return the text without the sentences around the table, and a note on the sentences.

    Raises GridError if a sentence names a unit.
    """
    lines = [line for line in source.lines() if line.text.strip()]
    is_row = _row_test(source.text, lines, of_table=of_table)
    # In a spreadsheet, a title or a remark is followed by empty cells.
    inner = [i for i, line in enumerate(lines) if not _is_padded(line.text)] or range(len(lines))
    rows = [i for i, line in enumerate(lines) if inner[0] <= i <= inner[-1] and is_row(line.text)]
    if not rows or len(rows) == len(lines):
        return source, ()
    first, last = rows[0], rows[-1]
    around = [*lines[:first], *lines[last + 1 :]]
    if not around or not all(map(_is_aside, around)):
        return source, ()
    check_sentences(lines[:first], lines[last + 1 :])
    return _between(source, lines[first], lines[last]), (left_aside(around[0].whole),)


def _is_aside(line: SourceText) -> bool:
    text = line.text.strip(_PADDING)
    return is_sentence(text) or _ASIDE.fullmatch(text) is not None


def left_aside(place: Span) -> Note:
    """Return the note that the lines around a table were ignored; the first is at ``place``."""
    message = say("The lines around the table or matrix were ignored.")
    return Note("text_left_aside", message, place)


def _row_test(text: str, lines: list[SourceText], *, of_table: bool) -> Callable[[str], bool]:
    if marks := [i for i, line in enumerate(lines) if _ENVIRONMENT.search(line.text)]:
        within = {line.text for line in lines[marks[0] : marks[-1] + 1]}
        return within.__contains__
    if "\\begin" in text or "\\\\" in text:
        return lambda line: "\\" in line or "$" in line
    if not _PROGRAM.search(text):
        for separator in _SEPARATORS:
            counts = [sum(map(line.text.count, separator)) for line in lines]
            rows = [count for count in counts if count]
            if separator == "," and sum(count > 1 for count in rows) > 1:
                # A sentence may have a comma.
                return lambda line: line.count(",") > 1
            if len(rows) > 1 and min(rows) > 1:
                return lambda line: any(map(line.__contains__, separator))
        if not any(sign in text for separator in _SEPARATORS[:-1] for sign in separator) and (
            of_columns := _row_test_of_columns(lines, of_table=of_table)
        ):
            return of_columns
    heading = lines[0].text if len(lines) > 1 and _has_heading(lines) else None
    return lambda line: (
        line != heading and (not _TITLE.match(line) or "(" in line or bool(_CONTROL.match(line)))
    )


def _row_test_of_columns(
    lines: list[SourceText], *, of_table: bool
) -> Callable[[str], bool] | None:
    # Between blanks, the rows are the lines with the most frequent number of values.
    counts = {line.text: len(split_blanks(line).elements) for line in lines}
    numbers = Counter(counts[line.text] for line in lines if counts[line.text] > _MOST_WORDS)
    [(width, rows)] = numbers.most_common(1) or [(0, 0)]
    # A sentence may have as many words as a row has values.
    words = [line.text for line in lines if counts[line.text] == width and _is_words(line.text)]
    if of_table:
        # The headers of a table may be words, and the reader of tables knows the number of rows.
        words = [text for text in words if _SENTENCE.search(text)]
    if words and rows - len(words) >= (_FEWEST_ROWS if of_table else width):
        counts.update(dict.fromkeys(words, 0))
        rows -= len(words)
    others = [line for line, count in counts.items() if count != width]
    if rows < _FEWEST_ROWS or not others or any(map(_CALL.search, others)):
        return None
    if any(len(_NUMBER.findall(line)) > 1 for line in others):
        return None  # it may be a row with a value too few or too many
    return lambda line: counts.get(line) == width


def _is_words(line: str) -> bool:
    """True if a line is a sentence or a name, of words and a student's number only."""
    return is_sentence(line) and all(map(_PLAIN_WORD.fullmatch, line.split()))


def _has_heading(lines: list[SourceText]) -> bool:
    """True if the first line is a heading."""
    # A heading is one word above rows of several values, or one or two words above a bracket.
    first, *others = (line.text.strip() for line in lines)
    # A comment of a program is removed with the other comments.
    if first[0] in "%#" or not _is_few_words(first) or not _WORD.search(first):
        return False
    if "[" in others[0] or all(len(line.split()) > _MOST_WORDS for line in others):
        return True
    return " " not in first and all(map(_SEVERAL.search, others))


def _is_padded(line: str) -> bool:
    return line.rstrip("\r\n ")[-2:] in _EMPTY_CELLS and is_sentence(line.strip(_PADDING))


def is_sentence(line: str) -> bool:
    """True if a line has words, and no signs of a formula, of headers or of cells."""
    plain = _INLINE.sub(" ", _COMMAND.sub(r"\1 ", line)).strip()
    if _is_few_words(plain) or (not plain and _ONLY_COMMAND.match(line)):
        return True
    if not _WORD.search(plain) or _SIGNS.search(_LEGEND.sub("", plain)):
        return False
    return len({name[0] for name in _PARAMETER.finditer(plain.lower())}) <= 1


def _is_few_words(line: str) -> bool:
    return bool(_FEW_WORDS.fullmatch(line)) and not _PARAMETER.search(line.lower())


def check_sentences(before: list[SourceText], after: list[SourceText]) -> None:
    """Raise GridError if a sentence before or after the table may change its meaning."""
    for line in (*before, *after):
        check_units(line)
    for line in (*before, *after):
        if may_change(line.text):
            raise may_correct(line)
    for line in after:
        if _CORRECTS.search(line.text):
            raise may_correct(line)


def may_correct(line: SourceText) -> GridError:
    """Return the error for a sentence that may change the meaning of the table beside it."""
    message = say(
        "The sentence in line {line} may correct the table. Write the correction into the "
        "table, and delete the sentence.",
        line=line.line_number,
    )
    return GridError("text_around", message, line.whole)


def names_unit(sentence: str) -> bool:
    """True if a sentence names a unit, which may be that of numbers in the table."""
    return UNIT.search(_FREEDOM.sub("", sentence)) is not None


def check_units(line: SourceText) -> None:
    """Raise GridError for a sentence with the name of a unit."""
    # The unit may apply to the table.
    if names_unit(line.text):
        raise GridError(
            "text_around",
            say(
                "Line {line} names a unit, but not its columns. Delete the line, and write the "
                "units into the headers, such as theta [deg].",
                line=line.line_number,
            ),
            line.whole,
        )


def _between(source: SourceText, first: SourceText, last: SourceText) -> SourceText:
    start = bisect_left(source.starts, first.starts[0])
    end = bisect_left(source.starts, last.starts[len(last.text) - 1]) + 1
    return source.cut(start, end)


# --- Remove code fences and docstrings that have only sentences in or around them


def without_fence(source: SourceText) -> SourceText:
    """Return the text inside a code fence that has only sentences around it."""
    # The marks of a quotation, a > before each line, are removed, too.
    if all(map(_QUOTED.match, filter(str.strip, source.text.splitlines()))):
        source = joined(source.split(_QUOTED), source.at)
    if "```" not in source.text and "~~~" not in source.text:
        return source
    lines = source.lines()
    fences = [i for i, line in enumerate(lines) if _FENCE.fullmatch(line.text)]
    if len(fences) != 2:
        return source
    first, last = fences
    around = [*lines[:first], *lines[last + 1 :]]
    if first + 1 == last or any(
        line.text.strip() and not is_sentence(line.text) for line in around
    ):
        return source
    check_sentences(lines[:first], lines[last + 1 :])
    return _between(source, lines[first + 1], lines[last - 1])


def without_docstrings(source: SourceText) -> SourceText:
    """Return a script of Python without its docstrings. Raises GridError if one names a unit."""
    found = list(_docstrings(source.text))
    starts = [0, *(end for _, end in found)]
    ends = [*(start for start, _ in found), len(source.text)]
    rest = joined(map(source.cut, starts, ends), source.at)
    if not found or not rest.text.strip():
        return source
    for start, end in found:
        for line in source.cut(start, end).lines():
            check_units(line)
    return rest


def _docstrings(text: str) -> Iterator[Span]:
    at = 0
    while opening := _DOCSTRING.search(text, at):
        closing = text.find(opening[1], opening.end())
        at = closing + len(opening[1])
        if closing < 0 or text[at:].partition("\n")[0].strip():
            return
        yield opening.start(), at


# --- Remove lines that are an image, a product of matrices or the number of a page


# An image on a line of its own: in Markdown, HTML or LaTeX, or where a document had one.
_IMAGE: Final = (
    r"[ \t]*(?:!\[[^]\n]{0,200}\][(\[][^)\]\n]{0,400}[)\]]|!\[\[[^]\n]{1,200}\]\]"
    r"|<img\b[^<>\n]{0,400}>|\\includegraphics(?:\[[^]\n]{0,200}\])?\{[^{}\n]{1,200}\})[ \t]*"
)
# A product of named matrices, such as A_i = Rot_z(theta_i) Trans_z(d_i): it gives no value to a
# letter of a cell. Its arguments are plain names.
_INDEX: Final = r"(?:[_^](?:\{(?:[\w\\, ]|i[-−]1){1,20}\}|\w|[-−]))"
_FACTOR: Final = (
    rf"(?:\{{\}}{_INDEX}{{0,2}})?(?:\\(?:text|mathrm|mathbf|operatorname)\{{[A-Z][a-z]{{0,6}}\}}"
    rf"|[A-Z][a-z]{{0,6}}\d{{0,2}}){_INDEX}{{0,2}}"
    r"(?:\((?:[a-z]\w{0,8}|\\[a-z]{1,8}|0|_\{?(?:\w{1,3}|i[-−]1)\}?|[, ]){1,12}\))?"
)
_BETWEEN: Final = r"[ \t]{0,3}(?:(?:\*|·|@|\\cdot|\\,|\\;|\\cdots|\.\.\.|…)[ \t]{0,3}){0,3}"
_PRODUCT: Final = (
    rf"[ \t]*(?P<open>\$\$|\$|\\\[|\\\()?\s{{0,4}}{_FACTOR}[ \t]{{0,3}}="
    rf"[ \t]{{0,3}}{_FACTOR}(?:{_BETWEEN}{_FACTOR}){{1,12}}\s{{0,4}}"
    r"(?(open)(?:\$\$?|\\\]|\\\)))[.,]?[ \t]*"
)
# The number of a page: "Page 3 of 4", "Seite 2", "- 3 -", "第 3 页".
_PAGE: Final = (
    r"[ \t]*(?:(?:page|seite|blatt|página|pagina|p\.|s\.)[ \t]?\d{1,3}"
    r"(?:[ \t]?(?:of|von|sur|de|di|/)[ \t]?\d{1,3})?|-[ \t]?\d{1,3}[ \t]?-"
    r"|第[ \t]?\d{1,3}[ \t]?页(?:.{0,3}共[ \t]?\d{1,3}[ \t]?页)?)[ \t]*"
)
_PICTURE: Final = regex(rf"^(?:{_IMAGE}|{_PRODUCT}|(?i:{_PAGE}))\r?$\n?", re.MULTILINE)


def without_pictures(source: SourceText) -> tuple[SourceText, tuple[Note, ...]]:
    """Return the text without lines that are an image, a product of matrices or a page number."""
    found = _PICTURE.search(source.text)
    rest = joined(source.split(_PICTURE), source.at) if found else source
    if found is None or not rest.text.strip():
        return source, ()
    return rest, (left_aside(source.span(*found.span())),)


# --- Assignments above the matrix of a MATLAB script, such as ``a1 = 0.4``


# The value may be a calculation or a call of a function, but not a matrix or a list.
ASSIGNMENT: Final = regex(
    r"[ \t\r]*(?P<line>(?P<name>[A-Za-z]\w{0,60})[ \t]*=(?!=)[ \t]*"
    r"(?P<value>(?=[^\s])(?:[^;,\n\[\](){}=]|\((?:[^()\n\[]|\[(?!\s?\[)){0,40}\)){1,80}))(?:[;,\n]|\Z)"
)
# An assignment to several letters: d1, d4 = 0.1625, 0.1333.
_LETTER: Final = r"[A-Za-z]\w{0,20}"
_VALUE: Final = r"(?:[^,;=\n()\[\]{}#%]|\([^,;=\n()\[\]{}#%]{0,40}\)){1,40}"
_TUPLE: Final = regex(
    rf"[ \t\r]*(?P<line>\(?(?P<names>{_LETTER}(?:[ \t]*,[ \t]*{_LETTER}){{1,11}})\)?[ \t]*=(?!=)"
    rf"[ \t]*\(?(?P<values>(?! ){_VALUE}(?:,{_VALUE}){{1,11}})\)?)[ \t\r]*"
    r"(?:[#%][^\n]*)?(?:[;\n]|\Z)"
)
_TUPLES: Final = regex(rf"(?:(?<=[;\n])|\A){_TUPLE.pattern}")
_PLAIN_NUMBER: Final = regex(r"[-+]?(?:\d{1,30}\.?\d{0,30}|\.\d{1,30})(?:[eE][-+]?\d{1,3})?")
_HARMLESS: Final = regex(
    r"[ \t\r]*(?:(?:syms|clc|clear|close|format|pkg|load|import|from)\b[^;\n]*)?(?:[;,\n]|\Z)"
)
# A line above or below a table: "where d1 = 0.135 m, a2 = 0.4 m".
_DEFINITION: Final = (
    r"(?:[^\W\d_]{1,5}_?\d{1,2}|[^\W\d_]_\{\d\}|[^\W\d_][₀-₉])\s{0,4}[=:]\s{0,4}"
    r"[-+−]?(?:\d{1,9}(?:[.,]\d{1,9})?)(?:\s{0,4}(?:°|[^\W\d_]{1,8}))?"
)
_DEFINITIONS: Final = regex(
    r"\s{0,9}(?:(?:where|with|wobei|mit|donde|con|où|avec|其中)\s{0,4}:?\s{0,4})?"
    rf"{_DEFINITION}(?:\s{{0,4}}(?:[,;、]|and|und|y|et|和)\s{{0,4}}{_DEFINITION}){{0,20}}[\s.,;]{{0,9}}",
    re.IGNORECASE,
)
_DEFINED: Final = regex(r"[^\W\d]\w*(?=\s{0,4}[=:])")
# A name that is not the left side of an assignment.
_READ: Final = regex(r"(?<!\w)[^\WA-Za-z]*([A-Za-z]\w*)(?!\w|[ \t]*=(?!=))")
# A last statement that shows a matrix or counts its rows: disp(T), print(T), T, n = size(T, 1).
_SHOWS: Final = regex(
    r"(?:[;,\n][ \t]*(?:(?:\w{1,12}\.)?(?:disp|display|pretty|print|pprint)"
    r"\((?:latex\(|simplify\()?[ \t]*\w{1,60}[ \t]*\){1,2}"
    r"|\w{1,60}[ \t]*=[ \t]*(?:size|length|len|height|rows)\([\w, \t]{1,60}\)"
    r"|(?:TableForm|MatrixForm|Print)\[\w{1,60}\]|\w{1,60} ?// ?(?:TableForm|MatrixForm))"
    r"|[;\n][ \t]*[A-Za-z]\w{0,60})\Z"
)
_MOST_SHOWN: Final = 4
# The shorthand of a cosine or sine: c12 = cos(q1 + q2), s_1 = \\sin\\theta_1, c_i = cos θ_i.
_ANGLE: Final = r"\\?(?:theta|th|θ|q|t)_?\{?([\d₀-₉ijk])\}?"
_SHORTHAND: Final = regex(
    r"\$?([cs])_?\{?(\d{1,6}|[ijk]{1,3})\}?\s{0,4}=\s{0,4}\\?(?:\w{1,6}\.)?(cos|sin)\s{0,2}"
    rf"(?:\(\s?({_ANGLE}(?:\s?\+\s?{_ANGLE}){{0,5}})\s?\)|({_ANGLE})(?!\s?[\w+*/-]))\$?"
)
_AROUND_SHORTHANDS: Final = regex(
    r"[\s,;:.]*(?:(?:where|with|using|wobei|mit|donde|con|où|avec|其中|and|und|y|et|etc)[\s,;:.]*){0,9}"
)
_TAIL: Final = " \t\r\n;,"
# The beginning of a matrix on a later line of a script.
_MATRIX: Final = regex(r"\n[ \t]*[A-Za-z]\w{0,40}[ \t]{0,4}=[ \t]{0,4}(?:[\w.]{1,40}\()?[\[]")
_MOST_NAMES: Final = 8


@dataclass(frozen=True, slots=True)
class GivenValue:
    """A value that a script assigns to a letter; ``line`` is the whole statement."""

    name: str
    value: str
    line: SourceText

    @property
    def is_number(self) -> bool:
        """True if the value is a plain number."""
        return _PLAIN_NUMBER.fullmatch(self.value) is not None

    @property
    def is_itself(self) -> bool:
        """True if the statement only declares the letter as a symbol: ``q1 = sym('q1')``."""
        return self.value.startswith((f"sym('{self.name}'", f'sym("{self.name}"'))


def without_given_values(source: SourceText) -> tuple[SourceText, tuple[Note, ...]]:
    """Return the matrix in a script, and a note on numbers that the script assigns to letters.

    Raises GridError if a letter of the matrix has a value that is not a plain number.
    """
    # Any text but a script is returned unchanged.
    plain = without_remarks(source)
    shown = _without_display(plain)
    given, at = _given_values(shown)
    rest = shown.cut(at, len(shown.text))
    if (shown is plain and not at) or not begins_as_matrix(rest.text):
        return source, ()
    return rest, given_numbers_note(given, set(_READ.findall(rest.text)))


def check_script(source: SourceText) -> None:
    """Raise GridError if a text is a script with a statement before its matrix."""
    # Its statements would be read as rows of values.
    plain = without_remarks(source)
    if _MATRIX.search(plain.text):
        _, at = _given_values(plain)
        raise text_around(plain.cut(at, len(plain.text)))


def without_definitions(source: SourceText) -> tuple[SourceText, tuple[Note, ...]]:
    """Return the table without definitions such as ``d1 = 0.135 m``, and a note on definitions."""
    # Any other text is returned unchanged.
    lines = [line for line in source.lines() if line.text.strip()]
    numbers = [_DEFINITIONS.fullmatch(line.text) is not None for line in lines]
    is_definition = [
        given or _defines_shorthands(line.text) for given, line in zip(numbers, lines, strict=True)
    ]
    rows = [line for line, defines in zip(lines, is_definition, strict=True) if not defines]
    if len(rows) < 2 or len(rows) == len(lines):
        return source, ()
    first = is_definition.index(False)
    if any(is_definition[first : first + len(rows)]):
        return source, ()
    start, end = source.starts.index(rows[0].starts[0]), source.starts.index(rows[-1].starts[-1])
    if not any(numbers):
        return source.cut(start, end + 1), ()
    if any("=" in row.text for row in rows):
        return source, ()
    around = [line for line, given in zip(lines, numbers, strict=True) if given]
    names = [name for line in around for name in _DEFINED.findall(line.text)]
    message = say(
        "The numbers of {letters} were not used. The letters were read as the exercise's symbols.",
        letters=", ".join(names[:_MOST_NAMES]) + (", …" if len(names) > _MOST_NAMES else ""),
    )
    note = Note("given_numbers", message, around[0].whole)
    return source.cut(start, end + 1), (note,)


def given_numbers_note(given: Sequence[GivenValue], read: Set[str]) -> tuple[Note, ...]:
    """Return the note on numbers that a script assigns to letters.

    ``read`` are the letters in the cells. Raises GridError if the value of such a letter is not a
    plain number.
    """
    for each in given:
        is_known = each.is_number or not _without_shorthands(f"{each.name} = {each.value}")
        if each.name in read and not is_known:
            raise GridError(
                "given_value",
                say(
                    "`{line}` gives {letter} a value, which is not put in here. Write it where the "
                    "letter stands, or delete this line.",
                    line=each.line.text[:40],
                    letter=each.name,
                ),
                each.line.whole,
            )
    numbers = [each for each in given if each.is_number]
    if not numbers:
        return ()
    names = ", ".join(dict.fromkeys(each.name for each in numbers[:_MOST_NAMES]))
    more = ", …" if len(numbers) > _MOST_NAMES else ""
    message = say(
        "The script gives numbers to {letters}; they were not used. The letters were read as the "
        "exercise's symbols.",
        letters=f"{names}{more}",
    )
    span = numbers[0].line.whole[0], numbers[-1].line.whole[1]
    return (Note("given_numbers", message, span),)


def _given_values(source: SourceText) -> tuple[list[GivenValue], int]:
    found: list[GivenValue] = []
    text, at = source.text, 0
    while at < len(text):
        if assignment := ASSIGNMENT.match(text, at):
            line = source.cut(*assignment.span("line")).strip()
            value = GivenValue(assignment["name"], assignment["value"].strip(), line)
            if not value.is_itself:
                found.append(value)
            at = assignment.end()
        elif (several := _TUPLE.match(text, at)) and (pairs := _pairs_of(several)):
            line = source.cut(*several.span("line"))
            found += [GivenValue(*pair, line) for pair in pairs]
            at = several.end()
        elif harmless := _HARMLESS.match(text, at):
            at = harmless.end()
        else:
            break
    return found, at


def _pairs_of(assignment: re.Match[str]) -> list[tuple[str, str]]:
    # Return the letters with their values; [] if their numbers differ.
    names = [name.strip() for name in assignment["names"].split(",")]
    values = [value.strip() for value in assignment["values"].split(",")]
    return [*zip(names, values, strict=True)] if len(names) == len(values) else []


def without_tuples(text: str) -> str:
    """Return the text with one assignment for each letter: ``d1, d4 = 1, 2`` is two lines."""

    def lines(found: re.Match[str]) -> str:
        return "".join(f"{name} = {value}\n" for name, value in _pairs_of(found)) or found[0]

    return _TUPLES.sub(lines, text)


def _without_display(source: SourceText) -> SourceText:
    """Return the text without a last statement such as ``disp(DH)``, which shows the matrix."""
    for _ in range(_MOST_SHOWN):
        stripped = source.strip(_TAIL)
        shown = _SHOWS.search(stripped.text, max(0, len(stripped.text) - 160))
        if shown is None:
            break
        source = stripped.cut(0, shown.start())
    return source


def _without_shorthands(line: str) -> str:
    """Return the text without definitions of shorthands such as ``c12 = cos(q1 + q2)``."""

    def rest(found: re.Match[str]) -> str:
        angles = unicodedata.normalize("NFKC", found[4] or found[7])
        is_right = found[3].startswith(found[1]) and "".join(re.findall(_ANGLE, angles)) == found[2]
        return "" if is_right else found[0]

    return _SHORTHAND.sub(rest, line)


def _defines_shorthands(line: str) -> bool:
    """True if a line only defines shorthands: where c1 = cos(q1) and s1 = sin(q1)."""
    rest = _without_shorthands(line)
    return rest != line and _AROUND_SHORTHANDS.fullmatch(rest) is not None
