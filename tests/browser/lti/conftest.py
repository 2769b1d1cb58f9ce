"""Fixtures: an LTI platform in a Chromium that blocks third-party cookies."""

import asyncio
import os
from collections.abc import Iterator
from dataclasses import dataclass
from datetime import UTC, datetime
from pathlib import Path

import pytest
from dh_grader.lti import NewRegistration, add_registration
from dh_grader.store.database import in_transaction, open_database
from playwright.sync_api import BrowserContext, Page

from tests.api.serving import served
from tests.browser.chromium import OPTIONS, Chromium
from tests.browser.fixtures import GUARD, Started, complaint
from tests.lti.platform import Platform, running

SECRET = "0123456789abcdef" * 4
OURS = [
    # All frames in one process: Playwright sometimes never hears of a frame that has its own.
    "--disable-site-isolation-trials",
    *(each for each in OPTIONS if "resolver" not in each),
    "--host-resolver-rules=MAP * ~NOTFOUND, EXCLUDE 127.0.0.1, EXCLUDE localhost",
]
# Blocks the cookies of other sites in frames, without exceptions.
CONTROLS = {
    "enableThirdPartyCookieRestriction": True,
    "disableThirdPartyCookieMetadata": True,
    "disableThirdPartyCookieHeuristics": True,
}


@dataclass
class Course:
    """An LTI platform whose pages show the service in a frame."""

    platform: Platform
    context: BrowserContext
    complaints: list[str]
    database: str

    def opened(self, user: str, link: str = "link-1") -> Page:
        page = self.context.new_page()
        controls = self.context.new_cdp_session(page)
        controls.send("Network.enable")
        controls.send("Network.setCookieControls", CONTROLS)
        page.goto(f"{self.platform.address}/course/{user}/{link}")
        return page


@pytest.fixture
def course(
    request: pytest.FixtureRequest, started_browser: Started, chromium: Chromium, tmp_path: Path
) -> Iterator[Course]:
    # The course; with the parameter `bypass_csp`, the browser ignores content policies.
    environment = {"DH_GRADER_DATABASE": str(tmp_path / "lti.db"), "DH_GRADER_SECRET": SECRET}
    platform = Platform(host="localhost")
    with served(tmp_path, **environment) as server, running(platform.app()) as port:
        platform.port, platform.tool = port, server.address
        engine = open_database(environment["DH_GRADER_DATABASE"])
        new = NewRegistration.model_validate(platform.registration)
        in_transaction(engine, lambda it: add_registration(it, new, datetime.now(UTC)))
        engine.dispose()
        asyncio._set_running_loop(started_browser.loop)
        browser = started_browser.browser.browser_type.launch(
            executable_path=chromium.program,
            args=OURS,
            env={**os.environ, **chromium.environment},
        )
        context = browser.new_context(
            reduced_motion="reduce", bypass_csp=getattr(request, "param", "") == "bypass_csp"
        )
        context.set_default_timeout(GUARD)
        told: list[str] = []
        context.on("console", lambda line: told.extend(complaint(line)))
        yield Course(platform, context, told, environment["DH_GRADER_DATABASE"])
        browser.close()
        asyncio._set_running_loop(None)
        assert told == []
