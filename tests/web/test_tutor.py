"""Test the pages for tutors."""

import asyncio
import csv
import gzip
import io
import json
import re
import zipfile
from collections.abc import Mapping
from pathlib import Path
from typing import Any

import httpx
import openpyxl
import pytest
from dh_grader.api.application import application
from dh_grader.api.http import WAITING
from dh_grader.api.permissions import Access
from dh_grader.catalogue import Exercise, shipped_folder
from dh_grader.catalogue.load import Drafts
from dh_grader.cli.exercises import exercises_commands as import_request_commands
from dh_grader.cli.grade import grade_commands as commands
from dh_grader.web import Tutoring, web_routes
from dh_grader.web.tutor_checks import MAX_UPLOAD
from typer.testing import CliRunner

from tests.importing.test_pasted_robot import PASTED
from tests.importing.test_urdf import REFUSED, file_of

# --- Test the tutor's pages: access, limits and results

SCARA = (shipped_folder() / "scara.toml").read_text(encoding="utf-8")
ROUTES = [
    ("GET", "/tutor"),
    ("GET", "/tutor/solutions/{exercise_id}"),
    ("GET", "/tutor/solutions/{exercise_id}/frames.svg"),
    ("GET", "/tutor/misconceptions/{exercise_id}"),
    ("GET", "/tutor/editor?exercise=scara"),
    ("POST", "/tutor/check"),
    ("POST", "/tutor/import"),
    ("POST", "/tutor/drafts"),
    ("POST", "/tutor/files"),
    ("GET", "/tutor/class"),
    ("GET", "/tutor/class/report"),
    ("POST", "/tutor/class"),
    ("GET", "/tutor/attempts"),
    ("GET", "/tutor/attempts/0123"),
    ("GET", "/tutor/statistics/{exercise_id}"),
]
RIGHT = "a\talpha\td\ttheta\na1\t0\t0\ttheta1\na2\t0\t0\ttheta2\n"


class Tutor:
    """Sends requests to an application in this process."""

    def __init__(
        self,
        catalogue: Mapping[str, Exercise],
        editor_dir: Path | None = None,
        drafts: Drafts | None = None,
    ) -> None:
        access = Access(solutions=None)
        tutoring = Tutoring(access, (shipped_folder(),), editor_dir, drafts=drafts or Drafts())
        self.app = application(catalogue, access=access, pages=web_routes(catalogue, tutoring))

    def ask(
        self, method: str, path: str, host: str = "127.0.0.1:8000", **more: Any
    ) -> httpx.Response:
        return asyncio.run(self.asked(method, path, host, **more))

    async def asked(
        self,
        method: str,
        path: str,
        host: str = "127.0.0.1:8000",
        accept: str = "*/*",
        **more: Any,
    ) -> httpx.Response:
        transport = httpx.ASGITransport(self.app)
        address = "http://127.0.0.1:8000"
        async with httpx.AsyncClient(transport=transport, base_url=address) as client:
            return await client.request(
                method, path, headers={"host": host, "accept": accept}, **more
            )

    def check(self, text: str, exercise: str = "scara", **more: Any) -> dict[str, Any]:
        answer = self.ask("POST", "/tutor/check", json={"id": exercise, "text": text}, **more)
        assert answer.status_code == 200
        return dict(answer.json())

    def grade(self, files: list[dict[str, Any]], **more: Any) -> httpx.Response:
        body = gzip.compress(json.dumps({"exercise": "planar-rr", "files": files, **more}).encode())
        return self.ask("POST", "/tutor/class", content=body)


@pytest.fixture
def tutor(catalogue: Mapping[str, Exercise], tmp_path: Path) -> Tutor:
    return Tutor(catalogue, tmp_path)


def test_only_tutors_see_the_tutors_pages(tutor: Tutor) -> None:
    for method, path in ROUTES:
        filled = path.replace("{exercise_id}", "scara")
        answer = tutor.ask(method, filled, "grader.example.edu")
        assert (answer.status_code, filled) == (403, filled)
        assert "theta" not in answer.text
    # The page explains keys, but not the setting that shows solutions to everybody.
    page = tutor.ask("GET", "/tutor", "grader.example.edu", accept="text/html")
    assert (page.status_code, "<main" in page.text) == (403, True)
    assert "keys create" in page.text
    assert "DH_GRADER_SOLUTIONS=true" not in page.text
    assert 'href="tutor"' not in tutor.ask("GET", "/", "grader.example.edu").text
    assert 'href="tutor"' in tutor.ask("GET", "/").text


@pytest.mark.long
def test_every_solution_is_drawn(tutor: Tutor, catalogue: Mapping[str, Exercise]) -> None:
    for name in ("stanford-arm", "dh-conditions", "composite-rotations", "planar-rpr-poe"):
        page = tutor.ask("GET", f"/tutor/solutions/{name}")
        assert page.status_code == 200
        assert page.headers["cache-control"] == "no-store"
        # A formula that could not be converted to MathML would be shown as LaTeX.
        assert "<code>\\" not in page.text.replace('<pre tabindex="0"><code>', "")
        for part in catalogue[name].parts:
            assert part.title in page.text
    figure = tutor.ask("GET", "/tutor/solutions/scara/frames.svg")
    assert "x<tspan" in figure.text or ">x" in figure.text
    assert tutor.ask("GET", "/tutor/solutions/planar-rpr-poe/frames.svg").status_code == 404


@pytest.mark.long
def test_misconceptions_are_listed_with_their_sentences(tutor: Tutor) -> None:
    page = tutor.ask("GET", "/tutor/misconceptions/planar-rr").text
    for code, sentence in (
        ("sign", "The sign of α is wrong"),
        ("degrees_as_radians", "This number was read in radians, but it fits in degrees"),
        ("transposed_matrix", "This matrix is transposed."),
    ):
        assert f"<code>{code}</code>" in page
        assert sentence in page
    # The exercise has no screw axes.
    assert "point_off_axis" not in page


@pytest.mark.long
def test_a_text_is_checked_as_the_command_line_checks_a_file(tutor: Tutor) -> None:
    good = tutor.check(SCARA)
    assert good["findings"] == []
    assert good["preview"]["figure"].startswith("<svg")
    line = 1 + SCARA[: SCARA.index("points = ")].count("\n")
    bad = tutor.check(SCARA.replace("points = ", "pionts = ", 1))
    first = bad["findings"][0]
    assert (first["field"], first["line"]) == ("parts[0].pionts", line)
    assert "did you mean 'points'" in bad["findings"][0]["text"]
    wrong = SCARA.replace('verdict = "partial"', 'verdict = "correct"')
    assert wrong != SCARA
    assert {each["level"] for each in tutor.check(wrong)["findings"]} >= {"failed"}


@pytest.mark.long
def test_the_findings_are_in_the_language_of_the_reader(tutor: Tutor) -> None:
    german = {"lang": "de"}
    assert (
        "Nur Nullen und Gelenkvariablen zu schreiben bringt "
        in (tutor.check(SCARA, params=german)["summary"])
    )
    bad = tutor.check(SCARA.replace("points = ", "pionts = ", 1), params=german)
    assert bad["summary"] == "Die Datei ist nicht verwendbar."
    assert bad["findings"][0]["text"].startswith("hier gibt es keinen Schlüssel 'pionts'; meinten")
    # The process of the checks is the same, and has no language of its own.
    assert tutor.check(SCARA[:10])["summary"] == "The file cannot be used."
    for text in (
        "",
        "=",
        "a = " + "[" * 4_000,
        "title = 1\nstatement = ''",
        "\x00",
        "a" + ".a" * 30_000,
    ):
        assert tutor.check(text)["findings"][0]["level"] == "unusable"
    assert tutor.check(SCARA, "../scara")["findings"][0]["level"] == "unusable"


@pytest.mark.long
def test_only_a_few_checks_may_wait(tutor: Tutor) -> None:
    async def all_at_once() -> list[int]:
        body = {"id": "scara", "text": SCARA}
        asked = (tutor.asked("POST", "/tutor/check", json=body) for _ in range(WAITING + 4))
        return sorted(each.status_code for each in await asyncio.gather(*asked))

    assert asyncio.run(all_at_once()) == [200] * (WAITING + 1) + [503] * 3


def test_a_file_is_saved_only_in_the_editors_folder(
    tutor: Tutor, catalogue: Mapping[str, Exercise], tmp_path: Path
) -> None:
    def save(text: str, before: str = "", exercise: str = "my-scara", by: Tutor = tutor) -> Any:
        body = {"id": exercise, "text": text, "before": before}
        return by.ask("POST", "/tutor/files", json=body)

    file = tmp_path / "my-scara.toml"
    first = save(SCARA)
    assert (first.status_code, file.read_text(encoding="utf-8")) == (200, SCARA)
    mark = first.json()["mark"]
    assert f'data-mark="{mark}"' in tutor.ask("GET", "/tutor/editor?exercise=my-scara").text
    changed = SCARA.replace("SCARA manipulator", "A robot", 1)
    assert save(changed, mark).status_code == 200
    assert file.read_text(encoding="utf-8") == changed
    # The mark is that of an older version, or missing.
    for old in (mark, ""):
        refused = save(SCARA, old)
        assert (refused.status_code, "has changed" in refused.json()["detail"]) == (409, True)
    for name in ("../scara", "/tmp/scara", "scara.toml", "Scara", ".", "a" * 61):
        assert save(SCARA, "", name).status_code == 409
    assert save("title = 1", "", "broken").status_code == 409
    # A symbolic link is refused, and its target stays unchanged.
    outside = tmp_path.parent / f"{tmp_path.name}-outside.toml"
    outside.write_text("outside", encoding="utf-8")
    (tmp_path / "linked.toml").symlink_to(outside)
    assert save(SCARA, "", "linked").status_code == 409
    assert outside.read_text(encoding="utf-8") == "outside"
    assert sorted(each.name for each in tmp_path.iterdir()) == ["linked.toml", "my-scara.toml"]
    assert save(SCARA, by=Tutor(catalogue)).status_code == 409


def test_why_a_file_is_not_saved_is_told_in_the_language_of_the_reader(tutor: Tutor) -> None:
    body = {"id": "scara", "text": SCARA, "before": ""}
    refused = tutor.ask("POST", "/tutor/files", json=body, params={"lang": "de"})
    assert (refused.json()["title"], refused.json()["detail"]) == (
        "Die Datei ist nicht gespeichert",
        "Die id scara ist vergeben. Wählen Sie eine andere.",
    )


@pytest.mark.long
def test_a_shipped_exercise_is_copied_under_a_free_id(tutor: Tutor, tmp_path: Path) -> None:
    def shown() -> str:
        page = tutor.ask("GET", "/tutor/editor?exercise=scara").text
        return str(re.findall(r'id="id" value="([^"]*)"', page)[0])

    assert shown() == "scara-copy"
    body = {"id": "scara", "text": SCARA, "before": ""}
    refused = tutor.ask("POST", "/tutor/files", json=body)
    assert (refused.status_code, refused.json()["detail"]) == (
        409,
        "The id scara is taken. Choose another one.",
    )
    assert list(tmp_path.iterdir()) == []
    assert tutor.ask("POST", "/tutor/files", json={**body, "id": shown()}).status_code == 200
    assert shown() == "scara-copy2"


def test_a_draft_is_shown_and_graded_but_not_listed(tutor: Tutor) -> None:
    def put(text: str, draft: str = "") -> httpx.Response:
        return tutor.ask("POST", "/tutor/drafts", json={"id": "x", "text": text, "draft": draft})

    draft = put(SCARA).json()["draft"]
    changed = SCARA.replace("SCARA manipulator", "A robot", 1)
    assert put(changed, draft).json()["draft"] == draft
    assert put(SCARA).json()["draft"] != draft
    assert put("title = 1").status_code == 422
    host = "grader.example.edu"
    view = tutor.ask("GET", f"/v1/exercises/{draft}", host).json()
    assert (view["id"], view["title"].startswith("A robot")) == (draft, True)
    assert tutor.ask("GET", f"/v1/exercises/{draft}/figure.svg", host).status_code == 200
    frames = tutor.ask("POST", "/v1/frames", host, json={"exercise": draft})
    assert frames.status_code == 200
    answers = {"answers": {"table": "0"}}
    graded = tutor.ask("POST", f"/v1/exercises/{draft}/grade", host, json=answers)
    assert graded.json()["exercise"] == draft
    assert draft not in tutor.ask("GET", "/v1/exercises", host).text
    assert tutor.ask("GET", f"/exercises/{draft}").status_code == 404


def test_without_a_writable_folder_the_preview_says_so(
    catalogue: Mapping[str, Exercise], tmp_path: Path
) -> None:
    drafts = Drafts(tmp_path / "missing" / "drafts")
    answer = Tutor(catalogue, drafts=drafts).ask(
        "POST", "/tutor/drafts", json={"id": "x", "text": SCARA}
    )
    assert answer.status_code == 503
    assert "TMPDIR" in answer.json()["detail"]


def test_a_class_is_graded_as_on_the_command_line(tutor: Tutor, tmp_path: Path) -> None:
    large = " " * 300_000
    class_files: dict[str, str] = {
        "alice.json": json.dumps({"answers": {"table": RIGHT}}),
        "bob/table.csv": RIGHT.replace("a2\t0", "a2\tpi/2").replace("\t", ","),
        "carol.json": json.dumps({"answers": {"table": "<img src=x onerror=stolen(1)>"}}),
        "dave.json": large,
    }
    sent = [
        {"path": path} if text is large else {"path": path, "text": text}
        for path, text in class_files.items()
    ]
    answer = tutor.grade([*sent, {"path": "eve.txt", "base64": "//4A"}])
    assert answer.status_code == 200
    archive = zipfile.ZipFile(io.BytesIO(answer.content))

    folder = tmp_path / "class"
    for path, text in class_files.items():
        (folder / path).parent.mkdir(parents=True, exist_ok=True)
        (folder / path).write_text(text, encoding="utf-8")
    (folder / "eve.txt").write_bytes(b"\xff\xfe\x00")
    output = tmp_path / "report"
    command = [str(folder), "--exercise", "planar-rr", "--format", "html", "--output", str(output)]
    CliRunner().invoke(commands, command)
    written = {
        file.relative_to(output).as_posix(): file.read_text(encoding="utf-8")
        for file in output.rglob("*.html")
    }
    assert len(written) == 6
    book = tmp_path / "grades.csv"
    command = [str(folder), "--exercise", "planar-rr", "--format", "gradebook"]
    CliRunner().invoke(commands, [*command, "--output", str(book)])
    written["grades.csv"] = book.read_bytes().decode()
    # Only the command knows where a file is that a person must grade.
    written = {
        name: re.sub(r' <a href="[^"]+">Open the file</a>', "", text.replace(f"{folder}/", ""))
        for name, text in written.items()
    }
    assert {name: archive.read(name).decode() for name in archive.namelist()} == written


def test_the_texts_of_an_office_file_are_the_file(tutor: Tutor) -> None:
    book = openpyxl.Workbook()
    for row in RIGHT.splitlines():
        book.active.append(row.split("\t"))
    packed = io.BytesIO()
    book.save(packed)
    archive = zipfile.ZipFile(packed)
    members = {
        name: "" if "theme" in name else archive.read(name).decode() for name in archive.namelist()
    }
    macros = members | {"xl/vbaProject.bin": ""}
    answer = tutor.grade(
        [
            {"path": "Ada_1_assignsubmission_file/hw.xlsx", "members": members},
            {"path": "Bob_2_assignsubmission_file/hw.xlsx", "members": macros},
            {"path": "Eve_3_assignsubmission_file/hw.xlsx", "members": {"a": ""}},
            {"path": "Mia_4_assignsubmission_file/hw.tsv", "text": RIGHT},
        ],
        part="table",
    )
    grades = zipfile.ZipFile(io.BytesIO(answer.content)).read("grades.csv").decode()
    found = {line["Identifier"]: line["Grade"] for line in csv.DictReader(io.StringIO(grades))}
    text = found.pop("Participant 4")
    assert float(text) > 0
    assert found == {"Participant 1": text, "Participant 2": "", "Participant 3": ""}


SHEET = (
    "Identifier,Full name,Status,Grade,Maximum grade,Grade can be changed,"
    "Last modified (submission),Last modified (grade),Feedback comments\r\n"
    "Participant 1,Ada Byron,Submitted,,8.00,Yes,-,-,\r\n"
    "Participant 2,Ben Okri,Submitted,5.00,8.00,Yes,-,-,fine\r\n"
    "Participant 3,Cy Young,Submitted,,8.00,Yes,-,-,\r\n"
)


def test_the_worksheet_of_the_platform_is_filled_as_on_the_command_line(
    tutor: Tutor, tmp_path: Path
) -> None:
    students = {1: "Ada Byron", 2: "Ben Okri", 3: "Cy Young", 4: "Di Lee"}
    class_files = {
        f"{name}_{i}_assignsubmission_file/hw.tsv": RIGHT if i != 3 else ""
        for i, name in students.items()
    }
    answer = tutor.grade(
        [{"path": path, "text": text} for path, text in class_files.items()],
        part="table",
        worksheet={"path": "Grades.csv", "text": SHEET},
        column="",
    )
    archive = zipfile.ZipFile(io.BytesIO(answer.content))
    for path, text in class_files.items():
        (tmp_path / "in" / path).parent.mkdir(parents=True)
        (tmp_path / "in" / path).write_text(text, encoding="utf-8")
    (tmp_path / "Grades.csv").write_bytes(SHEET.encode())
    result = CliRunner().invoke(
        commands,
        [str(tmp_path / "in"), "--exercise", "planar-rr", "--part", "table", "--worksheet",
         str(tmp_path / "Grades.csv")],
    )  # fmt: skip
    filled = archive.read("worksheet-graded.csv")
    assert filled == (tmp_path / "Grades-graded.csv").read_bytes()
    assert b"Participant 1,Ada Byron,Submitted,8,8.00" in filled
    assert b"Participant 2,Ben Okri,Submitted,5.00,8.00,Yes,-,-,fine" in filled
    counts, *told = archive.read("worksheet.txt").decode().splitlines()
    assert counts == "Grades filled in: 1. Already the same: 0. Left for grading by hand: 2."
    lines = result.stderr.splitlines()
    about = [line for line in lines if " of the worksheet" in line or line.startswith("Cy Young")]
    assert [line.replace(f"{tmp_path}/in/", "") for line in about] == told
    assert len(told) == 4
    assert "Di Lee (Participant 4)" in archive.read("index.html").decode()


def test_an_unusable_worksheet_is_refused(tutor: Tutor) -> None:
    files = [{"path": "Ada Byron_1_assignsubmission_file/hw.tsv", "text": RIGHT}]
    for content, reason in (
        ({"text": "a,b\n1,2\n"}, "Grades.csv is no worksheet"),
        ({"text": SHEET.partition("\n")[0] + "\n"}, "Grades.csv has only a heading"),
        ({"text": "a," * 100_001}, "Grades.csv is too large for this page."),
        ({"text": "a" * 1_100_000}, "Grades.csv is too large for this page."),
        ({"base64": "UEsDBAAA"}, "Grades.csv is no text"),
    ):
        answer = tutor.grade(files, part="table", worksheet={"path": "x/Grades.csv", **content})
        assert answer.status_code == 422
        assert answer.json()["detail"].startswith(reason)


def test_paths_out_of_the_class_are_listed_and_nothing_is_written(tutor: Tutor) -> None:
    paths = ["../../Ben Okri_2_assignsubmission_file/t.tsv", "/etc/x.tsv", "a/../Ada_1_x/y.tsv"]
    answer = tutor.grade(
        [
            {"path": "Ada Byron_1_assignsubmission_file/hw.tsv", "text": RIGHT},
            {"path": "Ben Okri_2_assignsubmission_file/hw.tsv", "text": RIGHT},
            *({"path": path, "text": RIGHT} for path in paths),
        ],
        part="table",
    )
    assert answer.status_code == 200
    archive = zipfile.ZipFile(io.BytesIO(answer.content))
    grades = list(csv.DictReader(io.StringIO(archive.read("grades.csv").decode())))
    found = {line["Identifier"]: line["Grade"] for line in grades}
    assert found == {"Participant 1": "4", "Participant 2": "", "etc": "", "a": ""}
    overview = archive.read("index.html").decode()
    for path in paths:
        assert f"leads out of it ({path})" in overview


def test_outputs_and_worksheets_among_the_files_are_left_out(tutor: Tutor) -> None:
    answer = tutor.grade(
        [
            {"path": "HW3/Ada Byron_1_assignsubmission_file/hw.tsv", "text": RIGHT},
            {"path": "HW3/Ben Okri_2_assignsubmission_file/hw.tsv", "text": RIGHT},
            {"path": "Grades.csv", "text": SHEET},
        ],
        part="table",
    )
    archive = zipfile.ZipFile(io.BytesIO(answer.content))
    assert len([name for name in archive.namelist() if name.startswith("reports/")]) == 2
    assert "earlier outputs or worksheets: Grades.csv" in archive.read("index.html").decode()


def test_an_unusable_upload_is_refused(tutor: Tutor) -> None:
    refused = [
        tutor.ask("POST", "/tutor/class", content=b"no gzip"),
        tutor.ask("POST", "/tutor/class", content=gzip.compress(b" " * (MAX_UPLOAD + 1))),
        tutor.ask("POST", "/tutor/class", content=gzip.compress(b"[" * 100_000)),
        tutor.grade([]),
        tutor.grade([{"path": "a.json", "text": ""}], exercise="skara"),
        tutor.grade([{"path": "a.json", "text": ""}], part="tabel"),
        *(
            tutor.grade([{"path": path, "text": ""}])
            for path in ("a//b", "a/./b", "a\0", "ä" * 200, ".hidden")
        ),
        tutor.grade([{"path": "a", "text": ""}, {"path": "a/b", "text": ""}]),
        tutor.grade([{"path": f"{i}.json", "text": ""} for i in range(501)]),
        tutor.grade([{"path": "a.xlsx", "members": {f"{i}.xml": "" for i in range(101)}}]),
        tutor.grade([{"path": "a.xlsx", "members": {"a" * 201: ""}}]),
    ]
    assert {each.status_code for each in refused} == {422}
    assert {each.headers["content-type"] for each in refused} == {"application/problem+json"}


# --- The editor imports a URDF file as the command line does


@pytest.fixture
def importing_tutor(catalogue: Mapping[str, Exercise]) -> Tutor:
    return Tutor(catalogue)


@pytest.mark.long
def test_a_robot_is_imported_as_by_the_command(importing_tutor: Tutor, tmp_path: Path) -> None:
    arm = file_of("panda")
    table = tmp_path / "pasted.txt"
    table.write_text(PASTED, encoding="utf-8")
    for file, kind, option in ((arm, "urdf", "--letters"), (table, "table", "--table")):
        source = f"Imported from a {'DH table' if kind == 'table' else 'URDF file'}"
        folder = tmp_path / kind
        named = ["--id", "arm", "--source", source, "--output", str(folder)]
        made = CliRunner().invoke(import_request_commands, ["import", str(file), option, *named])
        assert made.exit_code == 0, made.output
        body = {
            "kind": kind,
            "text": file.read_text(encoding="utf-8"),
            "id": "arm",
            "letters": file is arm,
        }
        answer = importing_tutor.ask("POST", "/tutor/import", json=body)
        assert answer.json()["text"] == (folder / "arm.toml").read_text("utf-8")
        [finding] = importing_tutor.check(answer.json()["text"], "arm")["findings"]
        assert finding["text"].startswith("1 right, 1 equivalent, 0 wrong")


@pytest.mark.long
@pytest.mark.parametrize("name", ["doctype", "loop", "nan", "xacro", "eleven joints", "deep"])
def test_a_hostile_file_is_refused_with_the_reason(importing_tutor: Tutor, name: str) -> None:
    text, reason = REFUSED[name]
    body = {"kind": "urdf", "text": text.decode()[:200_000], "id": "arm", "tip": "l1"}
    if name == "loop":
        body["tip"] = "l2"
    elif name == "eleven joints":
        body["tip"] = "l11"
    answer = importing_tutor.ask("POST", "/tutor/import", json=body)
    assert answer.status_code == 422
    assert reason in answer.json()["detail"]


def test_other_refusals_have_their_reasons(importing_tutor: Tutor) -> None:
    table = {"kind": "table", "text": "good morning", "id": "arm"}
    assert importing_tutor.ask("POST", "/tutor/import", json=table).status_code == 422
    named = importing_tutor.ask(
        "POST", "/tutor/import", json={**table, "text": PASTED, "id": "../arm"}
    )
    assert "cannot be the id of an exercise" in named.json()["detail"]
    unknown = importing_tutor.ask(
        "POST", "/tutor/import", json={**table, "text": PASTED, "kind": "sdf"}
    )
    assert unknown.status_code == 422


def test_refusals_are_told_in_the_language_of_the_reader(importing_tutor: Tutor) -> None:
    for kind, text, said in (
        ("table", "a,alpha,d,theta\n1,0,0,0\n1,0,0,0\n", "Zeile 1 hat keine Gelenkvariable"),
        ("urdf", "<sdf/>", "Die Datei beginnt mit <sdf>, nicht mit <robot>."),
    ):
        body = {"kind": kind, "text": text, "id": "arm", "tip": "l1"}
        refused = importing_tutor.ask("POST", "/tutor/import", json=body, params={"lang": "de"})
        assert refused.json()["detail"].startswith(said)


def test_what_a_table_leaves_open_is_asked_in_the_language_of_the_reader(
    importing_tutor: Tutor,
) -> None:
    body = {"kind": "table", "text": "a,alpha,d,theta\n131.2,90,0,q1\n", "id": "arm"}
    asked = importing_tutor.ask("POST", "/tutor/import", json=body, params={"lang": "de"}).json()
    unit, angles = asked["questions"]
    assert (asked["text"], unit["name"], angles["name"]) == ("", "unit", "angles")
    assert unit["text"].startswith("Die Tabelle nennt keine Längeneinheit.")
    assert (unit["choices"][2], angles["choices"]) == ("mm", ["degrees", "radians"])
    answered = {**body, "unit": "mm", "angles": "degrees", "order": "", "convention": None}
    made = importing_tutor.ask("POST", "/tutor/import", json=answered).json()
    assert made["questions"] == []
    assert '["0.1312", "90deg", "0", "theta1"]' in made["text"]
