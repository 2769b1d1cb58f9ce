import asyncio
from collections.abc import Awaitable, Callable, Iterator
from typing import Any

import pytest
from dh_grader.client import AsyncGraderClient, GraderClient, Retries

# A call of a method on a sync or async client.
Use = Callable[[Any], Any]
# Makes a client for an address with further options, and applies a Use to it.
Using = Callable[..., Any]

QUICK = Retries(number=2, first_wait=0.001, longest_wait=5.0)


def synchronous(address: str, use: Use, **options: Any) -> Any:
    with GraderClient(address, **{"retries": QUICK} | options) as client:
        found = use(client)
        return list(found) if isinstance(found, Iterator) else found


def asynchronous(address: str, use: Use, **options: Any) -> Any:
    async def used() -> Any:
        async with AsyncGraderClient(address, **{"retries": QUICK} | options) as client:
            found = use(client)
            if isinstance(found, Awaitable):
                return await found
            return [each async for each in found]

    return asyncio.run(used())


@pytest.fixture(params=[synchronous, asynchronous], ids=["sync", "async"])
def using(request: pytest.FixtureRequest) -> Using:
    # `using(address, lambda client: …)` calls a function with a client, sync or async.
    use: Using = request.param
    return use
