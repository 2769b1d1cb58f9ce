"""Reports stay the same if gradings interrupt each other."""

import asyncio
import threading
from collections.abc import Callable, Iterator
from contextvars import ContextVar
from functools import partial
from itertools import islice
from typing import Any

import numpy as np
import pytest
from dh_grader import slices as time_slices
from dh_grader.grading import grade
from dh_grader.slices import checkpoint, in_slices, working_time
from dh_grader.submissions.bodies import GradeRequest

from tests.load.wrong_answers import tables
from tests.shipped import shipped_exercises

_NAME = ContextVar("name", default="")


@pytest.fixture(autouse=True)
def short(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(time_slices, "FIRST_SLICE", 0.0)
    monkeypatch.setattr(time_slices, "SLICE", 0.0)


async def give_way() -> None:
    """Let all ready tasks run before this task continues."""
    await asyncio.sleep(0)


def counting(name: str, log: list[str]) -> Callable[[], str]:
    def work() -> str:
        for i in range(3):
            log.append(f"{name}{i}")
            checkpoint()
        return name

    return work


def test_two_tasks_take_turns_at_their_checkpoints() -> None:
    log: list[str] = []

    async def both() -> list[str]:
        works = (in_slices(counting(name, log), give_way) for name in "ab")
        return await asyncio.gather(*works)

    assert asyncio.run(both()) == ["a", "b"]
    assert log == ["a0", "b0", "a1", "b1", "a2", "b2"]


def test_an_exception_is_raised_where_the_work_is_awaited() -> None:
    def work() -> None:
        checkpoint()
        raise KeyError("x")

    with pytest.raises(KeyError):
        asyncio.run(in_slices(work, give_way))


def test_abandoned_work_ends_at_its_checkpoint() -> None:
    ended = []

    def work() -> None:
        try:
            checkpoint()
        finally:
            ended.append("work")

    async def gone() -> None:
        raise ConnectionError

    with pytest.raises(ConnectionError):
        asyncio.run(in_slices(work, gone))
    assert ended == ["work"]


def test_each_task_keeps_its_context_variables_and_float_errors() -> None:
    def work() -> tuple[str, str]:
        with np.errstate(divide="raise"):
            checkpoint()
            found = np.geterr()["divide"]
        checkpoint()
        return _NAME.get(), found

    async def named(name: str) -> tuple[str, str]:
        _NAME.set(name)
        return await in_slices(work, give_way)

    async def both() -> list[tuple[str, str]]:
        return await asyncio.gather(*(named(name) for name in "ab"))

    assert asyncio.run(both()) == [("a", "raise"), ("b", "raise")]
    assert np.geterr()["divide"] == "warn"


def test_other_threads_are_not_suspended() -> None:
    def work() -> str:
        found = []
        thread = threading.Thread(target=lambda: found.append(counting("t", [])()))
        thread.start()
        thread.join()
        return found[0]

    assert asyncio.run(in_slices(work, give_way)) == "t"


def test_working_time_excludes_suspension() -> None:
    async def slow() -> None:
        await asyncio.sleep(0.5)

    def work() -> float:
        began = working_time()
        checkpoint()
        return working_time() - began

    assert asyncio.run(in_slices(work, slow)) < 0.4


@pytest.mark.long
def test_interleaved_gradings_give_the_same_reports() -> None:
    catalogue = shipped_exercises()

    def works() -> Iterator[Callable[[], Any]]:
        for exercise, content in islice(tables(3, 0.8), 24):
            body = GradeRequest.model_validate_json(content)
            known = catalogue[exercise]
            submission = body.submission(known.feedback)
            yield partial(grade, known, submission)

    async def all_in_turns() -> list[Any]:
        return await asyncio.gather(*(in_slices(work, give_way) for work in works()))

    assert asyncio.run(all_in_turns()) == [work() for work in works()]
