"""Start one browser for all tests, and open pages in it."""

import asyncio
import os
from collections.abc import Callable, Iterator
from dataclasses import dataclass, field
from typing import Any, Final, Literal

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

from tests.browser.chromium import ABSENT, OPTIONS, Chromium, find_chromium

# Milliseconds; a guard against hangs, a hundred times what the tests wait for.
GUARD: Final = 60_000
expect.set_options(timeout=GUARD)
# The addresses that a page may load: servers of the tests, and files.
OURS: Final = ("http://127.0.0.1:", "file:", "data:")
# A light screen, a dark screen, and paper.
APPEARANCES: Final[tuple[tuple[Literal["screen", "print"], Literal["light", "dark"]], ...]] = (
    ("screen", "light"),
    ("screen", "dark"),
    ("print", "dark"),
)


@pytest.fixture(scope="session")
def chromium() -> Chromium:
    found = find_chromium()
    if found is None:
        if os.environ.get("CI"):
            pytest.fail(ABSENT)
        pytest.skip(ABSENT)
    return found


@dataclass
class Started:
    """A started browser, and Playwright's event loop."""

    browser: Browser
    loop: asyncio.AbstractEventLoop


@pytest.fixture(scope="session")
def started_browser(chromium: Chromium) -> Iterator[Started]:
    with sync_playwright() as playwright:
        launched = playwright.chromium.launch(
            executable_path=chromium.program,
            args=OPTIONS,
            env={**os.environ, **chromium.environment},
        )
        started = Started(launched, asyncio.get_running_loop())
        asyncio._set_running_loop(None)
        yield started
        asyncio._set_running_loop(started.loop)
        launched.close()


@pytest.fixture
def browser(started_browser: Started) -> Iterator[Browser]:
    """The browser for tests."""
    # Playwright leaves its event loop marked as running in this thread, which prevents other loops.
    # The fixture removes this mark while tests without a browser run.
    asyncio._set_running_loop(started_browser.loop)
    yield started_browser.browser
    asyncio._set_running_loop(None)


@dataclass
class Visit:
    """An open page, its errors and warnings, and the addresses that it requested."""

    page: Page
    complaints: list[str] = field(default_factory=list)
    requests: list[str] = field(default_factory=list)


# A complaint to ignore: without a graphics card, the browser reads each picture back from WebGL.
READBACK: Final = "GPU stall due to ReadPixels"


def complaint(line: ConsoleMessage) -> list[str]:
    # Return a list with the console message, or an empty list if the test may ignore it.
    #
    # A missing /favicon.ico is ignored: a browser requests this file if a page, such as a JSON
    # document, does not name an icon.
    is_known = READBACK in line.text or line.location["url"].endswith("/favicon.ico")
    return [f"{line.text} {line.location['url']}"] if is_serious(line) and not is_known else []


def is_serious(line: ConsoleMessage) -> bool:
    """True if the console message is an error or a warning."""
    return line.type in ("error", "warning")


def failure(request: Request) -> list[str]:
    # Return a list with the failure of a request; empty if the visitor has left the page.
    return [] if request.failure == "net::ERR_ABORTED" else [f"{request.failure}: {request.url}"]


@pytest.fixture
def visit(browser: Browser) -> Iterator[Callable[..., Visit]]:
    """Yield a function that opens a page; fail if the page has errors or warnings."""
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
        assert [url for url in asked if not url.startswith(OURS)] == []
