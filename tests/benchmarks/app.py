"""The service with a route that only validates a body, and one that tells its processor time."""

import time
from typing import Any

from pydantic import BaseModel

from service.app import app


class Trivial(BaseModel):
    """The shape of a submission."""

    answers: dict[str, Any]


@app.post("/trivial")
async def trivial(body: Trivial) -> dict[str, int]:
    """What a POST costs that is validated and answered, but not graded."""
    return {"parts": len(body.answers)}


@app.get("/processor-seconds")
async def processor_seconds() -> float:
    """The processor time that this process has taken."""
    return time.process_time()
