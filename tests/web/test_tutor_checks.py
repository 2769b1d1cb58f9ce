"""Test drafts and archives that tutors hand over."""

import base64
import gzip
import io
import json
import os
import re
import signal
import subprocess
import sys
import threading
import time
import tracemalloc
import xml.etree.ElementTree as ET
import zipfile
from collections import Counter
from collections.abc import Iterable, Iterator, Mapping
from functools import cache
from html.parser import HTMLParser
from http import HTTPStatus
from itertools import pairwise
from pathlib import Path

import pytest
from dh_grader.api.http import ProblemError
from dh_grader.catalogue import Exercise, load_catalogue, shipped_folder
from dh_grader.cli.grade import grade_commands as commands
from dh_grader.submissions.bodies import MAX_BODY_SIZE
from dh_grader.web.tutor_checks import MAX_UPLOAD, Checking, CheckRequest
from typer.testing import CliRunner

from tests.browser.hostile import BREAKOUT, HOSTILE_EXERCISE, PICTURE
from tests.web.test_tutor import RIGHT, Tutor

# --- The editor checks exercises in a separate process with a time limit

SCARA = (shipped_folder() / "scara.toml").read_text(encoding="utf-8")
POSE = '\n[[parts]]\nid = "p{}"\nkind = "transform"\ntitle = "Pose"\n'
# Minutes of algebra in 20 kB.
COSTLY = (shipped_folder() / "baxter-left-arm.toml").read_text(encoding="utf-8") + "".join(
    POSE.format(i) for i in range(200)
)
QUICK = CheckRequest(id="scara", text="title = 1")
STARTS_A_CHECK = """
import sys
from dh_grader.web.tutor_checks import Checking
from dh_grader.web.tutor_checks import CheckRequest
checking = Checking(600)
checking.checked(CheckRequest(id="a", text="title = 1"))
print(checking._process.pid, flush=True)
checking.checked(CheckRequest(id="arm", text=sys.stdin.read()))
"""


@pytest.fixture
def checking() -> Iterator[Checking]:
    checking = Checking(600.0)
    yield checking
    checking.close()


def costly() -> CheckRequest:
    return CheckRequest(id="arm", text=COSTLY)


def process_of(checking: Checking) -> "subprocess.Popen[bytes]":
    assert checking._process is not None
    return checking._process


@pytest.mark.long
def test_one_process_checks_one_text_after_the_other(checking: Checking) -> None:
    assert b'"findings":[]' in checking.checked(CheckRequest(id="scara", text=SCARA))
    first = process_of(checking)
    assert b"unusable" in checking.checked(QUICK)
    assert process_of(checking) is first


@pytest.mark.long
def test_checks_that_take_too_long_are_killed(checking: Checking) -> None:
    checking.checked(QUICK)
    first = process_of(checking)
    checking._seconds = 0.5
    with pytest.raises(ProblemError, match=r"more than 0\.5 seconds") as caught:
        checking.checked(costly())
    assert caught.value.status is HTTPStatus.UNPROCESSABLE_ENTITY
    assert first.poll() == -signal.SIGKILL
    checking._seconds = 600.0
    assert b"unusable" in checking.checked(QUICK)


@pytest.mark.long
@pytest.mark.skipif(sys.platform == "win32", reason="there are no such signals")
def test_a_killed_process_is_restarted(checking: Checking) -> None:
    checking.checked(QUICK)
    first = process_of(checking)
    os.kill(first.pid, signal.SIGKILL)
    first.wait()
    assert b"unusable" in checking.checked(QUICK)


def test_a_crashed_check_does_not_affect_the_next_one(checking: Checking) -> None:
    checking.checked(QUICK)
    first = process_of(checking)
    with pytest.raises(RuntimeError, match="the log"):
        # Too long: the process refuses to read the request.
        checking.checked(CheckRequest.model_construct(id="a", text="x" * 70_000))
    assert b"unusable" in checking.checked(QUICK)
    assert process_of(checking) is first


@pytest.mark.long
def test_the_end_of_the_service_ends_a_check(checking: Checking) -> None:
    told: list[ProblemError] = []
    checking.checked(QUICK)

    def check() -> None:
        with pytest.raises(ProblemError) as caught:
            checking.checked(costly())
        told.append(caught.value)

    thread = threading.Thread(target=check)
    thread.start()
    time.sleep(0.2)
    checking.close()
    thread.join()
    assert [each.status for each in told] == [HTTPStatus.SERVICE_UNAVAILABLE]
    with pytest.raises(ProblemError):
        checking.checked(QUICK)


@pytest.mark.long
@pytest.mark.skipif(not Path("/proc/self").exists(), reason="there is no /proc")
def test_the_process_ends_after_the_service_was_killed() -> None:
    with subprocess.Popen(
        [sys.executable, "-c", STARTS_A_CHECK], stdin=subprocess.PIPE, stdout=subprocess.PIPE
    ) as service:
        assert service.stdin is not None
        assert service.stdout is not None
        process = Path(f"/proc/{int(service.stdout.readline())}")
        service.stdin.write(COSTLY.encode())
        service.stdin.close()
        time.sleep(0.5)
        assert process.exists()
        service.kill()
    # An ended process stays as a zombie (Z) until its new parent reads the exit code.
    while process.exists() and ") Z " not in (process / "stat").read_text():
        time.sleep(0.05)


# --- Archives among the files of a class are read within limits, and never written to the disk

MEGABYTE = 1_000_000


def zipped(files: Iterable[tuple[str, bytes]]) -> bytes:
    packed = io.BytesIO()
    with zipfile.ZipFile(packed, "w", zipfile.ZIP_DEFLATED) as archive:
        for name, content in files:
            archive.writestr(name, content)
    return packed.getvalue()


def nested(content: bytes, levels: int) -> bytes:
    for _ in range(levels):
        content = zipped((f"{i}.zip", content) for i in range(10))
    return content


ENTITIES = "".join(f'<!ENTITY {b} "{f"&{a};" * 10}">' for a, b in pairwise("abcdefghij"))


@cache
def hostile_files() -> Mapping[str, bytes]:
    zeros = zipped([("table.csv", bytes(10 * MEGABYTE))])
    sheet = zipped(
        [("[Content_Types].xml", b"<x/>"), ("xl/worksheets/sheet1.xml", bytes(MEGABYTE))]
    )
    return {
        "zeros.zip": zeros,
        "nested.zip": nested(zipped([("0", bytes(MEGABYTE))]), 3),
        "many.zip": zipped((f"{i}.csv", b"") for i in range(1_500)),
        "table.xlsx": sheet,
        "table.ods": sheet,
        "table.csv.gz": gzip.compress(bytes(10 * MEGABYTE)),
        "folder.tar": bytes(20_480),
        # With the name of a readable kind.
        "a zip.csv": zeros,
        "a zip.txt": zeros,
        "a zip.json": zeros,
        "a zip.toml": zeros,
        "zeros.txt": bytes(10 * MEGABYTE),
    }


# A web page is read, but its entities are not expanded to a table.
LAUGHS = f'<!DOCTYPE t [<!ENTITY a "lol">{ENTITIES}]><table><tr><td>&j;</td></tr></table>'.encode()


def test_a_hostile_archive_in_a_folder_affects_only_itself(tmp_path: Path) -> None:
    folder = tmp_path / "class"
    folder.mkdir()
    for name, content in {
        **hostile_files(),
        "laughs.html": LAUGHS,
        "right.csv": RIGHT.encode(),
    }.items():
        (folder / name).write_bytes(content)
    asked = ["--exercise", "planar-rr", "--part", "table", "--format", "json", str(folder)]
    tracemalloc.start()
    try:
        done = CliRunner().invoke(commands, asked)
        _, peak = tracemalloc.get_traced_memory()
    finally:
        tracemalloc.stop()
    assert done.exit_code == 2
    assert peak < 40 * MEGABYTE
    found = {Path(each["file"]).name: each for each in json.loads(done.stdout)}
    assert found["right.csv"]["report"]["score"] == 1.0
    assert found["laughs.html"]["report"]["score"] == 0.0
    for name in hostile_files():
        problem = found[name]["error"]
        assert any(
            reason in problem
            for reason in ("is a file of a kind that is not read", "is not text", "is damaged",
                           "this program cannot read",
                           "is larger than 256 KiB", "is not usable", "holds more than",
                           "holds no file whose name says")
        ), problem  # fmt: skip
        assert len(problem) < 400


def test_a_folder_with_too_many_files_is_not_read(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr("dh_grader.submissions.files.MAX_SUBMISSIONS_IN_FOLDER", 50)
    for i in range(51):
        (tmp_path / f"{i}.zip").write_bytes(b"")
    done = CliRunner().invoke(commands, ["--exercise", "planar-rr", str(tmp_path)])
    assert (done.exit_code, "holds more than 50 files" in done.stderr) == (2, True)


@pytest.fixture(scope="module")
def tutor(catalogue: Mapping[str, Exercise]) -> Tutor:
    return Tutor(catalogue)


def test_an_uploaded_hostile_archive_affects_only_itself(tutor: Tutor) -> None:
    files = [
        # The page sends a file that is too large without its content.
        {"path": name, "base64": base64.b64encode(content).decode()}
        if len(content) <= MAX_BODY_SIZE
        else {"path": name}
        for name, content in hostile_files().items()
    ]
    answer = tutor.grade([*files, {"path": "right.csv", "text": RIGHT}], part="table")
    assert answer.status_code == 200
    with zipfile.ZipFile(io.BytesIO(answer.content)) as archive:
        index = archive.read("index.html").decode()
        assert len(archive.namelist()) == len(hostile_files()) + 3
    assert "zeros.zip holds more than a hand-in needs" in index
    assert "is larger than 256 KiB" in index


UPLOAD = b'{"exercise": "planar-rr", "files": ['


def filled(unit: bytes) -> bytes:
    return UPLOAD + unit * ((MAX_UPLOAD - 1_000) // len(unit))


@pytest.mark.parametrize(
    ("content", "told"),
    [
        (bytes(10 * MAX_UPLOAD), "are more than 8 MiB"),
        (filled(b"{},"), "holds more than the files"),
        (filled(b'{"path":"a.csv"},'), "holds more than the files"),
        (filled(b'"",'), "holds more than the files"),
        (filled(b"["), "holds more than the files"),
        (filled(b"1,").replace(b"files", b"x"), "holds more than the files"),
        (filled(b'"\\\\",'), "holds more than the files"),
        (filled(b'\\"'), "This is not JSON"),
        (UPLOAD + b'"' + bytes(MAX_UPLOAD // 2), "This is not JSON"),
    ],
    ids=["zeros", "objects", "files", "texts", "lists", "numbers", "backslashes", "quotes", "open"],
)
def test_a_compression_bomb_is_refused_before_it_is_parsed(
    tutor: Tutor, content: bytes, told: str
) -> None:
    packed = gzip.compress(content)
    assert len(packed) < MAX_BODY_SIZE
    answer = tutor.ask("POST", "/tutor/class", content=packed)
    assert answer.status_code == 422
    assert told in answer.json()["detail"]


def test_a_class_at_the_limits_is_accepted(tutor: Tutor) -> None:
    # Quotation marks and backslashes inside students' texts do not count.
    text = '"\\", {}, [' * 60 + "\n"
    files = [{"path": f"{i // 20}/{i}.md", "text": text} for i in range(2_000)]
    assert tutor.grade(files, part="table").status_code == 200


# --- Pages show the texts of a hostile exercise as plain text

PLAIN = re.sub(r"'''.*?'''", "'''plain'''", HOSTILE_EXERCISE, flags=re.DOTALL)
# The pages that show the title, and pages that should not show it.
SHOWN = ("/", "/exercises/hostile", "/tutor", "/tutor/solutions/hostile", "/tutor/class")
OTHERS = ("/tutor/editor?exercise=hostile", "/tutor/class/report", "/play")
FIGURES = ("/v1/exercises/hostile/figure.svg", "/tutor/solutions/hostile/frames.svg")
# Elements that statements (Markdown and MathML) may add, and elements that contain titles.
TEXT = {
    "p", "code", "span", "div", "math", "mrow", "mi", "mn", "mo", "mtext", "em", "strong", "br",
}  # fmt: skip
# Attributes whose text the browser neither loads nor runs.
WORDS = {"alt", "title", "aria-label", "content", "placeholder", "value", "data-mark"}


class Markup(HTMLParser):
    """The elements and the text of a page."""

    def __init__(self, page: str) -> None:
        super().__init__(convert_charrefs=True)
        self.elements: Counter[tuple[str, tuple[tuple[str, str | None], ...]]] = Counter()
        self.text = ""
        self.feed(page)
        self.close()

    def handle_starttag(self, tag: str, attrs: list[tuple[str, str | None]]) -> None:
        for name, value in attrs:
            assert not name.startswith("on")
            assert name in WORDS or not re.search(
                r"(?:javascript|data):", value or "", re.IGNORECASE
            )
        if tag not in TEXT:
            kept = ((name, value) for name, value in attrs if name not in WORDS)
            self.elements[tag, tuple(kept)] += 1

    def handle_data(self, data: str) -> None:
        self.text += data

    def handle_comment(self, data: str) -> None:
        pytest.fail(f"a comment: {data}")


def tutor_of(text: str, folder: Path) -> Tutor:
    folder.mkdir()
    (folder / "hostile.toml").write_text(text, encoding="utf-8")
    return Tutor(load_catalogue(folder), folder)


@pytest.fixture(scope="module")
def both(tmp_path_factory: pytest.TempPathFactory) -> tuple[Tutor, Tutor]:
    # A service with the hostile exercise, and one with the same exercise in harmless words.
    folder = tmp_path_factory.mktemp("exercises")
    assert "stolen" not in PLAIN
    return tutor_of(HOSTILE_EXERCISE, folder / "hostile"), tutor_of(PLAIN, folder / "plain")


def bare(markup: Markup) -> Counter[str]:
    return Counter({f"{tag} {attributes}": n for (tag, attributes), n in markup.elements.items()})


@pytest.mark.parametrize("path", [*SHOWN, *OTHERS])
def test_a_page_has_the_same_elements_as_for_a_plain_exercise(
    both: tuple[Tutor, Tutor], path: str
) -> None:
    answers = [each.ask("GET", path) for each in both]
    assert [each.status_code for each in answers] == [200, 200]
    hostile, plain = (Markup(each.text) for each in answers)
    assert bare(hostile) == bare(plain)
    assert "script-src" in answers[0].headers["content-security-policy"]
    if path in SHOWN:
        assert f"Hostile {PICTURE} {BREAKOUT}" in hostile.text


@pytest.mark.long
def test_the_api_reference_does_not_contain_the_exercise(both: tuple[Tutor, Tutor]) -> None:
    for path in ("/docs", "/openapi.json"):
        hostile, plain = (each.ask("GET", path).content for each in both)
        assert hostile == plain


@pytest.mark.parametrize("path", FIGURES)
def test_a_figure_has_the_same_elements_as_a_plain_one(
    both: tuple[Tutor, Tutor], path: str
) -> None:
    hostile, plain = (ET.fromstring(each.ask("GET", path).content) for each in both)
    assert Counter(each.tag for each in hostile.iter()) == Counter(
        each.tag for each in plain.iter()
    )
    assert {name for each in hostile.iter() for name in each.attrib} == {
        name for each in plain.iter() for name in each.attrib
    }
    assert PICTURE in "".join(hostile.itertext())


def texts(value: object) -> Iterator[str]:
    if isinstance(value, str):
        yield value
    elif isinstance(value, dict):
        yield from (text for each in value.values() for text in texts(each))
    elif isinstance(value, list):
        yield from (text for each in value for text in texts(each))


@pytest.mark.long
def test_the_html_in_json_has_no_hostile_elements(both: tuple[Tutor, Tutor]) -> None:
    check = {"id": "h", "text": HOSTILE_EXERCISE}
    for answer in (
        both[0].ask("GET", "/v1/exercises/hostile"),
        both[0].ask("GET", "/v1/exercises/hostile/solution"),
        both[0].ask("POST", "/tutor/check", json=check),
    ):
        assert answer.headers["content-type"] == "application/json"
        assert answer.headers["x-content-type-options"] == "nosniff"
        html = [text for text in texts(answer.json()) if text.startswith(("<p>", "<math", "<div"))]
        for text in html:
            assert Markup(text).elements == Counter()
    shown = json.dumps(both[0].ask("GET", "/v1/exercises/hostile").json())
    assert "<p>Read &lt;script&gt;" in shown
