"""Remove sentences and code fences around a pasted table or matrix.

A line with words but without a separator of cells is a sentence. A sentence that names a unit is an
error, because the unit may apply to the table. So is a sentence that may correct the table.
"""

import re
from bisect import bisect_left
from collections import Counter
from collections.abc import Callable, Iterator
from typing import Final

from dh_grader.expressions.errors import Note, Span
from dh_grader.pasting.remarks import may_change
from dh_grader.pasting.source import GridError, SourceText, joined, split_blanks
from dh_grader.regex import regex
from dh_grader.translations import say

_QUOTED: Final = regex(r"^[ \t]{0,3}>(?!>)(?=[ \t|]) ?", re.MULTILINE)
_FENCE: Final = regex(r"[ \t]*(?:```|~~~)[`~]{0,3}[ \t]*[\w+-]{0,20}[ \t]*")
_BARS: Final = "|│┃║"
# The separators of rows; the first that at least two lines have is the one of the table.
_SEPARATORS: Final = (_BARS, "\t", "&", ";", ",")
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
_SIGNS: Final = regex(rf"[{_BARS}\t&;=\\\[\]{{}}@■<>]")
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
