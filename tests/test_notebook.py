"""``dh_grader.grade`` grades as the service does, and shows a page in a notebook."""

import doctest
import html
import json
import re
import shutil
import subprocess
import sys
from collections.abc import Iterator, Mapping
from html.parser import HTMLParser
from pathlib import Path
from typing import Any

import dh_grader
import httpx
import numpy as np
import pytest
from dh_grader.api.application import application
from dh_grader.catalogue import CatalogueError, Exercise, shipped_folder
from dh_grader.submissions import UnknownPartNameError
from dh_grader.submissions.bodies import UnknownExerciseError

from tests.api.conftest import InProcess

ROOT = Path(__file__).parents[1]
TABLE = "a, alpha, d, theta\na1, 0, 0, q1\na2, pi, 0, q2"
ANSWERS: Mapping[str, Mapping[str, Any]] = {
    "right": {"position": ["a1 c1 + a2 c12", "a1 s1 + a2 s12"]},
    "wrong": {"table": TABLE},
    "unreadable": {"table": [["a1", "(", "0", "q1"], ["a2", 0, 0.5, "90°"]]},
    "two parts": {"table": TABLE, "position": "[a1 c1 + a2 c12, 0]"},
    "nothing": {},
}


def test_the_example_of_the_docstring_prints_what_it_shows() -> None:
    [example] = [each for each in doctest.DocTestFinder().find(dh_grader.grade) if each.examples]
    assert len(example.examples) >= 5
    assert doctest.DocTestRunner().run(example).failed == 0


@pytest.fixture(scope="module")
def service(catalogue: Mapping[str, Exercise]) -> Iterator[httpx.Client]:
    transport = InProcess(application(catalogue))
    with httpx.Client(transport=transport, base_url="http://service") as client:
        yield client


@pytest.mark.parametrize("name", ANSWERS)
@pytest.mark.parametrize(
    ("options", "query"),
    [
        ({}, ""),
        ({"feedback": "hints", "angle_unit": "degrees"}, ""),
        ({"language": "de"}, "?lang=de"),
    ],
)
def test_a_report_is_that_of_the_service(
    name: str, options: dict[str, Any], query: str, service: httpx.Client
) -> None:
    report = dh_grader.grade("planar-rr", ANSWERS[name], **options)
    body = {"answers": ANSWERS[name], "echo": True, **options}
    body.pop("language", None)
    answer = service.post(f"/v1/exercises/planar-rr/grade{query}", json=body)
    assert answer.status_code == 200
    assert report.to_json() == answer.text
    assert report.points == answer.json()["points"]


class Page(HTMLParser):
    """Collects the texts of a page, and the addresses that it loads."""

    def __init__(self, page: str) -> None:
        super().__init__()
        self.texts: list[str] = []
        self.addresses: list[str] = []
        self.feed(page)

    def handle_starttag(self, _: str, attrs: list[tuple[str, str | None]]) -> None:
        self.addresses += [value or "" for name, value in attrs if name in ("src", "href")]

    def handle_data(self, data: str) -> None:
        self.texts.append(data)


def test_a_notebook_shows_the_page_in_a_frame() -> None:
    report = dh_grader.grade("planar-rr", ANSWERS["wrong"])
    [frame] = re.findall(r'<iframe [^>]*srcdoc="([^"]*)"', report._repr_html_())
    page = html.unescape(frame)
    assert page == report.to_html()
    assert page.startswith("<!doctype html>")
    shown = Page(page)
    assert shown.addresses == []
    assert "url(" not in page
    assert "Planar RR arm" in " ".join(shown.texts)
    [message] = report.parts[0].rows[1].cells[1].feedback
    assert message.message.startswith("α is not right: compare ")
    assert "is not right: compare" in "".join(shown.texts)
    assert "dh_grader.grade for planar-rr" in "".join(shown.texts)


def test_the_default_level_is_that_of_students(catalogue: Mapping[str, Exercise]) -> None:
    assert catalogue["planar-rr"].feedback == "hints"
    for feedback, has_correction in ((None, False), ("full", True), ("score", False)):
        report = dh_grader.grade("planar-rr", ANSWERS["wrong"], feedback=feedback)
        cells = [cell for row in report.parts[0].rows for cell in row.cells]
        assert report.feedback == (feedback or "hints")
        assert any(each.correction for cell in cells for each in cell.feedback) is has_correction


def test_the_text_of_a_student_is_no_markup() -> None:
    report = dh_grader.grade("planar-rr", {"position": ['"><script>alert(1)</script>', "0"]})
    assert "<script>" not in report.to_html()
    assert report._repr_html_().count("<") == 2


def test_the_exercise_may_be_a_file_a_variant_or_loaded(
    tmp_path: Path, catalogue: Mapping[str, Exercise]
) -> None:
    own = tmp_path / "own.toml"
    shutil.copy(shipped_folder() / "planar-rr.toml", own)
    shipped = dh_grader.grade("planar-rr", ANSWERS["wrong"])
    for exercise in (own, str(own), catalogue["planar-rr"]):
        report = dh_grader.grade(exercise, ANSWERS["wrong"])
        assert report.points == shipped.points
    varied = next(each for each in catalogue.values() if each.vary is not None)
    assert dh_grader.grade(f"{varied.id}~1", {}).exercise == f"{varied.id}~1"


def test_errors_say_what_was_meant(tmp_path: Path) -> None:
    with pytest.raises(UnknownExerciseError, match="planar-rr"):
        dh_grader.grade("planar-r", {})
    with pytest.raises(UnknownPartNameError, match="Did you mean position"):
        dh_grader.grade("planar-rr", {"positon": "0"})
    with pytest.raises(ValueError, match="angle_unit"):
        dh_grader.grade("planar-rr", {}, angle_unit="gon")
    with pytest.raises(ValueError, match="'xx' is not a language of reports: en, de"):
        dh_grader.grade("planar-rr", {}, language="xx")
    with pytest.raises(TypeError, match="ndarray"):
        dh_grader.grade("planar-rr", {"position": np.zeros(2)})
    faulty = tmp_path / "faulty.toml"
    faulty.write_text("title = 1\n", encoding="utf-8")
    with pytest.raises(CatalogueError, match=r"faulty\.toml"):
        dh_grader.grade(faulty, {})


def test_importing_the_package_alone_loads_no_grader() -> None:
    ask = "import dh_grader, json, sys; print(json.dumps([*sys.modules]))"
    done = subprocess.run([sys.executable, "-c", ask], cwd=ROOT, capture_output=True, check=True)
    loaded = set(json.loads(done.stdout))
    assert {name for name in loaded if name.startswith("dh_grader")} == {"dh_grader"}
    assert {"numpy", "pydantic", "rich", "typer"} & loaded == set()


def test_grading_in_a_notebook_loads_no_server_and_no_database() -> None:
    ask = (
        "import dh_grader, json, sys; dh_grader.grade('planar-rr', {})._repr_html_();"
        "print(json.dumps([*sys.modules]))"
    )
    done = subprocess.run([sys.executable, "-c", ask], cwd=ROOT, capture_output=True, check=True)
    heavy = {"fastapi", "starlette", "sqlalchemy", "httpx", "sympy", "jwt", "rich", "typer"}
    heavy |= {f"dh_grader.{name}" for name in ("api", "cli", "lti", "server", "store", "web")}
    assert heavy & set(json.loads(done.stdout)) == set()
