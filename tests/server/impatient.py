"""`python -m tests.server.impatient`: the service with little patience, so that tests need none.

`GET /hanging` there never comes to an answer, nor does `GET /working`, in a thread. The variable
``PATIENCE`` lets it wait longer for all but heads; at its end it stays impatient.
"""

import asyncio
import os
import time

from fastapi import FastAPI

from service.api.routes import health
from service.cli import main
from service.server import start
from service.server.connections import open_connections as crowd
from service.server.connections import protocol
from service.server.installed import installed_app
from service.server.processes import process
from service.settings import Settings

PATIENCE = 1.0
HEAD_PATIENCE = PATIENCE / 2


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
        (protocol, "PATIENCE", float(os.environ.get("PATIENCE", PATIENCE))),
        (protocol, "HEAD_PATIENCE", HEAD_PATIENCE),
        (protocol, "LINGER", 0.3),
        (crowd, "SWEEP", 0.05),
        (process, "GRACE", PATIENCE / 2),
        (health, "_PATIENCE", PATIENCE / 2),
    ):
        vars(module)[name] = seconds
    vars(start)["installed_app"] = _with_hanging
    main()
