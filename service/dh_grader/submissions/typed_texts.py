"""Read the text of a file in any encoding, and web pages as a person typed them.

It knows the editors of platforms, which send web pages, and no file of an office program.
"""

import re
from collections.abc import Iterator
from contextlib import suppress
from html import unescape
from typing import Final

from dh_grader.regex import regex
from dh_grader.submissions.documents import Excerpt, UnusableFileError, around_rows
from dh_grader.translations import say

# The most tags in one file. A document of two megabytes from Word has about as many; a hostile file
# has a tag in every third byte, and each tag takes more time than a thousand letters.
MAX_TAGS: Final = 60_000


def too_much() -> UnusableFileError:
    """Return the error about a file with too many parts."""
    return UnusableFileError(
        say("holds more than a hand-in needs; leave only the table or matrix in it")
    )


def struck_out(text: str) -> str:
    """Return struck-out text as Markdown writes it, which no reader of tables takes."""
    inner = text.strip(" ~")
    before, _, after = text.partition(inner) if inner else (text, "", "")
    return f"{before}~~{inner.replace('~', '')}~~{after}" if inner else text


# --- The text of a file


def decoded(data: bytes) -> str:
    """Return the text of a file in UTF-8, UTF-16 or Windows-1252. Raises UnusableFileError."""
    if data.startswith((b"\xff\xfe", b"\xfe\xff")):
        try:
            return data.decode("utf-16")
        except UnicodeError as error:
            raise UnusableFileError(
                say("is not text: it begins like UTF-16, but is invalid")
            ) from error
    if b"\0" in data:
        return _wide(data)
    try:
        return data.decode("utf-8-sig")
    except UnicodeDecodeError:
        pass
    # Python leaves five bytes of Windows-1252 undefined; no text has them.
    if any(byte < 32 and byte not in b"\t\n\r\f" for byte in data):
        raise UnusableFileError(say("is not text"))
    try:
        text = data.decode("cp1252")
    except UnicodeDecodeError as error:
        raise _other_encoding() from error
    if _IMPLAUSIBLE.search(text):
        raise _other_encoding()
    return text


# Signs that no text in Windows-1252 has at such places, but one in GBK, in the code page of a Mac
# or in Cyrillic letters, which is decoded as Windows-1252: "Á¬¸Ë³¤¶È", "180¡", "LŠnge", "¹/2".
_IMPLAUSIBLE: Final = regex(
    r"[¬¸¶¤¦¨¯]|[À-ÖØ-öø-ÿ¡-§©-¯±-¶¸-º¼-¿×÷ŠšŒœŽžŸƒˆ˜]{4}|[²³µ¼½¾±][À-ÖØ-öø-ÿ]"
    r"|\w[¡§]|[€†‡…ˆ‰][a-z]|[A-Za-z][ŠŽŒŸ€†‡ˆ‰](?=[a-z\s])|(?<![\w)])¹"
)


def _other_encoding() -> UnusableFileError:
    return UnusableFileError(
        say(
            "is not text in UTF-8 or Windows-1252; if it is a text, save it as UTF-8, and hand it "
            "in again"
        )
    )


def _wide(data: bytes) -> str:
    """Return the text of a file in UTF-16 without a byte order mark. Raises UnusableFileError.

    The file must be certain: half of its letters are ASCII, and all of them can be printed.
    """
    for encoding, first in (("utf-16-le", 1), ("utf-16-be", 0)):
        high, low = data[first::2], data[1 - first :: 2]
        if len(data) % 2 == 0 and 0 not in low and 2 * high.count(0) >= len(high):
            with suppress(UnicodeDecodeError):
                text = data.decode(encoding)
                if all(sign.isprintable() or sign in "\t\n\r\f" for sign in text):
                    return text
    raise UnusableFileError(
        say("is not text: it has zero bytes; if it is a text, save it as UTF-8")
    )


# --- Web pages

_TABLE: Final = regex(r"<(?:table|tr)(?![A-Za-z0-9-])", re.IGNORECASE)
# What begins a new line on a web page.
_BREAK: Final = regex(
    r"</?(?:p|div|br|li|ul|ol|pre|h[1-6]|blockquote|section|article|body|html|head)"
    r"(?![A-Za-z0-9-])[^<>]{0,2000}>",
    re.IGNORECASE,
)
# The start of an element that a browser does not show.
_HIDDEN: Final = regex(r"<(head|style|script|title)(?![A-Za-z0-9-])|<!--|<!", re.IGNORECASE)
_TAG: Final = regex(r"</?[A-Za-z][^<>]{0,2000}>")
_STRUCK_TAG: Final = regex(
    r"<(s|del|strike|span(?=[^<>]{1,400}line-through))(?![A-Za-z0-9-])[^<>]{0,2000}>([^<>]{1,400})"
    r"</\1>",
    re.IGNORECASE,
)
_RAISED: Final = regex(r"<sup(?![A-Za-z0-9-])[^<>]{0,2000}>([^<>]{1,40})</sup>", re.IGNORECASE)


def typed_text(page: str) -> str:
    r"""Return the lines that a person typed into a platform's editor, which sends a web page.

    >>> typed_text("<p>0,&nbsp;0, 0, q1<br>l1, 0, 0, q2</p>")
    '0, 0, 0, q1\nl1, 0, 0, q2'
    """
    is_preformatted = re.search("<pre(?![A-Za-z0-9-])", page, re.IGNORECASE) is not None
    page = _visible(page)
    if not is_preformatted and _BREAK.search(page):
        # Line ends in the source of a page mean no more than blanks.
        page = " ".join(page.split("\n"))
    page = _STRUCK_TAG.sub(lambda found: struck_out(found[2]), page)
    page = _RAISED.sub(lambda found: "°" if found[1] in "oO0°" else f"^({found[1]})", page)
    text = unescape(_TAG.sub("", _BREAK.sub("\n", page))).replace("\u00a0", " ")
    lines = (line.strip(" ") for line in text.splitlines())
    return "\n".join(line for line in lines if line.strip())


def _visible(page: str) -> str:
    """Return a web page without its head, styles, scripts and comments."""
    lowered = page.lower()
    pieces = []
    start = position = 0
    unclosed: set[str] = set()
    while found := _HIDDEN.search(lowered, position):
        opening = found[0]
        closing = {"<!--": "-->", "<!": ">"}.get(opening, f"</{opening[1:]}")
        close = -1 if opening in unclosed else lowered.find(closing, found.end())
        end = lowered.find(">", close) + 1 if close >= 0 else 0
        position = found.end()
        if end:
            pieces.append(page[start : found.start()])
            start = position = end
        else:
            # Such an element is not searched for again, so that the time stays linear.
            unclosed.add(opening)
    return "".join(pieces) + page[start:]


def web_page(data: bytes) -> Iterator[Excerpt]:
    """Yield the tables of a web page, and its text. Raises UnusableFileError."""
    page = decoded(data)
    if page.count("<") + page.count("&") > MAX_TAGS:
        raise too_much()
    page = _visible(page)
    has_table = _TABLE.search(page) is not None
    if has_table:
        yield Excerpt(page, around=around_rows(page))
    text = typed_text(page)
    if text:
        yield Excerpt(text, level=1 if has_table else 0)
