"""`python -m tests.lti.load.rush`: 200 students open an exercise from their course in a minute.

Print the waiting times and the processor time per student. Exit with 1 if a request fails or takes
too much time.
"""

# Each student logs in at the platform, launches, and requests all that the first page needs. Before
# that, a tenth of the students come with new browsers, which also request the scripts. All students
# have one address, as on a campus. A view may take at most 300 ms of processor time.

import argparse
import asyncio
import os
import re
import sys
import tempfile
import time
from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field
from datetime import UTC, datetime
from html import unescape
from pathlib import Path
from typing import Any, Final

import httpx
from dh_grader.lti.registrations import NewRegistration, add_registration
from dh_grader.store.database import in_transaction, open_database
from rich.console import Console

from tests.access.kept_services import SECRET_TEXT
from tests.guards import ANSWER
from tests.load.__main__ import database
from tests.lti.platform import Platform, running
from tests.server.raw import Service, service
from tests.store.databases import KINDS

show = Console(highlight=False, soft_wrap=True).print
# The most processor time from the login to the first view (seconds).
BUDGET: Final = 0.3
# How many students have opened the exercise before, so that all processes have warmed up.
_WARM: Final = 8
# As many connections at once as browsers use.
_LIMITS: Final = httpx.Limits(max_connections=6)


@dataclass
class Rush:
    """The waiting times, failures and number of requests of a class."""

    waits: list[float] = field(default_factory=list)
    failures: list[str] = field(default_factory=list)
    requests: int = 0

    def quantile(self, share: float) -> float:
        ordered = sorted(self.waits) or [float("nan")]
        return ordered[min(int(len(ordered) * share), len(ordered) - 1)]


class Browser:
    """The browser of one student, with cookies and connections of its own."""

    def __init__(self, client: httpx.AsyncClient, platform: Platform, rush: Rush) -> None:
        self._client, self._platform, self._rush = client, platform, rush

    async def view(self, user: str, *, is_new: bool) -> None:
        """Open the exercise."""
        # A new browser requests all scripts; old browsers have cached them.
        began = time.perf_counter()
        try:
            await self._view(user, is_new=is_new)
        except (AssertionError, httpx.HTTPError) as error:
            self._rush.failures.append(f"{user}: {error!r}")
        else:
            self._rush.waits.append(time.perf_counter() - began)

    async def _view(self, user: str, *, is_new: bool) -> None:
        login = await self._ask("GET", "/lti/login", 302, params=self._platform.login(user))
        page = await self._client.get(login.headers["location"])
        fields = dict(re.findall(r'name="(\w+)" value="([^"]*)"', page.text))
        # Cookies of this machine without HTTPS are sent by browsers, but not by this client.
        headers = {
            "cookie": login.headers["set-cookie"].partition(";")[0],
            "origin": self._platform.address,
            "sec-fetch-site": "cross-site",
        }
        sent = {name: unescape(value) for name, value in fields.items()}
        text = (await self._ask("POST", "/lti/launch", data=sent, headers=headers)).text
        if is_new:
            files = sorted(set(re.findall(r'"\.\./(static/[^"]+)"', text)))
            assert len(files) > 20, files
            await asyncio.gather(*(self._ask("GET", f"/{each}") for each in files))
        [token] = re.findall(r'data-key="([^"]+)"', text)
        bearer: dict[str, Any] = {"headers": {"authorization": f"Bearer {token}"}}
        [course] = (await self._ask("GET", "/v1/me", **bearer)).json()["courses"]
        place = {"course": course["id"], "assignment": course["assignments"][0]["id"]}
        for path in ("planar-rr", "planar-rr/figure.svg"):
            await self._ask("GET", f"/v1/exercises/{path}", params=place, **bearer)
        # The element and the list of exercises ask for themselves.
        for _ in range(2):
            await self._ask("GET", "/v1/me", **bearer)

    async def _ask(self, method: str, path: str, status: int = 200, **more: Any) -> httpx.Response:
        self._rush.requests += 1
        answer = await self._client.request(method, self._platform.tool + path, **more)
        told = re.sub(r"<[^>]*>|\s+", " ", answer.text)[-300:]
        assert answer.status_code == status, f"{method} {path}: {answer.status_code} {told}"
        return answer


async def rush(
    platform: Platform,
    users: Sequence[str],
    seconds: float,
    *,
    is_new: bool,
    mounts: Mapping[str, httpx.AsyncBaseTransport] | None = None,
) -> Rush:
    """Let users open the exercise, evenly spread over some seconds."""
    # `mounts` maps an address to the transport for it, if no server listens there.
    told = Rush()

    async def one(number: int, user: str) -> None:
        await asyncio.sleep(seconds * number / len(users))
        options = {"verify": False, "timeout": ANSWER, "limits": _LIMITS, "mounts": mounts}
        async with httpx.AsyncClient(**options) as client:  # type: ignore[arg-type]
            await Browser(client, platform, told).view(user, is_new=is_new)

    await asyncio.gather(*(one(number, user) for number, user in enumerate(users)))
    return told


def processor_time(running: Service) -> float:
    """Return the processor time of a service and its processes so far (seconds)."""
    main = running.process.pid
    children = Path(f"/proc/{main}/task/{main}/children").read_text(encoding="ascii").split()
    ticks = 0
    for each in [str(main), *children]:
        fields = Path(f"/proc/{each}/stat").read_text(encoding="utf-8").rpartition(")")[2].split()
        ticks += int(fields[11]) + int(fields[12])
    return ticks / os.sysconf("SC_CLK_TCK")


def measure(kind: str, students: int, seconds: float, workers: int) -> list[str]:
    broken = []
    with (
        tempfile.TemporaryDirectory() as name,
        database(kind, Path(name)) as url,
        service(
            Path(name),
            "--workers",
            str(workers),
            DH_GRADER_DATABASE=url,
            DH_GRADER_SECRET=SECRET_TEXT,
        ) as running_service,
    ):
        platform = Platform(tool=f"http://127.0.0.1:{running_service.port}")
        with running(platform.app()) as platform.port:
            engine = open_database(url)
            new = NewRegistration.model_validate(platform.registration)
            in_transaction(engine, lambda it: add_registration(it, new, datetime.now(UTC)))
            engine.dispose()
            while running_service.log.count("startup complete") < workers:
                time.sleep(0.05)
            asyncio.run(rush(platform, [f"w{i}" for i in range(_WARM)], 2, is_new=True))
            for called, number, spread, is_new in (
                ("a new browser", students // 10, seconds / 2, True),
                ("again", students, seconds, False),
                ("in a hurry", students, seconds / 4, False),
            ):
                before, began = processor_time(running_service), time.perf_counter()
                users = [f"{called} {i}" for i in range(number)]
                told = asyncio.run(rush(platform, users, spread, is_new=is_new))
                cost = (processor_time(running_service) - before) / number
                show(
                    f"{kind:10} {called:14} {len(told.waits):4} of {number:3} in "
                    f"{time.perf_counter() - began:4.0f} s, {told.requests // number:2} requests "
                    f"each: {1000 * cost:4.0f} ms of processor time, wait p50 "
                    f"{told.quantile(0.5):5.2f} s, p99 {told.quantile(0.99):5.2f} s"
                )
                broken += told.failures
                if cost > BUDGET:
                    broken.append(f"{kind}, {called}: a view costs {1000 * cost:.0f} ms")
    return broken


def main() -> int:
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--students", type=int, default=200)
    parser.add_argument("--seconds", type=float, default=60)
    parser.add_argument("--workers", type=int, default=2)
    parser.add_argument("--database", choices=KINDS, action="append")
    given = parser.parse_args()
    broken = []
    for kind in given.database or KINDS:
        broken += measure(kind, given.students, given.seconds, given.workers)
    for line in broken[:20]:
        show(line)
    return bool(broken)


if __name__ == "__main__":
    sys.exit(main())
