"""One browser and one real server for all tests of a worker; a second origin beside them."""

import os
import subprocess
import sys
import threading
from collections.abc import Callable, Iterator
from contextlib import contextmanager
from dataclasses import dataclass, field
from http.server import BaseHTTPRequestHandler, ThreadingHTTPServer
from pathlib import Path
from typing import Any, Final

import pytest
from playwright.sync_api import (
    Browser,
    BrowserContext,
    ConsoleMessage,
    Page,
    Request,
    expect,
    sync_playwright,
)

from tests.api.serving import ROOT, announced_port
from tests.browser.chromium import ABSENT, OPTIONS, find_chromium
from tests.browser.hostile import HOSTILE_EXERCISE
from tests.guards import ANSWER

# A guard against a hang, in milliseconds: what is waited for takes a hundredth of it.
GUARD = 60_000
expect.set_options(timeout=GUARD)


@dataclass
class Origin:
    """A web server of somebody else, whose pages are the texts in ``pages``, by their paths."""

    address: str
    pages: dict[str, str] = field(default_factory=dict)


@pytest.fixture(scope="session")
def other_origin() -> Iterator[Origin]:
    """A course site, which the service allows."""
    with origin() as made:
        yield made


@pytest.fixture(scope="session")
def stranger() -> Iterator[Origin]:
    """A site that the service does not know."""
    with origin() as made:
        yield made


@contextmanager
def origin() -> Iterator[Origin]:
    """A web server on a port of its own."""
    pages: dict[str, str] = {}

    class Handler(BaseHTTPRequestHandler):
        def do_GET(self) -> None:
            text = pages.get(self.path)
            self.send_response(200 if text is not None else 404)
            self.send_header("Content-Type", "text/html; charset=utf-8")
            self.end_headers()
            self.wfile.write((text or "").encode())

        def log_message(self, *arguments: object) -> None:
            pass

    with ThreadingHTTPServer(("127.0.0.1", 0), Handler) as server:
        thread = threading.Thread(target=server.serve_forever)
        thread.start()
        yield Origin(f"http://127.0.0.1:{server.server_port}", pages)
        server.shutdown()
        thread.join()


@pytest.fixture(scope="session")
def service(tmp_path_factory: pytest.TempPathFactory, other_origin: Origin) -> Iterator[str]:
    """The address of a real process, with the shipped exercises and a hostile one."""
    folder = tmp_path_factory.mktemp("exercises")
    (folder / "hostile.toml").write_text(HOSTILE_EXERCISE, encoding="utf-8")
    log = folder / "log"
    command = [sys.executable, "-m", "service", "serve", "--port", "0"]
    variables = {
        "NO_COLOR": "1",
        "DH_GRADER_CORS_ORIGINS": other_origin.address,
        "DH_GRADER_EXERCISES_DIR": f"shipped{os.pathsep}{folder}",
    }
    with (
        log.open("wb") as output,
        subprocess.Popen(
            command, cwd=ROOT, stdout=output, stderr=output, env=os.environ | variables
        ) as process,
    ):
        try:
            yield f"http://127.0.0.1:{announced_port(process, log)}"
        finally:
            process.terminate()
            process.wait(timeout=ANSWER)
    assert "Traceback" not in log.read_text(encoding="utf-8")


# Not for the whole session: while Playwright is there, an event loop runs, and tests elsewhere that
# start one of their own would fail.
@pytest.fixture(scope="module")
def browser() -> Iterator[Browser]:
    """The browser. Where there is none, the tests fail in continuous integration."""
    found = find_chromium()
    if found is None:
        if os.environ.get("CI"):
            pytest.fail(ABSENT)
        pytest.skip(ABSENT)
    with sync_playwright() as playwright:
        launched = playwright.chromium.launch(
            executable_path=found.program, args=OPTIONS, env={**os.environ, **found.environment}
        )
        yield launched
        launched.close()


@dataclass
class Visit:
    """A page, and what the browser complained about."""

    page: Page
    complaints: list[str] = field(default_factory=list)
    requests: list[str] = field(default_factory=list)


# Said where the processor draws the page: it has to fetch each picture from WebGL.
READBACK: Final = "GPU stall due to ReadPixels"


def complaint(line: ConsoleMessage) -> list[str]:
    """What the browser or a script says in the console, if it is a complaint."""
    is_complaint = line.type in ("error", "warning") and READBACK not in line.text
    return [line.text] if is_complaint else []


def failure(request: Request) -> list[str]:
    """The failure of a request, if it is none that a visitor made by going on to another page."""
    return [] if request.failure == "net::ERR_ABORTED" else [f"{request.failure}: {request.url}"]


@pytest.fixture
def visit(browser: Browser) -> Iterator[Callable[..., Visit]]:
    """Opens a page in a context of its own; at the end nothing may have gone wrong in any."""
    contexts: list[BrowserContext] = []
    visits: list[Visit] = []

    def opened(**options: Any) -> Visit:
        context = browser.new_context(**{"reduced_motion": "reduce", **options})
        context.set_default_timeout(GUARD)
        contexts.append(context)
        made = Visit(context.new_page())
        visits.append(made)
        page, told = made.page, made.complaints
        page.on("console", lambda line: told.extend(complaint(line)))
        page.on("pageerror", lambda error: told.append(str(error)))
        page.on("requestfailed", lambda request: told.extend(failure(request)))
        page.on("request", lambda request: made.requests.append(request.url))
        return made

    yield opened
    for context in contexts:
        context.close()
    for each in visits:
        assert each.complaints == []
        asked = [url.removeprefix("blob:") for url in each.requests]
        assert [url for url in asked if not url.startswith("http://127.0.0.1:")] == []


@pytest.fixture(scope="session")
def axe() -> str:
    """The script of axe-core, which finds what keeps people out."""
    return next((Path(__file__).parent / "axe-core").glob("axe-*.min.js")).read_text("utf-8")
