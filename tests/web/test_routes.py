"""Test the responses for pages and static files."""

import asyncio
import gzip
import re
from collections.abc import Iterator, Mapping

import httpx
import pytest
from dh_grader.api.application import application
from dh_grader.catalogue import Exercise
from dh_grader.web import web_routes
from dh_grader.web.pages import load_assets

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
