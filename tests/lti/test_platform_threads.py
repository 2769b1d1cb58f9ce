"""Work that waits for platforms has threads of its own."""

import asyncio
import threading

import pytest
from dh_grader import lti as platform_threads
from dh_grader.lti import PlatformThreads

from tests.guards import ANSWER


def test_a_slow_platform_leaves_threads_for_others_and_for_other_work() -> None:
    over, names = threading.Event(), []

    def slow() -> str:
        names.append(threading.current_thread().name)
        over.wait(ANSWER)
        return "slow"

    async def run() -> list[str]:
        threads = PlatformThreads()
        held = [asyncio.ensure_future(threads.run("slow", slow)) for _ in range(100)]
        async with asyncio.timeout(ANSWER):
            assert await threads.run("other", lambda: "quick") == "quick"
            # The threads of everything else.
            assert await asyncio.to_thread(lambda: "graded") == "graded"
        assert len(names) == platform_threads._MOST_EACH
        over.set()
        found = await asyncio.gather(*held)
        threads.close()
        return found

    assert asyncio.run(run()) == ["slow"] * 100
    assert all(name.startswith("lti-platform") for name in names)


def test_a_caller_that_gives_up_keeps_its_turn_until_the_work_ends() -> None:
    over, started = threading.Event(), []

    def slow() -> None:
        started.append(1)
        over.wait(ANSWER)

    async def run() -> None:
        threads = PlatformThreads()
        most = platform_threads._MOST_EACH
        held = [asyncio.ensure_future(threads.run("slow", slow)) for _ in range(2 * most)]
        while len(started) < most:
            await asyncio.sleep(0.001)
        for each in held[:most]:
            each.cancel()
        await asyncio.wait(held[:most])
        await asyncio.sleep(0.05)
        assert len(started) == most
        over.set()
        await asyncio.gather(*held[most:])
        assert len(started) == 2 * most
        threads.close()

    asyncio.run(run())


def test_the_error_of_the_work_reaches_the_caller() -> None:
    def failing() -> None:
        raise ValueError("no")

    with pytest.raises(ValueError, match="no"):
        asyncio.run(PlatformThreads().run("a", failing))
