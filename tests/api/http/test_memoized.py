import asyncio

from dh_grader.api.http import MOST_RESULTS, MemoizedResults


def test_results_are_computed_once_and_the_last_ones_are_kept() -> None:
    worked: list[object] = []

    def work(key: object) -> bytes:
        worked.append(key)
        return str(key).encode()

    async def ask() -> None:
        kept = MemoizedResults()
        asked = [kept.of("first", lambda: work("first")) for _ in range(3)]
        assert await asyncio.gather(*asked) == [b"first"] * 3
        assert worked == ["first"]
        for i in range(MOST_RESULTS):
            assert await kept.of(i, lambda: work(i)) == str(i).encode()  # noqa: B023 -- awaited here
        await kept.of(MOST_RESULTS - 1, lambda: work("again"))
        assert len(worked) == 1 + MOST_RESULTS
        await kept.of("first", lambda: work("first"))
        assert len(worked) == 2 + MOST_RESULTS

    asyncio.run(ask())
