"""The service with one route more, which reads and validates a body and does nothing with it."""

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
