"""Send request bodies to the program and measure their cost."""

import asyncio
import gc
import itertools
import json
import statistics
import tempfile
import time
from collections.abc import Callable, Mapping
from dataclasses import dataclass
from datetime import UTC, datetime
from functools import cached_property
from pathlib import Path
from typing import Any

from dh_grader.api.application import application
from dh_grader.catalogue import Exercise
from dh_grader.expressions import reader, words
from dh_grader.expressions import reader as decimals
from dh_grader.expressions import reader as reading_work
from dh_grader.formats import report_format
from dh_grader.formats.graded import GradingTerms, Setting, graded
from dh_grader.store.attempt_store import AttemptStore
from dh_grader.submissions import of_one
from dh_grader.submissions.files import all_handed_in
from fastapi import FastAPI
from rich.console import Console

from tests.benchmarks.floors import stanford_pose
from tests.store.databases import new_file

GRADE, ATTEMPTS, PREVIEW, FILE = "grade", "attempts", "preview", "file"
PREVIEWS, FRAMES = "many-previews", "frames"
# A batch holds only one submission, because a batch may cost as much as its submissions together.
BATCH, HINTS, SOLUTION = "batch", "hints", "solution"
ENTRIES = (GRADE, ATTEMPTS, PREVIEW, PREVIEWS, FRAMES, FILE, BATCH, HINTS, SOLUTION)
# The entry points that take a submission.
SUBMITTED = (GRADE, ATTEMPTS, FILE, BATCH, HINTS, SOLUTION)
_PATHS = {
    PREVIEW: "/v1/preview", PREVIEWS: "/v1/previews", FRAMES: "/v1/frames", BATCH: "/v1/grade",
}  # fmt: skip
_CACHES = (
    *reader._reader_memoized, reader._parsed, reading_work._reading_work_memoized,
    reading_work._of_word, words.split, decimals.decimals_of,
)  # fmt: skip


@dataclass(frozen=True)
class Attack:
    """A request: its entry point, its exercise and its body."""

    # Whenever an attempt is sent, it belongs to a new learner.
    entry: str
    exercise: str
    body: Mapping[str, Any]

    @cached_property
    def content(self) -> bytes:
        return json.dumps(self.body, ensure_ascii=False).encode("utf-8", "replace")


def forget() -> None:
    """Empty the caches of texts."""
    for cache in _CACHES:
        cache.cache_clear()


def floor_seconds() -> float:
    """Return the processor time for one pose, the unit of all costs."""
    times = []
    for _ in range(20):
        start = time.process_time()
        for _ in range(10):
            stanford_pose(32)
        times.append((time.process_time() - start) / 10)
    return statistics.median(times)


class Target:
    """The program, started in this process, which gets the requests."""

    def __init__(self, exercises: Mapping[str, Exercise]) -> None:
        self.exercises = exercises
        self._loop = asyncio.new_event_loop()
        self._folder = tempfile.TemporaryDirectory()
        self._store = AttemptStore.open(new_file(Path(self._folder.name)))
        self._store.start()
        self._learners = itertools.count()
        self._app: FastAPI = application(exercises, store=self._store)
        # The service does this at its start.
        gc.collect()
        gc.freeze()

    def close(self) -> None:
        self._loop.close()
        self._store.close()
        self._folder.cleanup()

    def answer(self, attack: Attack) -> int:
        return self._action(attack)()

    def seconds(self, attack: Attack, rounds: int = 2) -> tuple[float, int]:
        action = self._action(attack)
        best, status = float("inf"), 0
        for _ in range(rounds):
            forget()
            gc.collect()
            start = time.process_time()
            status = action()
            best = min(best, time.process_time() - start)
        return best, status

    def ratio(self, attack: Attack, enough: float = 0.0, most: int = 8) -> tuple[float, int]:
        """Return the least cost of a request as a multiple of the floor, and its status."""
        # The floor is measured before and after each request, because a busy machine slows both.
        # The least of some rounds counts: other programs only ever add to a cost. Nothing is
        # measured again once a cost is below ``enough``.
        best, status = float("inf"), 0
        for _ in range(most):
            before = floor_seconds()
            seconds, status = self.seconds(attack, 1)
            best = min(best, 2 * seconds / (before + floor_seconds()))
            if best < enough:
                break
        return best, status

    def _action(self, attack: Attack) -> Callable[[], int]:
        content = self._content(attack)
        if attack.entry == FILE:
            path = Path(self._folder.name) / "submission.json"
            path.write_bytes(content)
            return lambda: self._file(path, attack.exercise)
        if attack.entry == ATTEMPTS:
            return lambda: self._loop.run_until_complete(self._recorded(attack.exercise, content))
        name = attack.entry if attack.entry in (HINTS, SOLUTION) else GRADE
        url = _PATHS.get(attack.entry, f"/v1/exercises/{attack.exercise}/{name}")
        return lambda: self._loop.run_until_complete(self._posted(url, content))

    def _content(self, attack: Attack) -> bytes:
        # The bodies of a batch and of a hint are a submission, and more around it.
        if attack.entry == BATCH:
            return b'{"submissions": [{"exercise": "%b", %b]}' % (
                attack.exercise.encode(),
                attack.content[1:],
            )
        if attack.entry == HINTS:
            part = self.exercises[attack.exercise].parts[0].id
            return b'{"part": "%b", "code": "sign", "step": 1, %b' % (
                part.encode(),
                attack.content[1:],
            )
        return attack.content

    async def _recorded(self, exercise: str, content: bytes) -> int:
        # A learner with too many attempts would be refused.
        learner = b'{"learner": "l%d", ' % next(self._learners)
        return await self._posted(f"/v1/exercises/{exercise}/attempts", learner + content[1:])

    async def _posted(self, url: str, content: bytes) -> int:
        status = 0

        async def receive() -> dict[str, Any]:
            return {"type": "http.request", "body": content, "more_body": False}

        async def send(message: Mapping[str, Any]) -> None:
            nonlocal status
            status = message.get("status", status)

        length = (b"content-length", str(len(content)).encode())
        scope = {
            "type": "http", "asgi": {"version": "3.0"}, "http_version": "1.1", "method": "POST",
            "scheme": "http", "path": url, "raw_path": url.encode(), "query_string": b"",
            "root_path": "", "headers": [(b"content-type", b"application/json"), length],
            "client": ("127.0.0.1", 1), "server": ("127.0.0.1", 80),
        }  # fmt: skip
        await self._app(scope, receive, send)
        return status

    def _file(self, path: Path, exercise: str) -> int:
        terms = GradingTerms(of_one(self.exercises[exercise]), pass_mark=0.8)
        [handed_in] = all_handed_in([path])
        submission = graded(handed_in, terms)
        with Path("/dev/null").open("w") as nothing:
            setting = Setting(terms.answered, Console(file=nothing, width=80), datetime.now(UTC))
            for _ in report_format("text").pieces([submission], setting):
                pass
        return 200 if submission.is_graded else 422
