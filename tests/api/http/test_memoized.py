import asyncio

from service.api.http.memoized import KEPT, Kept


def test_the_latest_results_are_kept_and_worked_out_once() -> None:
    worked: list[object] = []

    def work(key: object) -> bytes:
        worked.append(key)
        return str(key).encode()

    async def ask() -> None:
        kept = Kept()
        asked = [kept.of("first", lambda: work("first")) for _ in range(3)]
        assert await asyncio.gather(*asked) == [b"first"] * 3
        assert worked == ["first"]
        for i in range(KEPT):
            assert await kept.of(i, lambda: work(i)) == str(i).encode()  # noqa: B023 -- awaited here
        await kept.of(KEPT - 1, lambda: work("again"))
        assert len(worked) == 1 + KEPT
        await kept.of("first", lambda: work("first"))
        assert len(worked) == 2 + KEPT

    asyncio.run(ask())
