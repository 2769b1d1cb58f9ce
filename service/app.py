"""The service, for `uvicorn service.app:app` in a checkout; installed it is `dh_grader.app:app`."""

from dh_grader.app import app

__all__ = ["app"]
