"""The page /docs, without the internet."""

import hashlib
import re
import sys

import httpx
import pytest

from service.api.reference import FOLDER
from tests import chromium

PAGE = "/docs"


def sources(html: str) -> list[str]:
    return re.findall(r'(?:src|href)="([^"]+)"', html)


def test_the_page_names_no_other_host(client: httpx.Client) -> None:
    page = client.get(PAGE)
    assert page.headers["content-type"] == "text/html; charset=utf-8"
    addresses = [each for each in sources(page.text) if not each.startswith("data:")]
    assert len(addresses) == 4
    assert [each for each in addresses if "//" in each or each.startswith("/")] == []
    assert all(client.get(f"/{each}").status_code == 200 for each in addresses)


def test_the_browser_is_told_to_load_and_call_nothing_else(client: httpx.Client) -> None:
    policy = client.get(PAGE).headers["content-security-policy"]
    directives = dict(part.strip().split(" ", 1) for part in policy.split(";"))
    assert directives["default-src"] == "'none'"
    assert set(" ".join(directives.values()).split()) == {"'none'", "'self'", "data:"}
    assert "data:" not in directives["script-src"]


@pytest.mark.parametrize(
    ("name", "media_type"),
    [
        ("swagger-ui-5.35.0.js", "text/javascript; charset=utf-8"),
        ("swagger-ui-5.35.0.css", "text/css; charset=utf-8"),
        ("start.js", "text/javascript; charset=utf-8"),
    ],
)
def test_a_file_of_the_page(client: httpx.Client, name: str, media_type: str) -> None:
    answer = client.get(f"{PAGE}/{name}")
    assert answer.headers["content-type"] == media_type
    assert ("immutable" in answer.headers["cache-control"]) == ("5.35.0" in name)
    assert answer.content == (FOLDER / name).read_bytes()


@pytest.mark.parametrize("name", ["SHA256SUMS", "LICENSE", "x.js", "..%2fpage.py", "%2e%2e"])
def test_there_are_no_other_files(client: httpx.Client, name: str) -> None:
    answer = client.get(f"{PAGE}/{name}")
    assert answer.status_code == 404
    assert answer.headers["content-type"] == "application/problem+json"


@pytest.mark.parametrize("path", ["/redoc", "/docs/oauth2-redirect"])
def test_the_framework_s_own_pages_are_off(client: httpx.Client, path: str) -> None:
    assert client.get(path).status_code == 404


def test_the_files_are_those_that_were_published() -> None:
    """The sums were taken from the npm package when the files were copied."""
    lines = (FOLDER / "SHA256SUMS").read_text(encoding="utf-8").splitlines()
    assert len(lines) == 2
    for line in lines:
        published, name = line.split("  ")
        assert hashlib.sha256((FOLDER / name).read_bytes()).hexdigest() == published
    assert "Apache License" in (FOLDER / "LICENSE").read_text(encoding="utf-8")


@pytest.mark.campaign
@pytest.mark.skipif(chromium.FOUND is None or sys.platform == "win32", reason="needs a Chromium")
def test_in_a_browser_without_the_internet(port: int, client: httpx.Client) -> None:
    paths = client.get("/openapi.json").json()["paths"].values()
    with chromium.blank_page() as page:
        page.open(f"http://127.0.0.1:{port}{PAGE}")
        shown = page.wait_for("document.querySelectorAll('.opblock').length")
        assert shown == sum(map(len, paths))
        many = "document.querySelector('#operations-grading-gradeMany {}')"
        page.wait_for(f"({many.format('.opblock-summary-control')}.click(), true)")
        page.wait_for(f"{many.format('.execute')} && ({many.format('.execute')}.click(), true)")
        answer = ".live-responses-table .response"
        text = page.wait_for(f"{many.format(answer)} && {many.format(answer)}.innerText")
        assert text.startswith("200")
        assert "urn:dh-grader:problem:unknown-exercise" in text
        assert page.complaints == []
        origin = f"http://127.0.0.1:{port}/"
        away = [url for url in page.requests if not url.startswith((origin, "data:"))]
        assert away == []
        assert f"{origin}v1/grade" in page.requests
