"""Test the pages, their words, and their files."""

import asyncio
import gzip
import html
import json
import re
from collections.abc import Iterator, Mapping
from dataclasses import replace
from functools import cache
from pathlib import Path

import httpx
import pytest
import sympy as sp
from dh_grader.api.application import application
from dh_grader.api.http import LANGUAGE_COOKIE
from dh_grader.catalogue import Exercise
from dh_grader.expressions import ExpressionError, read
from dh_grader.translations import ENGLISH, LANGUAGES, Language
from dh_grader.web import pages, web_routes
from dh_grader.web.pages import (
    FOLDER,
    TOPICS,
    dictionary,
    help_page,
    load_assets,
    sentences_in,
    words_of,
)

from tests.expressions.corpus_files import ROBOT
from tests.grading.support.submitting import full_marks, handed_in, part
from tests.shipped import shipped_exercises
from tests.translations.catalogues import extracted
from tests.translations.pseudo import PSEUDO, without_others

# --- Test the responses for pages and static files

# The first view of an exercise: the page, all scripts and styles, compressed as for a browser.
MOST_BYTES = 120_000


class Client:
    """Sends requests to an application in this process."""

    def __init__(self, catalogue: Mapping[str, Exercise]) -> None:
        self.app = application(catalogue, pages=web_routes(catalogue))

    def get(self, path: str) -> httpx.Response:
        return asyncio.run(self._get(path))

    async def _get(self, path: str) -> httpx.Response:
        transport = httpx.ASGITransport(self.app)
        async with httpx.AsyncClient(transport=transport, base_url="http://service") as client:
            return await client.get(path)


@pytest.fixture(scope="module")
def client(catalogue: Mapping[str, Exercise]) -> Client:
    return Client(catalogue)


def named(page: httpx.Response) -> Iterator[str]:
    """Yield the paths of the scripts, styles and images that a page loads."""
    for address in re.findall(r'<(?:link|script|img)[^>]* (?:href|src)="([^"]+)"', page.text):
        yield str(page.url.join(address).path)


@pytest.mark.parametrize("path", ["/", "/exercises/scara"])
def test_a_page_is_small_and_its_files_are_cached_without_limit(client: Client, path: str) -> None:
    page = client.get(path)
    addresses = set(named(page))
    files = {each: client.get(each) for each in addresses if not each.endswith("/figure.svg")}
    assert len(files) > 3
    for address, file in files.items():
        assert file.status_code == 200
        assert re.search(r"-[0-9a-f]{12}\.(js|css|svg)$", address)
        assert "immutable" in file.headers["cache-control"]
        assert file.headers["x-content-type-options"] == "nosniff"
        assert file.headers["cross-origin-resource-policy"] == "cross-origin"
    # The style of the element is loaded by its script.
    style = load_assets().name("element.css")
    figure = client.get("/v1/exercises/stanford-arm/figure.svg")
    loaded = [page, *files.values(), client.get(f"/static/{style}"), figure]
    assert sum(len(gzip.compress(each.content, 6)) for each in loaded) < MOST_BYTES


def test_the_policy_allows_no_other_hosts_and_nothing_inline(client: Client) -> None:
    page = client.get("/exercises/scara")
    policy = page.headers["content-security-policy"]
    directives = dict(part.strip().split(" ", 1) for part in policy.split(";"))
    sources = {name: set(value.split()) for name, value in directives.items()}
    assert sources.pop("require-trusted-types-for") == {"'script'"}
    assert sources.pop("trusted-types") == {"dh-grader"}
    # A drawing that the service sent is shown as an image, which can do nothing.
    assert sources.pop("img-src") == {"'self'", "blob:"}
    assert set().union(*sources.values()) == {"'none'", "'self'"}
    assert sources["default-src"] == {"'none'"}
    assert "<style" not in page.text
    assert "style=" not in page.text
    assert re.findall(r"<script(?![^>]* src=)", page.text) == []


def test_an_exercise_can_be_read_without_scripts(client: Client) -> None:
    page = client.get("/exercises/scara")
    assert "all four axes are vertical" in " ".join(page.text.split())
    assert 'src="../v1/exercises/scara/figure.svg"' in page.text
    assert "Give the standard DH table, one row for each joint." in page.text
    assert "<noscript>" in page.text
    assert client.get("/?exercise=scara").headers["location"] == "exercises/scara"
    assert client.get("/exercises/no-such").status_code == 404
    assert client.get("/static/embed.js").status_code == 404


def test_the_script_with_a_fixed_name_is_always_revalidated(client: Client) -> None:
    script = client.get("/embed.js")
    assert script.headers["cache-control"] == "no-cache"
    assert script.headers["access-control-allow-origin"] == "*"
    [module] = re.findall(r'from "\./(static/[^"]+)"', script.text)
    assert client.get(f"/{module}").status_code == 200


# --- Assets


def test_a_name_changes_with_the_file_and_with_the_files_it_names(tmp_path: Path) -> None:
    for room in ("page", "shared"):
        (tmp_path / room).mkdir()
    entry, dom = tmp_path / "page" / "entry.js", tmp_path / "shared" / "dom.js"
    entry.write_text('import { h } from "../shared/dom.js";\n', encoding="utf-8")
    dom.write_text("export const h = 1;\n", encoding="utf-8")
    before = load_assets(tmp_path)
    dom.write_text("export const h = 2;\n", encoding="utf-8")
    after = load_assets(tmp_path)
    for name in ("entry.js", "dom.js"):
        assert before.name(name) != after.name(name)
    assert f'"./{after.name("dom.js")}"'.encode() in after.by_plain_name["entry.js"].content
    assert after.modules("entry.js") == [after.name("entry.js"), after.name("dom.js")]


def test_a_file_that_names_an_absent_one_is_refused(tmp_path: Path) -> None:
    (tmp_path / "entry.js").write_text('import "./gone.js";\n', encoding="utf-8")
    with pytest.raises(LookupError, match=r"gone\.js"):
        load_assets(tmp_path)


def test_a_path_to_the_wrong_room_is_refused(tmp_path: Path) -> None:
    (tmp_path / "shared").mkdir()
    (tmp_path / "shared" / "dom.js").write_text("", encoding="utf-8")
    (tmp_path / "entry.js").write_text('import "./dom.js";\n', encoding="utf-8")
    with pytest.raises(LookupError, match=r"dom\.js"):
        load_assets(tmp_path)


def test_two_files_of_one_name_are_refused(tmp_path: Path) -> None:
    for room in ("student", "tutor"):
        (tmp_path / room).mkdir()
        (tmp_path / room / "cell.js").write_text("", encoding="utf-8")
    with pytest.raises(ValueError, match=r"cell\.js"):
        load_assets(tmp_path)


def test_an_address_of_the_service_is_not_taken_for_a_file(tmp_path: Path) -> None:
    text = 'post("../tutor/check"); new URL("../", import.meta.url);\n'
    (tmp_path / "entry.js").write_text(text, encoding="utf-8")
    assert load_assets(tmp_path).by_plain_name["entry.js"].content == text.encode()


def test_a_page_does_not_preload_what_a_script_loads_later(tmp_path: Path) -> None:
    text = 'later(import.meta.resolve("./scene.js"), () => import("./scene.js"));\n'
    (tmp_path / "entry.js").write_text(text, encoding="utf-8")
    (tmp_path / "scene.js").write_text("", encoding="utf-8")
    assets = load_assets(tmp_path)
    assert assets.modules("entry.js") == [assets.name("entry.js")]
    content = assets.by_plain_name["entry.js"].content.decode()
    assert content.count(f'"./{assets.name("scene.js")}"') == 2


# --- Test the words by which the search finds exercises

SEVEN = ("franka-research-3", "kuka-lbr-iiwa-7", "kinova-gen3", "sawyer")
MODIFIED = {
    "planar-rrr", "planar-rrr-drawn", "planar-rrr-frames", "rrrp-proximal", "franka-research-3",
    "kuka-lbr-iiwa-7", "kinova-gen3", "puma-560-craig", "find-the-slip-stanford",
    "first-arm-modified", "planar-rrr-faded",
}  # fmt: skip


@pytest.mark.parametrize(
    ("query", "expected"),
    [
        ("proximal", MODIFIED),
        ("modified", MODIFIED),
        ("7dof", {"baxter-left-arm", *SEVEN}),
        ("7R", {"baxter-left-arm", *SEVEN}),
        ("puma", {"spatial-rrr", "spherical-wrist", "puma-560", "puma-560-craig"}),
        (
            "scara",
            {"scara", "rrrp", "rrrp-drawn", "rrrp-proximal", "adept-cobra-600", "vertical-axes"}
            | {"find-the-slip-scara", "scara-faded"},
        ),
        ("e-Series", {"ur3e", "ur5e", "ur10e", "ur16e"}),
        ("KUKA", {"kuka-kr-5-arc", "kuka-kr-10-r1100", "kuka-lbr-iiwa-7", "kuka-youbot-arm"}),
        ("gantry", {"abb-irb-6620lx", "three-link-cartesian"}),
        ("RPP", {"three-link-cylindrical"}),
    ],
)
def test_a_word_finds_the_exercises_that_it_means(query: str, expected: set[str]) -> None:
    shipped = shipped_exercises()
    found = {
        name for name, each in shipped.items() if query.lower() in words_of(each).lower().split()
    }
    assert found == expected


def test_words_of_conventions_and_joints_find_every_exercise_with_them() -> None:
    for each in shipped_exercises().values():
        words = words_of(each).split()
        assert ("prismatic" in words) == ("P" in (each.structure or ""))
        assert ("distal" in words) == ("standard" in each.conventions)


# --- Before its script arrives, a form never puts its fields into the address

PAGES = sorted(Path(pages.__file__).parent.rglob("*.html"))
FORMS = [
    (page, form) for page in PAGES for form in re.findall(r"<form\b[^>]*>", page.read_text("utf-8"))
]


@pytest.mark.parametrize(("page", "form"), FORMS, ids=lambda each: getattr(each, "name", None))
def test_no_form_puts_its_fields_into_an_address(page: Path, form: str) -> None:
    # If a form has no method, a browser puts the typed text into the query of the address.
    [method] = re.findall(r'method="(\w+)"', form)
    assert method in ("post", "dialog"), page


# --- Test the dictionaries for translations in the scripts of pages

SCRIPTS = [file.read_text("utf-8") for file in FOLDER.rglob("*.js") if "vendor" not in file.parts]


def words_in(module: str) -> tuple[dict[str, str], dict[str, list[str]]]:
    found = json.loads(module.removeprefix("export default ").removesuffix(";\n"))
    assert found["tag"] == PSEUDO.tag
    return found["words"], found["counts"]


def test_a_dictionary_has_all_sentences_of_the_scripts_and_no_others() -> None:
    words, counts = words_in(dictionary(PSEUDO, sentences_in(SCRIPTS)))
    marked = [
        each.id
        for each in extracted("pages")
        if any(name.endswith(".js") for name, _ in each.locations)
    ]
    assert set(words) == {each for each in marked if isinstance(each, str)}
    assert set(counts) == {each[0] for each in marked if not isinstance(each, str)}
    assert all(any(letter > "\x7f" for letter in each) for each in words.values())


def test_strings_of_either_quotes_are_found() -> None:
    script = (
        """worded("A “b” \\"c\\"", { d }); wordedFor('one "x"', "it\\u2019s", 2); other("no")"""
    )
    words, counts = words_in(dictionary(PSEUDO, sentences_in([script])))
    assert set(words) == {'A “b” "c"'}
    assert set(counts) == {'one "x"'}


def test_the_script_with_the_words_names_the_dictionary(
    monkeypatch: pytest.MonkeyPatch, tmp_path: Path
) -> None:
    (tmp_path / "words.js").write_text('const FILES = {};\nworded("Check");\n', encoding="utf-8")
    without_others(monkeypatch)
    plain = load_assets(tmp_path)
    assert plain.words(PSEUDO) is None
    assert plain.by_plain_name["words.js"].content.startswith(b"const FILES = {};")
    monkeypatch.setitem(LANGUAGES, PSEUDO.code, PSEUDO)
    assets = load_assets(tmp_path)
    name = assets.words(PSEUDO)
    assert name is not None
    assert f'{{"qps": "./{name}"}}'.encode() in assets.by_plain_name["words.js"].content
    assert b'"Check": "' in assets.by_name[name].content
    assert plain.name("words.js") != assets.name("words.js")


def test_every_marked_sentence_is_a_constant() -> None:
    found = [
        match[0]
        for script in SCRIPTS
        for match in re.finditer(r"(?<!function )\bworded(?:For)?\(\s*(?![\s\"'])[^\n]*", script)
    ]
    assert found == []


# --- The page "DH in ten minutes" shows the correct matrix of a table row

# Spong, Hutchinson, Vidyasagar, section 3.2; Craig, section 3.4.
MOVES = {"standard": "Rotzθ Transzd Transxa Rotxα", "modified": "Rotxα Transxa Rotzθ Transzd"}
SIGNS = str.maketrans({"\u2061": "", "\u2062": "*", "−": "-", "θ": "theta", "α": "alpha"})
TAGS = re.compile("<[^>]*>")


def move(name: str) -> sp.Matrix:
    axis, amount = "xyz".index(name[-2]), sp.Symbol(name[-1].translate(SIGNS))
    made = sp.eye(4)
    if name.startswith("Trans"):
        made[axis, 3] = amount
        return made
    one, other = (axis + 1) % 3, (axis + 2) % 3
    made[one, one] = made[other, other] = sp.cos(amount)
    made[other, one], made[one, other] = sp.sin(amount), -sp.sin(amount)
    return made


def factors(text: str) -> tuple[bool, list[str]]:
    return text.startswith("-"), sorted(text.removeprefix("-").split("*"))


async def page(catalogue: Mapping[str, Exercise]) -> str:
    app = application(catalogue, pages=web_routes(catalogue))
    transport = httpx.ASGITransport(app)
    async with httpx.AsyncClient(transport=transport, base_url="http://service") as client:
        return (await client.get("/learn-dh")).text


@pytest.mark.parametrize("convention", MOVES)
def test_the_matrix_of_a_row_is_the_product_of_its_moves(
    catalogue: Mapping[str, Exercise], convention: str
) -> None:
    told = html.unescape(asyncio.run(page(catalogue))).partition('id="link-transform"')[2]
    shown = told.partition(f'{convention}"><b class="which">')[2].partition("</div>")[0]
    moves, _, matrix = shown.partition('<div class="display">')
    named = re.sub(r"[()]", "", TAGS.sub("", moves.partition("</b>")[2]))
    assert " ".join(named.split()) == f"Ai = {MOVES[convention]} ="
    entries = [
        factors(TAGS.sub("", each).translate(SIGNS))
        for each in re.findall("<mtd>(.*?)</mtd>", matrix)
    ]
    product = sp.eye(4)
    for each in MOVES[convention].split():
        product *= move(each)
    assert entries == [factors(str(each)) for each in product]


# --- Test the pages in languages other than English

LANGUAGES_PAGES = (
    "/",
    "/exercises/scara",
    "/practice",
    "/play",
    "/learn",
    "/learn-dh",
    "/help/points",
    "/docs",
)
SWITCH = '<details class="languages">'


class LanguagesClient:
    """Sends requests to an application in this process."""

    def __init__(self, catalogue: Mapping[str, Exercise]) -> None:
        self.app = application(catalogue, pages=web_routes(catalogue))

    def get(self, path: str, **headers: str) -> httpx.Response:
        return asyncio.run(self._get(path, headers))

    async def _get(self, path: str, headers: Mapping[str, str]) -> httpx.Response:
        transport = httpx.ASGITransport(self.app)
        async with httpx.AsyncClient(transport=transport, base_url="http://service") as client:
            return await client.get(path, headers=dict(headers))


@pytest.fixture
def languages_client(
    catalogue: Mapping[str, Exercise], monkeypatch: pytest.MonkeyPatch
) -> LanguagesClient:
    """Return a client of a service that offers a second language."""
    monkeypatch.setitem(LANGUAGES, PSEUDO.code, PSEUDO)
    return LanguagesClient(catalogue)


@pytest.mark.sampled(4)
@pytest.mark.parametrize("path", LANGUAGES_PAGES)
def test_with_one_language_there_is_no_switch(
    catalogue: Mapping[str, Exercise], monkeypatch: pytest.MonkeyPatch, path: str
) -> None:
    without_others(monkeypatch)
    page = LanguagesClient(catalogue).get(f"{path}?lang=qps")
    assert '<html lang="en">' in page.text
    assert SWITCH not in page.text
    assert "words-qps" not in page.text
    assert "set-cookie" not in page.headers


@pytest.mark.sampled(4)
@pytest.mark.parametrize("path", LANGUAGES_PAGES)
def test_a_page_is_told_in_the_language_of_its_reader(
    languages_client: LanguagesClient, path: str
) -> None:
    page = languages_client.get(path, **{"accept-language": "qps"})
    assert '<html lang="qps-Ploc">' in page.text
    assert page.headers["content-language"] == "qps-Ploc"
    assert {"Accept-Language", "Cookie"} <= set(page.headers["vary"].split(", "))
    assert "set-cookie" not in page.headers
    assert '<a href="?lang=en" lang="en" hreflang="en">English</a>' in page.text
    assert 'hreflang="qps-Ploc" aria-current="true"' in page.text
    assert "Éxéŕćíśéś" in page.text or "Éxérćíśéś" in page.text


def test_a_choice_is_kept_in_a_cookie(languages_client: LanguagesClient) -> None:
    chosen = languages_client.get("/practice?lang=qps")
    assert '<html lang="qps-Ploc">' in chosen.text
    assert chosen.headers["set-cookie"].startswith(f"{LANGUAGE_COOKIE}=qps;")
    later = languages_client.get("/", cookie=f"{LANGUAGE_COOKIE}=qps")
    assert '<html lang="qps-Ploc">' in later.text
    assert "set-cookie" not in later.headers
    back = languages_client.get("/?lang=en", cookie=f"{LANGUAGE_COOKIE}=qps")
    assert '<html lang="en">' in back.text
    led = languages_client.get("/?exercise=scara&lang=qps")
    assert led.headers["set-cookie"].startswith(f"{LANGUAGE_COOKIE}=qps;")


def test_a_problem_is_told_in_the_language_of_its_reader(languages_client: LanguagesClient) -> None:
    page = languages_client.get("/nowhere?lang=qps", accept="text/html")
    assert page.status_code == 404
    assert '<html lang="qps-Ploc">' in page.text
    assert "Page not found" not in page.text
    assert {"Accept", "Accept-Language"} <= set(page.headers["vary"].split(", "))


def test_a_generated_robot_is_told_on_its_page_and_over_http(
    languages_client: LanguagesClient,
) -> None:
    name = "practice-2-standard~5"
    page = languages_client.get(f"/exercises/{name}?lang=de").text
    shown = languages_client.get(f"/v1/exercises/{name}?lang=de").json()
    for text in (
        "Übungsroboter 5, Stufe 2",
        "Von DH Grader erzeugt",
        "sind alle Gelenkvariablen 0",
    ):
        assert text in page
        assert text in shown["title"] + shown["source"] + shown["statement"]
    assert shown["parts"][0]["prompt"].startswith("Geben Sie die DH-Tabelle in der Standardkonv")
    assert "At home" not in page + shown["statement"]


def test_the_dictionary_of_the_scripts_is_preloaded(languages_client: LanguagesClient) -> None:
    page = languages_client.get("/exercises/scara?lang=qps")
    [name] = re.findall(r'rel="modulepreload" href="\.\./static/(words-qps-\w+\.js)"', page.text)
    file = languages_client.get(f"/static/{name}")
    assert file.headers["access-control-allow-origin"] == "*"
    assert "immutable" in file.headers["cache-control"]
    assert file.text.startswith("export default {")
    assert "words-qps" not in languages_client.get("/exercises/scara").text


def test_values_in_sentences_of_templates_are_escaped(
    catalogue: Mapping[str, Exercise], monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setitem(LANGUAGES, PSEUDO.code, PSEUDO)
    hostile = replace(catalogue["scara"], title='<b>"T', source="<script>x</script>")
    client = LanguagesClient({"scara": hostile})
    for language in ("en", "qps"):
        text = client.get(f"/exercises/scara?lang={language}").text
        assert "<b>" not in text.split("<main")[1].split("<div>")[0]
        assert "<script>" not in text
        assert "&lt;script&gt;" in text


# --- The program reads the examples on the help pages as the pages say

# The exercise and the part for which the blocks of the page on pasting are.
PARTS = {
    "table": ("rrrp", "table"),
    "matrix": ("planar-rrr", "pose"),
    "links": ("planar-rrr-standard", "links"),
}


assets = cache(load_assets)


@cache
def shown(topic: str, language: Language = ENGLISH) -> str:
    return help_page(topic, assets(), language).decode()


def examples(kind: str) -> list[list[str]]:
    bodies = re.findall(
        rf'data-examples="{kind}">.*?<tbody>(.*?)</tbody>', shown("expressions"), re.DOTALL
    )
    return [
        [html.unescape(re.sub("<[^>]+>", "", cell)) for cell in re.findall("<td>(.*?)</td>", row)]
        for body in bodies
        for row in re.findall("<tr>(.*?)</tr>", body)
    ]


def test_a_text_is_read_as_the_page_says() -> None:
    rows = examples("read")
    assert len(rows) > 30
    for text, meaning in rows:
        expression = read(text, ROBOT)
        assert expression.text() == meaning
        assert {note.code for note in expression.notes} <= {"joint_marker"}, text


def test_a_text_is_read_with_a_note() -> None:
    rows = examples("noted")
    assert len(rows) > 5
    for text, meaning, _ in rows:
        expression = read(text, ROBOT)
        assert expression.text() == meaning
        assert expression.notes


def test_a_text_is_refused_with_the_shown_repair() -> None:
    rows = examples("refused")
    assert len(rows) > 10
    for text, _, repaired in rows:
        with pytest.raises(ExpressionError) as caught:
            read(text, ROBOT)
        assert (caught.value.suggestion or "") == repaired, text


def test_a_pasted_example_gets_full_marks(catalogue: Mapping[str, Exercise]) -> None:
    blocks = re.findall(r'<pre data-reads="(\w+)"><code>(.*?)</code>', shown("pasting"), re.DOTALL)
    assert len(blocks) == shown("pasting").count("<pre") > 5
    for kind, text in blocks:
        exercise, part_id = PARTS[kind]
        report = part(handed_in(catalogue[exercise], {part_id: html.unescape(text)}), part_id)
        assert full_marks(report), text


def test_the_worked_points_are_those_of_the_grader(catalogue: Mapping[str, Exercise]) -> None:
    page = re.sub("<[^>]+>", " ", shown("points"))
    rows = [
        {"a": "a1", "alpha": 0, "d": 0, "theta": "theta1"},
        {"a": "a2", "alpha": 0, "d": 0, "theta": "theta2"},
        {"a": 0, "alpha": 0, "d": "d3", "theta": 0},
        {"a": 0, "alpha": 0, "d": "a1", "theta": "theta4"},
    ]
    report = part(handed_in(catalogue["scara"], {"table": {"rows": rows}}), "table")
    assert f"8 − 2 · 1.75 = {report.points:g} points" in page
    most = [row.max_points for row in report.rows]
    assert most == [2, 3.75, 0.25, 2]
    for points in most:
        assert f"{points:g} " in page


@pytest.mark.parametrize("code", list(LANGUAGES))
@pytest.mark.parametrize("topic", TOPICS)
def test_a_page_in_each_language_has_the_same_examples(topic: str, code: str) -> None:
    page = shown(topic, LANGUAGES[code])
    blocks = r"<code>.*?</code>|<pre.*?</pre>"
    english, other = (
        sorted(set(re.findall(blocks, text, re.DOTALL))) for text in (shown(topic), page)
    )
    assert other == english
    assert page.count("<h2>") == shown(topic).count("<h2>")


def test_pages_lead_to_the_help(catalogue: Mapping[str, Exercise]) -> None:
    app = application(catalogue, pages=web_routes(catalogue))

    async def get(path: str) -> httpx.Response:
        transport = httpx.ASGITransport(app)
        async with httpx.AsyncClient(transport=transport, base_url="http://service") as client:
            return await client.get(path)

    first = asyncio.run(get("/help?lang=de"))
    assert first.headers["location"] == "help/expressions"
    assert f"{LANGUAGE_COOKIE}=de;" in first.headers["set-cookie"]
    assert 'href="../help/expressions">Help' in asyncio.run(get("/help/points")).text
    for topic, title in TOPICS.items():
        answer = asyncio.run(get(f"/help/{topic}"))
        assert f"<h1>{title}</h1>" in answer.text
