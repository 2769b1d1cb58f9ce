"""Archives among the files of a class are read within limits, and never written to the disk."""

import base64
import gzip
import io
import json
import tracemalloc
import zipfile
from collections.abc import Iterable, Mapping
from itertools import pairwise
from pathlib import Path

import pytest
from dh_grader.catalogue import Exercise
from dh_grader.cli.grade import grade_commands as commands
from dh_grader.submissions.bodies import MAX_BODY_SIZE
from dh_grader.web.tutor_checks import MAX_UPLOAD
from typer.testing import CliRunner

from tests.web.tutor.test_tutor_routes import RIGHT, Tutor

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


ZEROS = zipped([("table.csv", bytes(10 * MEGABYTE))])
SHEET = zipped([("[Content_Types].xml", b"<x/>"), ("xl/worksheets/sheet1.xml", bytes(MEGABYTE))])
ENTITIES = "".join(f'<!ENTITY {b} "{f"&{a};" * 10}">' for a, b in pairwise("abcdefghij"))
FILES = {
    "zeros.zip": ZEROS,
    "nested.zip": nested(zipped([("0", bytes(MEGABYTE))]), 3),
    "many.zip": zipped((f"{i}.csv", b"") for i in range(1_500)),
    "table.xlsx": SHEET,
    "table.ods": SHEET,
    "table.csv.gz": gzip.compress(bytes(10 * MEGABYTE)),
    "folder.tar": bytes(20_480),
    # With the name of a readable kind.
    "a zip.csv": ZEROS,
    "a zip.txt": ZEROS,
    "a zip.json": ZEROS,
    "a zip.toml": ZEROS,
    "zeros.txt": bytes(10 * MEGABYTE),
}
# A web page is read, but its entities are not expanded to a table.
LAUGHS = f'<!DOCTYPE t [<!ENTITY a "lol">{ENTITIES}]><table><tr><td>&j;</td></tr></table>'.encode()


def test_a_hostile_archive_in_a_folder_affects_only_itself(tmp_path: Path) -> None:
    folder = tmp_path / "class"
    folder.mkdir()
    for name, content in {**FILES, "laughs.html": LAUGHS, "right.csv": RIGHT.encode()}.items():
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
    for name in FILES:
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
        for name, content in FILES.items()
    ]
    answer = tutor.grade([*files, {"path": "right.csv", "text": RIGHT}], part="table")
    assert answer.status_code == 200
    with zipfile.ZipFile(io.BytesIO(answer.content)) as archive:
        index = archive.read("index.html").decode()
        assert len(archive.namelist()) == len(FILES) + 3
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
