"""The page /docs works without the internet."""

import hashlib
import re
from collections.abc import Callable

import httpx
import pytest
from dh_grader.api.document import FOLDER
from playwright.sync_api import expect

from tests.api.serving import Served
from tests.browser.fixtures import Visit
from tests.guards import ANSWER

PAGE = "/docs"


def sources(html: str) -> list[str]:
    return re.findall(r'(?:src|href)="([^"]+)"', html)


@pytest.mark.long
def test_the_page_names_no_other_host(server: Served) -> None:
    with httpx.Client(base_url=server.address, trust_env=False, timeout=ANSWER) as client:
        page = client.get(PAGE)
        assert page.headers["content-type"] == "text/html; charset=utf-8"
        addresses = sources(page.text)
        assert len([each for each in addresses if each.startswith("docs/")]) == 3
        assert [each for each in addresses if "//" in each or each.startswith("/")] == []
        assert all(client.get(f"/{each}").status_code == 200 for each in addresses)


@pytest.mark.long
def test_the_browser_is_told_to_load_and_call_nothing_else(server: Served) -> None:
    page = httpx.get(f"{server.address}{PAGE}", trust_env=False, timeout=ANSWER)
    policy = page.headers["content-security-policy"]
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
    # The checksums were taken from the npm package when the files were copied.
    lines = (FOLDER / "SHA256SUMS").read_text(encoding="utf-8").splitlines()
    assert len(lines) == 2
    for line in lines:
        published, name = line.split("  ")
        assert hashlib.sha256((FOLDER / name).read_bytes()).hexdigest() == published
    assert "Apache License" in (FOLDER / "LICENSE").read_text(encoding="utf-8")


@pytest.mark.campaign
def test_in_a_browser_without_the_internet(visit: Callable[..., Visit], server: Served) -> None:
    origin = f"{server.address}/"
    document = httpx.get(f"{origin}openapi.json", trust_env=False, timeout=ANSWER).json()
    paths = document["paths"].values()
    opened = visit()
    page = opened.page
    page.goto(server.address + PAGE)
    expect(page.locator(".opblock")).to_have_count(sum(map(len, paths)))
    many = page.locator("#operations-grading-gradeMany")
    many.locator(".opblock-summary-control").click()
    many.locator(".execute").click()
    answer = many.locator(".live-responses-table .response")
    expect(answer).to_contain_text("200")
    expect(answer).to_contain_text("urn:dh-grader:problem:unknown-exercise")
    assert [url for url in opened.requests if not url.startswith((origin, "data:"))] == []
    assert f"{origin}v1/grade" in opened.requests
