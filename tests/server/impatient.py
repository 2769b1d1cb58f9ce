"""`python -m tests.server.impatient`: the service with short timeouts for tests."""

# It has two more routes, `GET /hanging` and `GET /working` (in a thread), which never answer. The
# environment variable `TIMEOUT` lengthens all timeouts except for heads and the shutdown.

import asyncio
import os
import time

from dh_grader import server as start
from dh_grader.api import grading as health
from dh_grader.cli import main
from dh_grader.server import connections, installed_app
from dh_grader.settings import Settings
from fastapi import FastAPI

TIMEOUT = 1.0
HEAD_TIMEOUT = TIMEOUT / 2


async def _hanging() -> None:
    await asyncio.sleep(600)


async def _working() -> None:
    await asyncio.to_thread(time.sleep, 600)


def _with_hanging(settings: Settings, host: str) -> FastAPI:
    app = installed_app(settings, host)
    app.add_api_route("/hanging", _hanging)
    app.add_api_route("/working", _working)
    return app


if __name__ == "__main__":
    for module, name, seconds in (
        (connections, "TIMEOUT", float(os.environ.get("TIMEOUT", TIMEOUT))),
        (connections, "HEAD_TIMEOUT", HEAD_TIMEOUT),
        (connections, "LINGER", 0.3),
        (connections, "SWEEP", 0.05),
        (start, "GRACE", TIMEOUT / 2),
        (health, "_PATIENCE", TIMEOUT / 2),
    ):
        vars(module)[name] = seconds
    vars(start)["installed_app"] = _with_hanging
    main()
