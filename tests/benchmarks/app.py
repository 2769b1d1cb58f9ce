"""`python -m tests.benchmarks.app serve …`: `dh-grader serve …` with two routes more.

One only validates a body, the other tells the processor time of its process.
"""

import time
from typing import Any

from fastapi import FastAPI
from pydantic import BaseModel

from service.cli import main
from service.server import start
from service.server.installed import installed_app


class Trivial(BaseModel):
    """The shape of a submission."""

    answers: dict[str, Any]


async def trivial(body: Trivial) -> dict[str, int]:
    """What a POST costs that is validated and answered, but not graded."""
    return {"parts": len(body.answers)}


async def processor_seconds() -> float:
    """The processor time that this process has taken."""
    return time.process_time()


def _with_trivial(*arguments: Any) -> FastAPI:
    app = installed_app(*arguments)
    app.post("/trivial")(trivial)
    app.get("/processor-seconds")(processor_seconds)
    return app


# Outside of what follows, so that workers, which import this module, have the routes, too.
vars(start)["installed_app"] = _with_trivial

if __name__ == "__main__":
    main()
