"""Test how names, formulas and statements are typeset."""

import json
import re
import time
from html.parser import HTMLParser
from pathlib import Path

import pytest
from dh_grader.expressions import characters as greek
from dh_grader.typeset import TypesetName, formula, in_unicode, pieces, statement_html, typeset

# --- Find symbol names in texts

FILE = json.loads(Path(__file__).with_name("names.json").read_text(encoding="utf-8"))
SYMBOLS = frozenset(FILE["symbols"])


def shown(piece: str | TypesetName) -> str:
    if isinstance(piece, str):
        return piece
    return f"<{greek.LETTERS.get(piece.stem, piece.stem)}|{piece.below}|{piece.above}>"


@pytest.mark.parametrize(("text", "expected"), FILE["cases"])
def test_names_are_found_in_a_text(text: str, expected: str) -> None:
    assert "".join(map(shown, pieces(text, SYMBOLS))) == expected


def test_a_name_is_mathml_and_the_rest_is_escaped() -> None:
    assert typeset("<b> theta1 in {0}: R_2^0") == (
        "&lt;b&gt; <math><msub><mi>θ</mi><mn>1</mn></msub></math> in "
        '<span class="maths"><math><mrow><mo stretchy="false">{</mo><mn>0</mn>'
        '<mo stretchy="false">}</mo></mrow></math>:</span>'
        " <math><msubsup><mi>R</mi><mn>2</mn><mn>0</mn></msubsup></math>"
    )


def test_a_title_has_letters_and_lowered_digits() -> None:
    assert (
        in_unicode("An arm with theta1, d12 and z_i in {0}") == "An arm with θ₁, d₁₂ and z_i in {0}"
    )


@pytest.mark.parametrize("run", ["(", "[−", "1"])
def test_a_long_run_of_signs_takes_linear_time(run: str) -> None:
    began = time.process_time()
    typeset(run * 20_000)
    # It took 1.4 to 26 s in quadratic time; it takes some milliseconds.
    assert time.process_time() - began < 1


# --- Convert the formulas in a text to MathML


def formula_shown(html: str) -> str:
    html = html.replace("<math>", "[").replace("</math>", "]")
    return re.sub("<[^>]*>|&#x206[12];", "", html)


@pytest.mark.parametrize(
    ("text", "expected"),
    [
        ("-pi/2", "[−π2]"),
        ("theta1 + 90deg", "[θ1] [+90°]"),
        ("a - (b - c)*2", "[a] [−(b−c)⋅2]"),
        ("a - (b - c)", "[a−(b−c)]"),
        ("a + (-b)", "[a+(−b)]"),
        ("1e-3", "[1⋅10-3]"),
        ("a +", "a +"),
        ("theta_1 + theta1", "theta_1 + theta1"),
        ("<b>", "&lt;b&gt;"),
        ("c*" * 20 + "theta1", "[c] ⋅ " * 20 + "[θ1]"),
    ],
)
def test_each_term_of_a_sum_is_a_formula(text: str, expected: str) -> None:
    assert formula_shown(formula(text)) == expected


# --- Convert statements to HTML without scripts or external content


class Elements(HTMLParser):
    """The HTML elements and attributes in a text."""

    def __init__(self, html: str) -> None:
        super().__init__()
        self.found: list[tuple[str, dict[str, str | None]]] = []
        self.feed(html)

    def handle_starttag(self, tag: str, attrs: list[tuple[str, str | None]]) -> None:
        self.found.append((tag, dict(attrs)))


def names(html: str) -> set[str]:
    return {tag for tag, _ in Elements(html).found}


def test_markdown_and_formulas() -> None:
    html = statement_html("Two **joints**:\n\n- $\\theta_1$ and $\\frac{\\pi}{2}$\n- costs \\$5")
    assert "<strong>joints</strong>" in html
    assert "<msub><mi>θ</mi><mn>1</mn></msub>" in html
    assert "<mfrac><mrow><mi>π</mi></mrow><mrow><mn>2</mn></mrow></mfrac>" in html
    assert "costs $5</li>" in html


def test_a_matrix_and_a_table() -> None:
    html = statement_html(
        "$$\\begin{bmatrix}1&2\\\\3&4\\end{bmatrix}$$\n\n| a | b |\n|:-:|--|\n| $x$ | 2 |"
    )
    assert html.count("<mtd>") == 4
    assert 'display="block"' in html
    assert {"table", "th", "td"} <= names(html)
    assert "style" not in html


def test_names_are_typeset_but_not_in_code() -> None:
    html = statement_html("Rot_z(theta) and z_i, `theta1`, *not* l", frozenset({"l"}))
    assert html == (
        '<p><span class="maths"><math><msub><mi>Rot</mi><mi>z</mi></msub></math>'
        "(<math><mi>θ</mi></math>)</span> and "
        '<span class="maths"><math><msub><mi>z</mi><mi>i</mi></msub></math>,</span> '
        "<code>theta1</code>, <em>not</em> "
        "<math><mi>l</mi></math></p>\n"
    )


def test_a_name_may_stand_at_the_end_of_a_line() -> None:
    html = statement_html("its z\naxis, and *its*\nx\n\nline")
    assert html == "<p>its <math><mi>z</mi></math>\naxis, and <em>its</em>\nx</p>\n<p>line</p>\n"


def test_a_block_is_a_matrix_of_formulas() -> None:
    html = statement_html("```matrix T_1\ncos phi, -pi/2\n0, atan2(x, 2e-3)\n```")
    assert html.startswith('<div class="display"><math><msub><mi>T</mi><mn>1</mn></msub></math> = ')
    assert html.count("<mtr>") == 2
    assert "<mtd><mrow><mo>−</mo><mfrac><mi>π</mi><mn>2</mn></mfrac></mrow></mtd>" in html


@pytest.mark.parametrize("text", ["1, 2\n3", "1, 2\n<b>, 4", "", ",".join("1" * 65)])
def test_a_block_that_is_no_matrix_is_shown_as_it_is_written(text: str) -> None:
    html = statement_html(f"```matrix\n{text}\n```")
    assert html == f"<pre><code>{text.replace('<b>', '&lt;b&gt;')}\n</code></pre>\n"


HOSTILE = [
    "<script>alert(1)</script>",
    '<img src=x onerror="alert(1)">',
    "<svg onload=alert(1)>",
    "[x](javascript:alert(1))",
    "[x](JaVaScRiPt&colon;alert(1))",
    "[x](data:text/html,<script>alert(1)</script>)",
    "![x](https://example.org/x.png)",
    "<https://example.org/\"onmouseover='alert(1)'>",
    "$\\text{<script>alert(1)</script>}$",
    "$\\text{<img src=x onerror=alert(1)>}$",
    "$\\href{javascript:alert(1)}{x}$",
    "$\\style{background:url(//example.org)}{x}$",
    "$\\class{evil}{x}$",
    "$\\unicode{x3c}script\\unicode{x3e}$",
    "$</math><script>alert(1)</script>$",
    "$$\\text{</mtext></math><iframe src=//example.org>}$$",
    "a[^1]: <b>",
    "[a]: javascript:alert(1)\n\n[a]",
]
HARMLESS = {
    "p", "strong", "em", "a", "ul", "ol", "li", "code", "pre", "table", "thead", "tbody", "tr",
    "th", "td", "span", "div", "br", "math", "mrow", "mi", "mn", "mo", "mtext",
}  # fmt: skip


@pytest.mark.parametrize("text", HOSTILE)
def test_hostile_markup_is_shown_as_text(text: str) -> None:
    for tag, attributes in Elements(statement_html(text)).found:
        assert tag in HARMLESS
        assert set(attributes) <= {"href", "class", "display", "stretchy"}
        assert (attributes.get("href") or "https://").lower().startswith("https://")


def test_marks_that_turn_the_direction_are_shown() -> None:
    assert statement_html("a\u202eb\u2066c") == "<p>a[U+202E]b[U+2066]c</p>\n"


@pytest.mark.parametrize(
    "latex", ["{" * 1_900, "\\frac{1}" * 900, "\\left(", "\\begin{x}", "x" * 3_000]
)
def test_a_formula_that_cannot_be_shown_is_shown_as_it_is_written(latex: str) -> None:
    html = statement_html(f"${latex}$")
    assert names(html) <= {"p", "span", "code", "math", "mrow", "mfrac", "mn", "mo", "mi"}
