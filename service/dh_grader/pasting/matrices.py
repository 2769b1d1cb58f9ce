"""Matrices in pasted texts: one reader for each format, in the order in which they are tried.

LaTeX is in ``latex.py``; texts with several matrices are split in ``__init__.py``.
"""

import re
from itertools import pairwise, zip_longest
from typing import Final

from dh_grader.expressions.errors import Note
from dh_grader.pasting.program import (
    TAIL,
    WrittenMatrix,
    after_names,
    begins_as_matrix,
    text_around,
    unquoted,
    unwrap,
    without_harmless_lines,
    without_remarks,
)
from dh_grader.pasting.source import (
    CLOSES,
    GRID_LIMITS,
    Grid,
    GridError,
    GridFormat,
    SourceText,
    grid,
    joined,
    outside,
    pairs,
    split,
    split_blanks,
    strict_pairs,
    too_many_rows,
)
from dh_grader.regex import regex
from dh_grader.translations import say

# --- The identity matrix by its name: ``eye(4)``, ``np.identity(3)``, ``I_4``, or only ``I``


# The format of a matrix whose text does not say its size. It has the most rows that are asked for.
ANY_SIZE: Final = "identity-of-any-size"
_LARGEST: Final = 4
# Characters of a program that makes nothing but the matrix.
_LONGEST: Final = 400
_MAY_BE: Final = regex(r"eye|ident|I")
_NAME: Final = r"(?:[A-Za-z][\w^{}]{0,20}(?:\([\w, ]{0,20}\))?[ \t]{0,4}:?=[ \t]{0,4}){0,2}"
_CALL: Final = (
    r"(?:[A-Za-z]{1,8}\.)?(?:eye|identity|ident|IdentityMatrix)[ \t]?"
    r"[(\[]\s?(?P<called>[2-4])(?:,\s?(?P=called))?\s?[)\]]"
)
_LETTER: Final = (
    r"(?:\\(?:mathbf|mathrm|boldsymbol|bm)\{I\}|I)"
    r"(?:_?\{?(?P<size>[2-4])(?:\s?(?:[x×]|\\times)\s?(?P=size))?\}?)?"
)
_IDENTITY: Final = regex(rf"\$*{_NAME}(?:{_CALL}|{_LETTER})\$*;?")


def identity(source: SourceText) -> Grid | None:
    """Return the identity matrix that the text names; None for any other text."""
    if len(source.text) > _LONGEST or not _MAY_BE.search(source.text):
        return None
    source = without_harmless_lines(without_remarks(source)).strip()
    found = _IDENTITY.fullmatch(source.text)
    if found is None:
        return None
    stated = found["called"] or found["size"]
    size = int(stated or _LARGEST)
    cells = [[source.spelled("1" if i == j else "0") for j in range(size)] for i in range(size)]
    return Grid("identity" if stated else ANY_SIZE, tuple(map(tuple, cells)))


# --- Matrices of Eigen in C++: ``R << 1, 0, 0, 1;``, with or without the declaration of ``R``


_COMMENT: Final = regex(r"//[^\n]*")
_EIGEN_MATRIX: Final = regex(
    r"(?:\s*(?:#include|using)\b[^\n]{0,80}\n)*"
    r"(?:\s*(?:Eigen::)?Matrix(?:(?P<size>[2-6])[df]|X[df]|"
    r"<\w{1,12}, ?(?P<rows>\d), ?(?P<columns>\d)>)"
    r"\s+(?P<declared>\w{1,40})(?: ?\((?P<height>\d), ?(?P<width>\d)\))?\s*;)?"
    r"\s*(?P<name>[A-Za-z]\w{0,40})\s*<<(?P<values>[^;<>=]+)"
)
_SHOWN: Final = r"[\s;]*(?:(?:std::)?cout\s?<<\s?{name}(?:\s?<<[^;<=]{{1,20}})?[\s;]*)?"


def _eigen_found(text: str) -> re.Match[str] | None:
    found = _EIGEN_MATRIX.match(text) if "<<" in text else None
    return found if found and "," in found["values"] else None


def _eigen_parse(source: SourceText) -> Grid:
    plain = joined(source.split(_COMMENT), source.at)
    found = _eigen_found(plain.text)
    if found is None or (found["declared"] or found["name"]) != found["name"]:
        raise text_around(plain)
    rest = plain.cut(found.end(), len(plain.text))
    if not re.fullmatch(_SHOWN.format(name=found["name"]), rest.text):
        raise text_around(rest.strip(" \n;"))
    content = plain.cut(*found.span("values"))
    height = found["size"] or found["rows"] or found["height"]
    width = found["size"] or found["columns"] or found["width"]
    if height:
        # Eigen fills row by row, wherever the lines end.
        rows = _flat_list(content, WrittenMatrix((), shape=(int(height), int(width))))
    else:
        rows = _list_rows([line for line in content.lines() if line.text.strip()])
    return grid("Eigen", rows, source.whole)


EIGEN: Final = GridFormat(
    lambda text: _eigen_found(_COMMENT.sub("", text)) is not None, _eigen_parse
)


# --- Maple's matrices in angle brackets: by rows <<a|b>, <c|d>>, by columns <<a, c>|<b, d>>


_MAPLE_MATRIX: Final = regex(
    r"<\s*<[^<>,;]{1,800}>(?:\s*[,;]\s*<[^<>,;]{1,800}>){1,12}\s*>"
    r"|(?P<columns><\s*<[^<>|]{1,800}>(?:\s*\|\s*<[^<>|]{1,800}>){1,12}\s*>)"
)
_LINE: Final = regex(r"<([^<>]+)>")


def _maple_found(text: str) -> re.Match[str] | None:
    return _MAPLE_MATRIX.fullmatch(text[after_names(text) :].strip(TAIL)) if "<" in text else None


def _maple_parse(source: SourceText) -> Grid:
    found = _maple_found(source.text)
    by_columns = found is not None and found["columns"] is not None
    lines = [source.cut(*line.span(1)) for line in _LINE.finditer(source.text)]
    rows = [split(line, ",;" if by_columns else "|") for line in lines]
    if by_columns:
        rows = [list(row) for row in zip_longest(*rows, fillvalue=source.cut(0, 0))]
    return grid("Maple", rows, source.whole)


MAPLE: Final = GridFormat(lambda text: _maple_found(text) is not None, _maple_parse)


# --- Matrices as Word writes them in one line: ``T=[■(a&b@c&d)]``, also ``■8(…)``, ``\matrix(…)``
#
# The sign @ separates rows and & separates values. Source: M. Sargent, UnicodeMath, Unicode
# Technical Note 28.


# ⓢ and ⒨ are matrices in [ ] and in ( ).
_WORD_MATRIX: Final = regex(r"(?:■8?|[ⓢ⒨]|\\[bp]?matrix)[ \t]{0,4}\(")
# An equation array: a column, unless & marks where its lines are aligned.
_COLUMN: Final = regex(r"█[ \t]{0,4}\(")
_OPENS: Final = {**CLOSES, "〖": "〗"}
_SIGN: Final = regex(r"[][(){}〖〗&@]")
_NUMBER_OF_EQUATION: Final = regex(r"#[ \t]?\(?\d{0,4}(?:\.\d{1,4})?\)?")


def _word_matches(text: str) -> bool:
    return _sign(text).search(text) is not None


def _sign(text: str) -> re.Pattern[str]:
    return _COLUMN if "█" in text and "&" not in text and "■" not in text else _WORD_MATRIX


def _word_parse(source: SourceText) -> Grid:
    sign = _sign(source.text)
    begin = sign.search(source.text)
    assert begin is not None
    again = sign.search(source.text, begin.end())
    if again is not None:
        raise text_around(source.cut(again.start(), len(source.text)))
    rows, end = _rows(source, begin.end())
    _check_around(source.cut(0, begin.start()), source.cut(end, len(source.text)))
    return grid("Word", rows, source.whole)


def _rows(source: SourceText, start: int) -> tuple[list[list[SourceText]], int]:
    rows: list[list[SourceText]] = [[]]
    opened: list[str] = []
    for sign in _SIGN.finditer(source.text, start):
        letter, at = sign[0], sign.start()
        if letter in _OPENS:
            opened.append(_OPENS[letter])
        elif letter not in "&@" and opened:
            if opened.pop() != letter:
                break
        elif not opened:
            rows[-1].append(source.cut(start, at))
            start = sign.end()
            if letter == ")":
                return rows, start
            if letter == "@":
                rows.append([])
            elif letter != "&":
                break
    message = say(
        "The brackets of this matrix do not belong together. Copy the whole equation again."
    )
    raise GridError("unbalanced_bracket", message, source.whole)


def _check_around(front: SourceText, rest: SourceText) -> None:
    front, rest = front.strip(), rest.strip()
    closer = CLOSES.get(front.text[-1:], "")
    if closer and rest.text.startswith(closer):
        front, rest = front.cut(0, len(front.text) - 1).strip(), rest.cut(1, len(rest.text))
    rest = rest.strip(TAIL)
    if front.text and not front.text.endswith("="):
        raise text_around(front.cut(front.text.rfind("=") + 1, len(front.text)))
    if rest.text and not _NUMBER_OF_EQUATION.fullmatch(rest.text):
        raise text_around(rest)


WORD: Final = GridFormat(_word_matches, _word_parse)


# --- Matrices drawn over several lines: SymPy's and Octave's ⎡…⎤, Maxima's [ … ], MATLAB's / … \
#
# A row is one line, followed by an empty line of the drawing. A matrix whose cells take several
# lines (powers, fractions) is refused.


_PIECES: Final = frozenset("⎡⎢⎣⎤⎥⎦⎛⎜⎝⎞⎟⎠⎧⎨⎩⎫⎬⎭")
_LEFT: Final = "⎡⎢⎣⎛⎜⎝[/|\\"
_RIGHT: Final = "⎤⎥⎦⎞⎟⎠]\\|/"
# An empty line of the drawing: [    ].
_SPACER: Final = regex(r"^[ \t]*\[[ \t]+\][ \t]*\r?$", re.MULTILINE)
_SLASHES: Final = regex(r"^[ \t]*/[^\n]*\\[ \t]*\r?\n[ \t]*\|", re.MULTILINE)
_GAP: Final = regex(r"[ \t]{2,}")


def _drawn_matches(text: str) -> bool:
    if not _PIECES.isdisjoint(text):
        return True
    return _SPACER.search(text) is not None or _SLASHES.search(text) is not None


def _drawn_parse(source: SourceText) -> Grid:
    drawing = source.cut(after_names(source.text), len(source.text)).strip(TAIL)
    lines = [line for line in map(SourceText.strip, drawing.lines()) if line.text]
    rows: list[SourceText | None] = []
    for line in lines:
        inner = line.cut(1, len(line.text) - 1).strip()
        if line.text[0] not in _LEFT or line.text[-1] not in _RIGHT or len(line.text) < 2:
            raise _refusal(line)
        if not _PIECES.isdisjoint(inner.text):
            raise _refusal(line)
        rows.append(inner if inner.text else None)
    for above, row in pairwise(rows):
        if above and row:
            raise _refusal(row)
    cells = [_cells(row) for row in rows if row]
    if len(set(map(len, cells))) > 1:
        raise _refusal(lines[0])
    return grid("drawn matrix", cells, source.whole)


def _cells(row: SourceText) -> list[SourceText]:
    """Split a row at commas, or at two or more blanks if it has no comma."""
    commas = [*outside(row.text, ",")]
    return row.cut_at(commas) if commas else row.split(_GAP)


def _refusal(line: SourceText) -> GridError:
    return GridError(
        "drawn_matrix",
        say(
            "This drawn matrix cannot be read safely. Paste it as one line of text or as "
            "LaTeX, as print(T) or latex(T) in SymPy give it."
        ),
        line.whole,
    )


DRAWN_MATRIX: Final = GridFormat(_drawn_matches, _drawn_parse)


# --- Matrices in brackets: MATLAB's, and lists of lists from Python, NumPy, SymPy and JSON


# Functions of MATLAB that may enclose a matrix; "" if there is none.
_MATLAB_FUNCTIONS: Final = frozenset({"", "sym", "simplify"})


def _lines(source: SourceText) -> list[SourceText]:
    """Return the texts in round brackets if each line is one row in them: ``(l1, 0, 0, q1)``."""
    lines = [line for each in source.lines() if (line := each.strip(" \t,;")).text]
    inner = [line.cut(1, len(line.text) - 1) for line in lines]
    for line, row in zip(lines, inner, strict=True):
        if line.text[0] != "(" or pairs(line.text).get(0) != len(line.text):
            return []
        if not any(True for _ in outside(row.text, ",")):
            return []
    return inner if len(inner) > 1 else []


def _bracketed_matches(text: str) -> bool:
    return begins_as_matrix(text) or bool(_lines(SourceText.of(text)))


def _bracketed_parse(source: SourceText) -> Grid:
    if in_brackets := _lines(source):
        return grid("brackets", _list_rows(in_brackets), source.whole)
    matrix = unwrap(source)
    notes: tuple[Note, ...] = ()
    if len(matrix.groups) == 1:
        [content] = matrix.groups
        lines = list_lines(content)
        if lines is not None:
            rows = _list_rows(lines)
        elif matrix.maker not in _MATLAB_FUNCTIONS and ";" not in content.text:
            rows = _flat_list(content, matrix)
        else:
            rows, notes = rows_in_matlab(content)
    else:
        # MATLAB prints each row of a symbolic matrix in brackets.
        for group in matrix.groups:
            if any(letter in ";\n" for letter in group.text):
                raise text_around(matrix.groups[1])
        rows = _list_rows(list(matrix.groups))
    _refuse_objects(rows)
    values = [[unquoted(cell.strip()) for cell in row] for row in rows]
    return grid("brackets", values, source.whole, notes)


def _refuse_objects(rows: list[list[SourceText]]) -> None:
    for row in rows:
        for cell in row:
            inner = cell.strip()
            if inner.text.startswith(("{", '"', "'")) and ":" in inner.text:
                raise GridError(
                    "named_values",
                    say(
                        "Values with names (JSON objects, dictionaries) are not read from pasted "
                        "text; paste a list of rows, or a table with a header line."
                    ),
                    inner.whole,
                )


BRACKETED: Final = GridFormat(_bracketed_matches, _bracketed_parse)


# --- Lists of lists from Python, NumPy (also printed arrays), SymPy's Matrix([[…]]), and JSON


_BETWEEN: Final = " \t\r\n,;"
_COLUMN_MAKERS: Final = frozenset({"Matrix", "ImmutableMatrix", "MutableDenseMatrix"})


def list_lines(content: SourceText) -> list[SourceText] | None:
    """Return the text in each inner bracket of a list of lists; None for any other text.

    Raises GridError for unbalanced brackets, and for too many brackets.
    """
    ends = strict_pairs(content)
    text = content.text
    lines: list[SourceText] = []
    i = 0
    while i < len(text):
        if text[i] in CLOSES:
            line = content.cut(i + 1, ends[i] - 1)
            # (a + b), (c + d) are values in round brackets; (a, b), (c, d) are rows.
            if text[i] == "(" and len(split(line, ",")) == 1:
                return None
            if len(lines) > GRID_LIMITS.rows:
                raise too_many_rows(content.whole)
            lines.append(line)
            i = ends[i]
        elif text[i] in _BETWEEN:
            i += 1
        else:
            return None
    return lines or None


def _list_rows(lines: list[SourceText]) -> list[list[SourceText]]:
    """Split each line into values at commas, or at blanks if it has no comma.

    Raises GridError for a list of matrices.
    """
    found = []
    for line in lines:
        if line.text.lstrip()[:1] in {"[", "{"} and list_lines(line):
            message = say("This is a list of matrices or tables; paste one of them.")
            raise GridError("nested_too_deep", message, line.whole)
        found.append(_values(line))
    return found


def _flat_list(content: SourceText, matrix: WrittenMatrix) -> list[list[SourceText]]:
    """Return the rows of a matrix made from a flat list, as by SymPy's ``Matrix(2, 2, […])``.

    Raises GridError if the number of values does not fit the shape.
    """
    # Without a shape, SymPy makes a column and NumPy a row.
    values = _values(content)
    if matrix.shape is None:
        return [[value] for value in values] if matrix.maker in _COLUMN_MAKERS else [values]
    height, width = matrix.shape
    if height * width != len(values):
        count = height * width
        message = say(
            "A {rows} × {columns} matrix has {number} values; yours has {found}.",
            rows=height,
            columns=width,
            number=count,
            found=len(values),
        )
        raise GridError("wrong_count", message, content.whole)
    return [values[i * width : (i + 1) * width] for i in range(height)]


def _values(line: SourceText) -> list[SourceText]:
    pieces = split(line, ",")
    if len(pieces) == 1:
        # NumPy prints its arrays with blanks.
        return list(split_blanks(line).elements)
    if not pieces[-1].text.strip():
        pieces.pop()
    return pieces


# --- MATLAB rows without brackets: each line ends with a semicolon


def _matlab_rows_matches(text: str) -> bool:
    lines = [line.strip() for line in text.strip().splitlines() if line.strip()]
    inside = any(";" in line[:-1] for line in lines)
    return len(lines) > 1 and not inside and all(line.endswith(";") for line in lines[:-1])


def _matlab_rows_parse(source: SourceText) -> Grid:
    rows, notes = rows_in_matlab(source)
    return grid("rows with semicolons", rows, source.whole, notes)


MATLAB_ROWS: Final = GridFormat(_matlab_rows_matches, _matlab_rows_parse)


# --- Split a MATLAB matrix into rows at semicolons or line ends, and rows at commas or blanks


def rows_in_matlab(content: SourceText) -> tuple[list[list[SourceText]], tuple[Note, ...]]:
    """Return the values of each row, with notes if the text is ambiguous.

    Raises GridError if splitting at commas and splitting at blanks give different matrices.
    """
    lines = split(content, ";\r\n")
    lines = [line.strip() for line in lines if line.text.strip(" \t,")]
    by_commas = [_without_last_empty(split(line, ",")) for line in lines]
    by_blanks, signs = _by_blanks(by_commas)
    if list(map(len, by_commas)) == list(map(len, by_blanks)):
        return by_commas, ()
    if all(len(row) == 1 for row in by_commas) or not _is_rectangle(by_commas):
        return by_blanks, _sign_notes(signs)
    if _is_rectangle(by_blanks):
        raise _ambiguous(by_commas, by_blanks)
    message = say(
        "Commas separate the values here, so spaces inside a value were read as products and sums."
    )
    return by_commas, (Note("commas_separate", message, content.whole),)


def _by_blanks(
    by_commas: list[list[SourceText]],
) -> tuple[list[list[SourceText]], list[SourceText]]:
    found: list[list[SourceText]] = []
    signs: list[SourceText] = []
    for row in by_commas:
        elements: list[SourceText] = []
        for piece in row:
            separated = split_blanks(piece)
            elements += separated.elements or (piece,)
            signs += separated.signs
        found.append(elements)
    return found, signs


def _without_last_empty(row: list[SourceText]) -> list[SourceText]:
    return row[:-1] if len(row) > 1 and not row[-1].text.strip() else row


def _is_rectangle(found: list[list[SourceText]]) -> bool:
    return len({len(row) for row in found}) == 1


def _sign_notes(signs: list[SourceText]) -> tuple[Note, ...]:
    if not signs:
        return ()
    sign = signs[0]
    message = say(
        "The space before {value} begins a new value, as in MATLAB; a difference has spaces on "
        "both sides of the sign, or none.",
        value=sign.text[:20],
    )
    return (Note("blank_before_sign", message, sign.whole),)


def _ambiguous(by_commas: list[list[SourceText]], by_blanks: list[list[SourceText]]) -> GridError:
    at = next(i for i, row in enumerate(by_commas) if len(row) != len(by_blanks[i]))
    row, longer = by_commas[at], by_blanks[at]
    return GridError(
        "mixed_separators",
        say(
            "This row has {few} values if only commas separate them, and {many} if spaces do, too. "
            "Write commas between all values.",
            few=len(row),
            many=len(longer),
        ),
        (row[0].whole[0], row[-1].whole[1]),
    )
