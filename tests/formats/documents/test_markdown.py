"""Test reports in Markdown."""

# They are parsed as CommonMark with the extensions of GitHub.

import re
from collections.abc import Iterator

import pytest
from dh_grader.formats.texts import escaped, sentence
from markdown_it import MarkdownIt
from markdown_it.token import Token

from tests.formats.submissions import HOSTILE, cases, document

READER = MarkdownIt("commonmark", {"html": True}).enable(["table", "strikethrough"])
# The tokens of the format itself. Any other token would come from a text.
MEANT = {"text", "code_inline", "strong_open", "strong_close", "softbreak"}


def tokens(text: str) -> Iterator[Token]:
    for token in READER.parse(text):
        yield token
        yield from token.children or ()


def inline(text: str) -> list[Token]:
    return [child for token in READER.parse(text) for child in token.children or ()]


def shown(text: str) -> str:
    return "".join(token.content for token in inline(text))


@pytest.mark.parametrize("case", cases())
@pytest.mark.parametrize("name", ["markdown", "gradescope"])
def test_no_text_becomes_markup(name: str, case: str) -> None:
    page = document("markdown", cases()[case])
    found = {token.type for token in inline(page)}
    assert found <= MEANT, found - MEANT
    assert {token.type for token in tokens(page)}.isdisjoint({"html_block", "fence", "hr", "image"})


@pytest.mark.parametrize("case", cases())
def test_no_text_becomes_a_mention_or_a_link(case: str) -> None:
    # GitHub looks for mentions in the rendered text, outside of code.
    texts = [each.content for each in inline(document("markdown", cases()[case]))]
    plain = [
        token.content
        for token in inline(document("markdown", cases()[case]))
        if token.type == "text"
    ]
    assert texts
    assert [found for text in plain for found in re.findall(r"@\w|#\d", text)] == []
    # GitHub looks for bare links in the source.
    source = re.sub("`[^`]*`", "", document("markdown", cases()[case]))
    assert re.findall(r"www\.|https?://", source) == []


def test_an_escaped_text_is_shown_unchanged() -> None:
    for text in ("_a_ * b_c ~x~ <b> &amp; | \\ [x](y) `z`", "1. x", "# x", "http://x.y", "a_1"):
        assert shown(f"x {escaped(text)}") == f"x {text}"
    seen = shown(f"x {escaped(HOSTILE)}")
    assert "<script>alert(1)</script>" in seen
    assert "**bold** _em_ ~~s~~ `code` ![i](http://e.vil)" in seen


def test_backticks_in_a_message_enclose_code() -> None:
    assert [(each.type, each.content) for each in inline(sentence("write `a*b`, not `<b>`"))] == [
        ("text", "write "), ("code_inline", "a*b"), ("text", ", not "), ("code_inline", "<b>"),
    ]  # fmt: skip
    assert [each.content for each in inline(sentence("`a``b`"))] == ["a", " ", "b"]
    for hostile in ("`a``<b>`", "``<b>``", "`<b>", "```<b>```", "`a```<b>`"):
        assert {each.type for each in inline(f"x {sentence(hostile)}")} <= {"text", "code_inline"}


def test_a_table_of_submissions_precedes_the_parts_of_each() -> None:
    page = document("markdown", cases()["wrong"], cases()["unusable"])
    cells = [
        token.content
        for before, token in zip(READER.parse(page), READER.parse(page)[1:], strict=False)
        if before.type in ("th_open", "td_open")
    ]
    assert cells[:12] == [
        "submission", "points", "score", "passed",
        "folder/anna.json", "11 / 16", "68.7 %", "✗",
        "folder/b.json", "", "not graded", "✗",
    ]  # fmt: skip
    assert "✗ row 2 alpha: " in shown(page)
