"""Tell the statements of a script that only use its DH table from those that may change it.

Nothing is run. Such a statement is ``T1 = dh(DH(1,:));`` below the table.
"""

import re
from collections.abc import Sequence
from typing import Final

from dh_grader.pasting.program import without_remarks
from dh_grader.pasting.source import BRACKET, GridError, SourceText, split, strict_pairs
from dh_grader.regex import regex

# --- Leave out the statements below a table that only use it


# Signs of another unit or of another order.
_TELLS: Final = regex(
    r"deg|rad|180|1000|57\.|1e-?3|\.001|(?<!\w)(?:a?(?:sin|cos|tan)d|[mc]m)(?!\w)"
    r"|flip|swap|rot90|shift|transpos|permut|sort|revers|shuffle|order|convert|scal|unit"
    r"|eval|exec|assignin",
    re.IGNORECASE,
)
# Toolboxes, whose matrices have another order.
_TOOLBOX: Final = regex(r"link[(.]|revolute|prismatic|dhrobot|rigidbody|setfixed", re.IGNORECASE)
_PARAMETER: Final = regex(
    r"(?<![^\W\d_])(?:a|d|r|(?i:al|alpha|alfa|th|theta|twist|offset|angle)|[αθ])_?[ijn]?(?![^\W_])"
)
_GAP: Final = r"['\"]?\s{0,4},\s{0,4}['\"]?"
# The parameters, or the elements of a row, in the order a, α, d, θ.
_IN_ORDER: Final = regex(
    rf"(?<![\w.])a(?:_?i)?{_GAP}(?:alpha|al|α)(?:_?i)?{_GAP}d(?:_?i)?{_GAP}(?:theta|th|θ)(?:_?i)?"
    r"(?!\w)|"
    + "|".join(
        rf"(?P<row{first}>\w{{1,40}}[(\[](?:\w{{1,12}}(?:,\s?|\]\[))?){first}(?P<end{first}>[)\]])"
        + "".join(rf"\s?,\s?(?P=row{first}){first + i}(?P=end{first})" for i in range(1, 4))
        for first in (0, 1)
    )
)
_ROW: Final = "ROW"
# The length of a statement, as it is written and without the elements of its rows.
_LONGEST_WRITTEN: Final = 2_000
_LONGEST: Final = 400
# The number of rows.
_COUNTED: Final = (
    r"(?<![\w.])(?:len|length|size|numel|nrows|height)\({table}(?:,\s?[01])?\)"
    r"|(?<![\w.]){table}\.(?:shape\[0\]|rows(?!\w))"
)
_STRING: Final = regex(r"(?<=[(,=\[{ ])(['\"])[^'\"\n]{0,200}\1")
# The table and its name: DH = [, dh = np.array([.
_TABLE: Final = regex(
    r"(?:^|(?<=;))[ \t]*([A-Za-z]\w{0,40})[ \t]*=[ \t]*(?:[\w.]{1,40}\(\s{0,40})?[\[{]",
    re.MULTILINE,
)
_NAME: Final = r"[A-Za-z]\w{0,40}"
_LOOP: Final = regex(
    rf"(?:par)?for\s{{1,4}}\(?(?P<names>{_NAME}(?:,\s?\(?{_NAME})?)\)?\s?(?:=|in\s|∈)\s?"
    r"(?P<over>[^,;=]{1,60}?(?:\([^()]{0,20}\))?)\)?(?:[,:](?=\s|\Z)|\Z)\s?(?P<body>.*)",
    re.DOTALL,
)
_LISTED: Final = regex(
    rf"\[(?P<value>[^\[\]]*(?:\[[^\[\]]*\][^\[\]]*)*)\sfor\s(?P<names>{_NAME})\sin\s(?P<over>[^\[\]]*)\]"
)
_ASSIGNED: Final = regex(
    rf"(?P<left>\[?{_NAME}(?:\{{[\w+ -]{{1,20}}\}}|\([\w:,+ -]{{1,20}}\))?"
    rf"(?:\s?,\s?{_NAME}){{0,5}}\]?)\s?=(?!=)\s?(?P<right>.+)",
    re.DOTALL,
)
_SHOWN: Final = regex(
    r"(?:\w{1,12}\.)?(?:disp|display|print|println|pprint|pretty|fprintf|printf)\(.*\)"
    rf"|{_NAME}(?:\{{\d{{1,2}}\}})?(?:\s?[*@]\s?{_NAME}(?:\{{\d{{1,2}}\}})?){{0,12}}"
    r"|(?:import|from|syms|clc|format|end\w{0,6})(?!\w)[^=]*|if __name__ == '':",
    re.DOTALL,
)
# A matrix or a list, but not an empty list or a list of strings.
_LITERAL: Final = regex(r"(?<![\w)\]}])[\[{](?!\s{0,4}(?:[\]}]|''))")
_IS_TABLE: Final = regex(r"dh|tab|param", re.IGNORECASE)
# The first line of an output, such as "3×4 Matrix{Num}:" or "DH =".
_ECHO: Final = regex(
    r";?[ \t]*\n\s{0,40}(?:\d{1,2}[×x]\d{1,2} [\w{}, ]{1,40}:|(?P<name>[A-Za-z]\w{0,40}) ?=)\s*?\n"
)
_TOKEN: Final = regex(r"[^\s,;\[\]]+")
_NUMBER: Final = regex(r"-?\d{1,12}(?:\.\d{0,12})?")
# A line that prints a table: print(tabulate(dh, headers=[…])), print(df.to_string()).
_PRINTED: Final = regex(
    r"\s{0,40}(?:(?:import|from)\s[^\n]{0,80}\n){0,4}(?:\w{1,12}\.)?(?:print|disp|display)\("
    r"(?:[\w.]{1,20}\()?\w{1,40}(?:=\w{1,12}|\.to_\w{1,12}\()?(?:,[^()\n]{0,200})?\){1,2}[ \t;]*\n"
)
_SET: Final = regex(r"(?<!\w)\d*([^\W\d]\w*)\s?=(?!=)")
_WORD: Final = regex(r"[^\W\d]\w*")


def without_uses(source: SourceText) -> SourceText:
    """Return a table without the later statements of its script that only use it.

    Any other text is returned unchanged. Raises GridError for unbalanced brackets.
    """
    plain = without_remarks(source)
    found = _TABLE.search(plain.text)
    if found is None:
        return source
    name = found[1]
    opened = BRACKET.search(plain.text, found.end(1))
    assert opened is not None
    end = strict_pairs(plain)[opened.start()]
    if _is_echo(plain.text[found.end() : end], plain.text[end:], name):
        return plain.cut(0, end)
    later = split(plain.cut(end, len(plain.text)), ";\n\r")
    if later[0].text.strip():
        return source
    taken = set(_WORD.findall(plain.text[:end]))
    rows = {_ROW}
    if all(_is_use(each.text.strip(), name, rows, taken) for each in later):
        return plain.cut(0, end)
    return source


def without_print(source: SourceText) -> SourceText:
    """Return a printed table without a first line such as ``print(tabulate(dh, …))``."""
    printed = _PRINTED.match(source.text)
    if printed is None or _TELLS.search(printed[0]):
        return source
    rest = source.cut(printed.end(), len(source.text))
    named = _PARAMETER.findall(printed[0])
    if not tells(printed[0]) or named == _PARAMETER.findall(rest.text.lstrip().partition("\n")[0]):
        return rest
    return source


def tells(text: str) -> bool:
    """True if a text may name another unit or another order of the columns than a, α, d, θ."""
    return bool(_TELLS.search(text) or _PARAMETER.search(_IN_ORDER.sub(_ROW, text)))


def first_change(later: Sequence[SourceText], table: str) -> SourceText | None:
    """Return the first statement after a table that may change it, or None."""
    rows = {_ROW}
    for each in later:
        is_other = not {table, *rows} & set(_WORD.findall(each.text))
        is_harmless = is_other and not _TELLS.search(each.text)
        if not is_harmless and not _is_use(each.text, table, rows, set()):
            return each
    return None


def _is_echo(written: str, later: str, name: str) -> bool:
    """True if the text after a table is only its output by an interpreter."""
    echo = _ECHO.match(later)
    if echo is None or (echo["name"] or name) != name:
        return False
    tokens, shown = _TOKEN.findall(written), _TOKEN.findall(later[echo.end() :])
    return len(tokens) == len(shown) and all(map(_is_equal, tokens, shown))


def _is_equal(written: str, shown: str) -> bool:
    # A program shows -pi/2 as -1.5708.
    if written == shown:
        return True
    if not _NUMBER.fullmatch(shown) or set(_WORD.findall(written)) - {"pi"}:
        return False
    if _NUMBER.fullmatch(written):
        return float(written) == float(shown)
    return "pi" in written and (written[0] == "-") == (shown[0] == "-") and float(shown) != 0


def _is_use(statement: str, table: str, rows: set[str], taken: set[str]) -> bool:
    """True if a statement cannot change the table; ``rows`` gets the names of its rows."""
    # ``taken`` are the words in the table and before it.
    if len(statement) > _LONGEST_WRITTEN:
        return False
    text = _IN_ORDER.sub(_ROW, re.sub(_COUNTED.format(table=table), "1", statement))
    if not text or text == f"return {table}":
        return True
    is_set = not taken.isdisjoint(_SET.findall(text))
    if is_set or len(text) > _LONGEST or _TOOLBOX.search(text) or tells(text):
        return False
    text = _STRING.sub("''", text)
    if loop := _LOOP.match(text):
        return _iterates(loop, table, rows, taken) and _is_use(loop["body"], table, rows, taken)
    assigned = _ASSIGNED.fullmatch(text)
    if assigned is None:
        return _SHOWN.fullmatch(text) is not None and _is_argument(text, table, rows)
    names, right = set(_WORD.findall(assigned["left"])), assigned["right"]
    if names & (taken | rows - {_ROW}) or any(map(_IS_TABLE.search, names)):
        return False
    if listed := _LISTED.search(right):
        if not _iterates(listed, table, rows, taken):
            return False
        right = f"{right[: listed.start()]}({listed['value']}){right[listed.end() :]}"
    elif row := _use_of(table).fullmatch(right):
        rows |= names
        return row["row"] is not None
    return _is_argument(right, table, rows)


def _iterates(loop: re.Match[str], table: str, rows: set[str], taken: set[str]) -> bool:
    names, over = _WORD.findall(loop["names"]), loop["over"].strip()
    if set(names) & taken:
        return False
    if re.fullmatch(rf"(?:(?:enumerate|eachrow)\()?{table}(?:,\s?\w)?\)?", over):
        rows.add(names[-1])
        # In MATLAB, a loop over a matrix takes its columns.
        return " in " in loop[0]
    return re.fullmatch(r"[\w(),:+ -]{1,60}", over) is not None and table not in over


def _use_of(*names: str) -> re.Pattern[str]:
    return re.compile(
        rf"(?<![\w.])(?:{'|'.join(sorted(names))})(?!\w)"
        r"(?P<row>\[[\w +-]{1,12}(?:,\s?:)?\]|\([\w +-]{1,12},\s?:\)|\.row\([\w +-]{1,12}\))?"
    )


def _is_argument(text: str, table: str, rows: set[str]) -> bool:
    """True if the table and its rows are only arguments of functions, or are shown."""
    if _LITERAL.search(text):
        return False
    for use in _use_of(table, *rows).finditer(text):
        before, after = text[: use.start()].rstrip(), text[use.end() :].lstrip()
        is_within = before.removesuffix("*")[-1:] in {"(", ","} and after[:1] in {")", ","}
        if (before or after) and not is_within:
            return False
    return True


# --- Find a statement after a table, such as one in a later cell of a notebook, that may change it


_MOST_NAMES: Final = 2
_RUNS_TEXT: Final = regex(r"(?:exec|eval|assignin)\(")
# A column of a table gets the name of a parameter: theta = DH[i, 3], theta = DH[i][3].
_ELEMENT: Final = regex(
    r"(?<![\w.])((?i:a|alpha|al|d|theta|th)(?:_?i)?)\s?=\s?\w{1,40}"
    r"(?:\[[\w:]{1,12},\s?|\[\w{1,12}\]\[)([0-3])\]"
)
_COMPARES: Final = ("=", "!", "<", ">", "~")
# A statement in a loop over the rows of a table.
_OVER_ROWS: Final = regex(
    r"(?:async\s)?for\s(?P<names>[\w, ()]{1,60}?)\sin\s(?:enumerate\()?(?P<table>\w{1,40})"
    r"[^:\n]{0,60}:(?P<body>.*)",
    re.DOTALL,
)
# A row or a view of a table gets a name: alpha = DH[:, 1].
_GIVES_ROW: Final = regex(
    r"(?P<name>\w{1,40})\s?=\s?(?P<table>\w{1,40})(?:\[[^\]]{1,40}\])*(?:\.T)?"
)
# The same values in another type: DH = np.array(DH, dtype=float).
_IS_COPY: Final = regex(
    r"(?:[A-Za-z]\w{0,20}\.)?(?:array|asarray|Matrix|ImmutableMatrix|DataFrame|list|tuple|simplify|N"
    r"|nsimplify|deepcopy|copy|float)\(\w{1,40}(?:,\s?dtype\s?=\s?[\w.]{1,20})?\)|\w{1,40}\.copy\(\)"
)
# A function or a method that shows a table, or only returns something.
_SHOWS: Final = regex(
    r"(?:disp|display|print|println|pprint|pretty|fprintf|printf|show|head|tail|to_\w+|info|describe"
    r"|plot\w*|scatter|imshow|table|uitable|latex|tabulate|savetxt|save|savemat|dump|dumps|len|shape"
    r"|size|copy|tolist|round|sum|mean|min|max|transpose|reshape|astype|assert\w*|type|isinstance"
    r"|fk\w*|forward\w*|check\w*|test\w*|teach|view|visuali\w+|draw\w*|animate\w*)"
)
_BARE_CALL: Final = regex(r"(?:[A-Za-z_]\w{0,40}\.){0,3}([A-Za-z_]\w{0,40})\(")


def changing_statement(table: str, later: str) -> str:
    """Return the first statement in ``later`` that may change a table of a script, or "".

    Such a statement gives a value to the table, to a part or a row of it, calls a function only for
    what it does to them, or tells that their units or the order of their columns are others.
    """
    try:
        source = without_remarks(SourceText.of(table))
        named = {found[1] for found in _TABLE.finditer(source.text)}
        statements = split(without_remarks(SourceText.of(later)), ";\n\r") if named else []
    except GridError:
        return ""
    has_order = len(set(_PARAMETER.findall(table))) > _MOST_NAMES
    for each in statements:
        text = each.text.strip()
        if _is_new_table(text, named):
            return ""
        if _is_change(text, named, has_order=has_order):
            return " ".join(text.split())
    return ""


def _is_change(statement: str, named: set[str], *, has_order: bool) -> bool:
    # ``named`` gets the names of the rows of the table.
    if not named & set(_WORD.findall(statement)):
        return _RUNS_TEXT.match(statement) is not None
    body = statement
    if loop := _OVER_ROWS.match(statement):
        names, body = _WORD.findall(loop["names"]), loop["body"].strip()
        if loop["table"] in named and len(names) <= _MOST_NAMES:
            # In Python, the rows in a loop are those of the table.
            named.add(names[-1])
    if (given := _GIVES_ROW.fullmatch(body)) and given["table"] in named:
        named.add(given["name"])
    plain = _STRING.sub("", statement.replace(".evalf", ""))
    return (
        _changes(body, named)
        or _TELLS.search(plain) is not None
        or (not has_order and _tells_order(statement))
    )


def _is_new_table(statement: str, named: set[str]) -> bool:
    # Another table with the same name is an answer of its own.
    found = _TABLE.match(statement)
    right = statement[found.end(1) :] if found else ""
    return len(_LITERAL.findall(right)) > _MOST_NAMES and not named & set(_WORD.findall(right))


def _tells_order(statement: str) -> bool:
    for name, place in _ELEMENT.findall(statement):
        if name.lower().strip("_i") != ("a", "alpha", "d", "theta")[int(place)]:
            return True
    rest = _ELEMENT.sub("", _IN_ORDER.sub(_ROW, statement))
    return len(_PARAMETER.findall(rest)) > 1


def _changes(statement: str, named: set[str]) -> bool:
    table = rf"(?<![\w.])(?:{'|'.join(sorted(named))})(?!\w)"
    if re.match(rf"del\s.*{table}", statement) or re.search(rf"out\s?=\s?{table}", statement):
        return True
    left, equals, right = _left_side(statement)
    if equals:
        return re.search(table, left) is not None and not _IS_COPY.fullmatch(right)
    called = re.match(rf"{table}(?:\[[^\]]{{0,80}}\])*\.(\w+)\(", statement)
    if called:
        return not _SHOWS.fullmatch(called[1])
    call = _BARE_CALL.match(statement)
    is_argument = re.search(rf"{table}(?:\[[^\]]{{0,80}}\])*\s?[,)]", statement)
    return call is not None and bool(is_argument) and not _SHOWS.fullmatch(call[1])


def _left_side(statement: str) -> tuple[str, bool, str]:
    # The two sides of an assignment. Signs in brackets belong to arguments.
    depth = 0
    for i, sign in enumerate(statement):
        depth += (sign in "([{") - (sign in ")]}")
        if sign == "=" and depth == 0:
            if "=" in statement[i + 1 : i + 2] or statement[i - 1 : i] in _COMPARES:
                return "", False, ""
            return statement[:i], True, statement[i + 1 :].strip()
    return "", False, ""
