"""The docs pages on HTTP and on frame choice show the service's real responses."""

import json
import re
from pathlib import Path
from typing import Any

import httpx
from dh_grader.submissions.bodies import MAX_SUBMISSIONS

ROOT = Path(__file__).parents[2]
HTTP = ROOT / "docs" / "http.md"
CURL = re.compile(
    r"^\$ curl -s http://127\.0\.0\.1:8000(\S+) \\\n"
    r" +-H 'Content-Type: application/json' -d @(\S+)$",
    re.MULTILINE,
)


def json_blocks(page: str) -> list[dict[str, Any]]:
    text = (ROOT / page).read_text(encoding="utf-8")
    return [json.loads(block) for block in re.findall(r"```json\n(.*?)```", text, re.DOTALL)]


def test_the_curl_of_the_page_gets_the_answer_that_it_prints(client: httpx.Client) -> None:
    (url, file), _ = CURL.findall(HTTP.read_text(encoding="utf-8"))
    (printed,) = json_blocks("docs/http.md")
    # By default, curl sends the content type of a form.
    for content_type in ("application/json", "application/x-www-form-urlencoded"):
        answered = client.post(
            url, content=(ROOT / file).read_bytes(), headers={"Content-Type": content_type}
        )
        assert answered.status_code == 200
        assert answered.json() == {**printed, "version": answered.json()["version"]}


def test_the_curl_for_many_gets_a_report_and_a_problem(client: httpx.Client) -> None:
    _, (url, file) = CURL.findall(HTTP.read_text(encoding="utf-8"))
    results = client.post(url, content=(ROOT / file).read_bytes()).json()["results"]
    assert [set(result) for result in results] == [{"report"}, {"problem"}]
    page = HTTP.read_text(encoding="utf-8")
    assert f"up to {MAX_SUBMISSIONS} submissions" in page


def test_the_worked_example_of_frame_choice_gets_full_marks(client: httpx.Client) -> None:
    (submission,) = json_blocks("docs/frame-choice.md")
    report = client.post("/v1/exercises/stanford-arm/grade", json=submission).json()
    table = report["parts"][0]
    assert table["points"] == table["max_points"]
    remarks = [message["message"] for message in table["feedback"]]
    assert remarks == ["You let z2 point the opposite way; that is a valid choice."]
    forgot = {**submission["answers"]["table"]["rows"][2], "d": "d3"}
    submission["answers"]["table"]["rows"][2] = forgot
    report = client.post("/v1/exercises/stanford-arm/grade", json=submission).json()
    wrong = [
        (row["label"], cell["label"], [message["code"] for message in cell["feedback"]])
        for row in report["parts"][0]["rows"]
        for cell in row["cells"]
        if cell["verdict"] != "correct"
    ]
    assert wrong == [("3", "d", ["joint_variable_sign"])]


def test_every_link_of_the_pages_leads_somewhere() -> None:
    for page in (ROOT / "README.md", *(ROOT / "docs").glob("*.md")):
        for link in re.findall(r"\]\(([^)#]+)[^)]*\)", page.read_text(encoding="utf-8")):
            if "://" not in link:
                assert (page.parent / link).exists(), f"{page.name}: {link}"
