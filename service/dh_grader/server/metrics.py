"""Metrics for Prometheus.

A label has few values, and never contains text from a client. This file is imported only if metrics
are switched on.
"""

import os
import time
from collections.abc import Iterator
from contextlib import contextmanager
from http import HTTPStatus
from typing import Final

from fastapi import APIRouter, Request, Response
from prometheus_client import (
    CONTENT_TYPE_LATEST,
    CollectorRegistry,
    Counter,
    Gauge,
    Histogram,
    ProcessCollector,
    generate_latest,
)
from prometheus_client.multiprocess import MultiProcessCollector
from starlette.types import ASGIApp, Message, Receive, Scope, Send

from dh_grader import VERSION
from dh_grader.api.http import ProblemError, current_request
from dh_grader.api.permissions import is_at_the_machine
from dh_grader.grading import Report
from dh_grader.grading.report import messages_of
from dh_grader.server.turns import FairAdmission
from dh_grader.server.watching import FOLDER

PATH: Final = "/metrics"
_METHODS: Final = frozenset({"GET", "HEAD", "POST", "OPTIONS", "PUT", "PATCH", "DELETE"})
_OTHER: Final = "other"
# A bound in case a message code is ever made from other text; the program has about 250 codes.
_MOST_CODES: Final = 1000
# Histogram buckets in seconds. A correct table takes 1 ms, the costliest body 50 ms.
_GRADING: Final = (0.0005, 0.001, 0.002, 0.005, 0.01, 0.02, 0.05, 0.1, 0.25, 1.0)
_REQUESTS: Final = (0.001, 0.0025, 0.005, 0.01, 0.025, 0.05, 0.1, 0.25, 0.5, 1.0, 2.5, 5.0, 10.0)
_STORE: Final = (0.001, 0.0025, 0.005, 0.01, 0.025, 0.05, 0.1, 0.25, 0.5, 1.0, 2.5, 5.0)


class Metrics:
    """The metrics of one process, or of all processes that share a folder.

    Unless ``is_public``, only clients on this machine may read the metrics.
    """

    def __init__(self, *, is_public: bool = False) -> None:
        self._is_public = is_public
        self._registry = registry = CollectorRegistry()
        if not _is_shared():
            ProcessCollector(registry=registry)
        self._version = Gauge(
            "dh_grader_info",
            "The version of the program.",
            ["version"],
            registry=registry,
            multiprocess_mode="livemax",
        )
        self._version.labels(VERSION).set(1)
        self._requests = Counter(
            "dh_grader_requests",
            "Requests that were answered, by the pattern of their path.",
            ["method", "route", "status"],
            registry=registry,
        )
        self._refusals = Counter(
            "dh_grader_refusals",
            "Requests that were refused before the application saw them.",
            ["status"],
            registry=registry,
        )
        self._request_seconds = Histogram(
            "dh_grader_request_seconds",
            "From the arrival of a request's head to the end of its answer.",
            ["route"],
            buckets=_REQUESTS,
            registry=registry,
        )
        self._in_progress = Gauge(
            "dh_grader_requests_in_progress",
            "Requests that have come and are not yet answered.",
            registry=registry,
            multiprocess_mode="livesum",
        )
        self._waiting = Gauge(
            "dh_grader_requests_waiting",
            "Requests that have come whole and wait for their turn.",
            registry=registry,
            multiprocess_mode="livesum",
        )
        self._grading_seconds = Histogram(
            "dh_grader_grading_seconds",
            "How long it took to grade a submission.",
            buckets=_GRADING,
            registry=registry,
        )
        self._parts = Counter(
            "dh_grader_parts",
            "Parts of submissions that were graded.",
            ["kind", "verdict"],
            registry=registry,
        )
        self._codes = Counter(
            "dh_grader_messages",
            "Submissions with a message of this code, without remarks (docs/messages.md).",
            ["code"],
            registry=registry,
        )
        self._store_seconds = Histogram(
            "dh_grader_store_seconds",
            "How long a request waited for the database of attempts.",
            ["operation"],
            buckets=_STORE,
            registry=registry,
        )
        self._store_failures = Counter(
            "dh_grader_store_failures",
            "Operations for which the database of attempts failed.",
            ["operation"],
            registry=registry,
        )
        self._known_codes: set[str] = set()
        self._admission: FairAdmission | None = None

    def fair_admission(self, app: ASGIApp) -> ASGIApp:
        """Wrap the application in a FairAdmission (a scheduler), and count waiting requests."""
        self._admission = FairAdmission(app)
        return self._admission

    def watched(self, app: ASGIApp) -> ASGIApp:
        """Wrap the application in a layer that counts requests."""

        async def watching(scope: Scope, receive: Receive, send: Send) -> None:
            if scope["type"] != "http":
                await app(scope, receive, send)
                return
            # The status for a client that has gone before the answer, as in nginx.
            status = 499

            async def noting(message: Message) -> None:
                nonlocal status
                if message["type"] == "http.response.start":
                    status = message["status"]
                await send(message)

            self._in_progress.inc()
            self._note_waiting()
            try:
                await app(scope, receive, noting)
            except Exception:
                status = HTTPStatus.INTERNAL_SERVER_ERROR
                raise
            finally:
                self._in_progress.dec()
                self._note_waiting()
                self._note_answer(scope["method"], status)

        return watching

    def _note_waiting(self) -> None:
        if self._admission is not None:
            self._waiting.set(self._admission.waiting)

    def _note_answer(self, method: str, status: int) -> None:
        request = current_request()
        route = (request and request.route) or _OTHER
        self._requests.labels(
            method if method in _METHODS else _OTHER, route, str(int(status))
        ).inc()
        if request is not None:
            self._request_seconds.labels(route).observe(request.seconds)

    def graded(self, report: Report, seconds: float) -> None:
        """Count a report, and record how many seconds the grading took."""
        self._grading_seconds.observe(seconds)
        codes = set()
        for part in report.parts:
            self._parts.labels(part.kind, str(part.verdict)).inc()
            codes |= {found.code for found, *_ in messages_of(part) if found.severity != "info"}
        for name in codes:
            self._codes.labels(self._bounded(name)).inc()

    def refused(self, answer: str) -> None:
        """Count a request that was refused; ``answer`` is the response's status or "none"."""
        self._refusals.labels(answer).inc()

    def _bounded(self, name: str) -> str:
        if name not in self._known_codes and len(self._known_codes) < _MOST_CODES:
            self._known_codes.add(name)
        return name if name in self._known_codes else _OTHER

    @contextmanager
    def store(self, operation: str) -> Iterator[None]:
        """Measure the time of a database operation, and count its failures."""
        began = time.perf_counter()
        try:
            yield
        except Exception:
            self._store_failures.labels(operation).inc()
            raise
        finally:
            self._store_seconds.labels(operation).observe(time.perf_counter() - began)

    def routes(self) -> APIRouter:
        """Return the router with the route that Prometheus reads."""
        router = APIRouter()

        # Not part of the documented API: its names may change with any version.
        @router.get(PATH, include_in_schema=False)
        async def metrics(request: Request) -> Response:
            if not (self._is_public or is_at_the_machine(request)):
                raise _not_shown()
            return Response(generate_latest(self._readable()), media_type=CONTENT_TYPE_LATEST)

        return router

    def _readable(self) -> CollectorRegistry:
        if not _is_shared():
            return self._registry
        together = CollectorRegistry()
        MultiProcessCollector(together)  # type: ignore[no-untyped-call]
        return together


def _is_shared() -> bool:
    return FOLDER in os.environ


def _not_shown() -> ProblemError:
    return ProblemError(
        HTTPStatus.FORBIDDEN,
        "Metrics can be read only from the machine of the service. To let every client read them, "
        "start the service with DH_GRADER_METRICS=all.",
        "metrics-off",
        "Metrics are not shown here",
    )
