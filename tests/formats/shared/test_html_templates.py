"""HTML templates escape every text."""

import ast
import re
from collections.abc import Iterator
from pathlib import Path

import pytest
from dh_grader.formats import texts as html_templates
from dh_grader.formats.texts import lines, own_html
from dh_grader.translations import say
from jinja2 import Environment, UndefinedError

from tests.formats.submissions import HOSTILE
from tests.translations.pseudo import PSEUDO

SERVICE = Path(__file__).parents[3] / "service" / "dh_grader"
TEMPLATES = sorted(SERVICE.rglob("templates/**/*.html"))
# The functions that call `own_html`, with the HTML that each one passes.
TRUSTED = {
    "formats/texts.py style_sheet": "the style sheets of reports",
    "formats/texts.py typeset": "texts with names in MathML: names.typeset()",
    "formats/texts.py _filled": "texts of templates and of their catalogues",
    "formats/texts.py formula": "formulas in MathML: formulas.formula()",
    "web/pages.py _markdown": "statements and prompts: statement_html()",
    "web/pages.py ten_minutes_page": "the matrix of a row: typeset() and matrix()",
    "web/tutor.py _formula": "MathML of model solutions: formula_html()",
}


@pytest.fixture
def environment() -> Environment:
    return html_templates.environment()


def rendered(environment: Environment, source: str, **values: object) -> str:
    return environment.from_string(source).render(values)


def calls(name: str) -> Iterator[str]:
    """Yield the functions of service/ that call the function ``name``."""
    for file in sorted(SERVICE.rglob("*.py")):
        for node in ast.walk(ast.parse(file.read_text(encoding="utf-8"))):
            if isinstance(node, ast.FunctionDef):
                called = {
                    each.func.id
                    for each in ast.walk(node)
                    if isinstance(each, ast.Call) and isinstance(each.func, ast.Name)
                }
                if name in called:
                    yield f"{file.relative_to(SERVICE).as_posix()} {node.name}"


def test_a_printed_text_is_escaped_and_visible(environment: Environment) -> None:
    shown = rendered(environment, '<p title="{{ text }}">{{ text }}</p>', text=HOSTILE)
    assert "<script" not in shown
    assert "&lt;script&gt;" in shown
    assert shown.count('"') == 2
    assert shown.isprintable()
    assert not re.search("::|##", shown)


def test_values_of_macros_and_loops_are_escaped_once(environment: Environment) -> None:
    source = (
        "{% macro m(t) %}<b>{{ t }}</b>{% endmacro %}{% for t in texts %}{{ m(t) }}{% endfor %}"
    )
    assert (
        rendered(environment, source, texts=["<i>", "\u202e&"])
        == "<b>&lt;i&gt;</b><b>\ufffd&amp;</b>"
    )


def test_html_of_the_service_is_printed_as_it_is(environment: Environment) -> None:
    assert rendered(environment, "{{ html }}", html=own_html("<i>\n</i>")) == "<i>\n</i>"


def test_line_breaks_are_kept_where_a_template_says_so() -> None:
    assert lines("a <b>\n\x1b c\r") == "a &lt;b&gt;\n\ufffd c\ufffd"


def test_a_variable_that_is_missing_fails(environment: Environment) -> None:
    with pytest.raises(UndefinedError):
        rendered(environment, "{{ misspelt }}")


def test_a_template_is_compiled_once(environment: Environment) -> None:
    name = TEMPLATES[0].relative_to(SERVICE).as_posix()
    assert html_templates.environment() is environment
    assert environment.get_template(name) is environment.get_template(name)


@pytest.mark.parametrize("file", TEMPLATES, ids=lambda file: file.name)
def test_no_template_turns_escaping_off(file: Path) -> None:
    source = file.read_text(encoding="utf-8")
    assert not re.search(r"\|\s*safe|autoescape|\bMarkup\b|xmlattr|\|\s*tojson", source)
    # The text of an author's file, in a text area, keeps its control characters.
    assert len(re.findall(r"\|\s*(?:e|escape|forceescape)\b", source)) == (
        file.name == "editor.html"
    )


@pytest.mark.long
def test_only_listed_functions_pass_unescaped_html() -> None:
    assert set(calls("own_html")) == set(TRUSTED)
    assert list(calls("Markup")) == ["formats/texts.py own_html"]


def test_a_printed_sentence_is_told_in_the_language_of_the_page() -> None:
    environment = html_templates.environment(PSEUDO)
    source = (
        '{{ s }}|{{ s | typeset }}|{{ "row" }}|{{ _("<i>") }}|'
        "{% trans a=s %}<b>{{ a }}</b>{% endtrans %}"
    )
    sentence = say("Row {row}\u00a0: {text}", row=2, text="<u>")
    shown = rendered(environment, source, s=sentence)
    told = "Rów 2\u00a0: &lt;u&gt;"
    printed, names, plain, text, html = shown.split("|")
    assert printed.startswith(told)
    assert names.startswith("Rów")
    assert plain == "row"
    assert text.startswith("&lt;i&gt;")
    assert html.startswith(f"<b>{told}")


def test_trusted_html_of_a_catalogue_does_not_trust_its_values(environment: Environment) -> None:
    source = '{% trans t=text %}<b>{{ t }}</b>{% endtrans %}{{ _("T: %(t)s", t=text) }}'
    assert (
        rendered(environment, source, text="<i>\u202e")
        == "<b>&lt;i&gt;\ufffd</b>T: &lt;i&gt;\ufffd"
    )


def test_a_template_counts(environment: Environment) -> None:
    source = "{% trans n=n %}one{% pluralize %}{{ n }} <b>rows</b>{% endtrans %}"
    assert [rendered(environment, source, n=n) for n in (1, 2)] == ["one", "2 <b>rows</b>"]
    assert rendered(html_templates.environment(PSEUDO), source, n=2).startswith("2 <b>rów")
