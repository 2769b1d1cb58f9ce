"""`python -m tests.benchmarks.app serve …`: `dh-grader serve …` with two more routes.

The first route only validates a body; the second returns the processor time of its process.
"""

import time
from typing import Any

from dh_grader import server as start
from dh_grader.cli import main
from dh_grader.server import installed_app
from fastapi import FastAPI
from pydantic import BaseModel


class Trivial(BaseModel):
    """The body of a request that is validated but not graded."""

    answers: dict[str, Any]


async def trivial(body: Trivial) -> dict[str, int]:
    """Validate and answer a POST without grading it."""
    return {"parts": len(body.answers)}


async def processor_seconds() -> float:
    """Return the processor time of this process."""
    return time.process_time()


def _with_trivial(*arguments: Any, **options: Any) -> FastAPI:
    app = installed_app(*arguments, **options)
    app.post("/trivial")(trivial)
    app.get("/processor-seconds")(processor_seconds)
    return app


# At module level, so that workers, which import this module, have the routes, too.
vars(start)["installed_app"] = _with_trivial

if __name__ == "__main__":
    main()
