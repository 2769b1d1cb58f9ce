"""The benchmark's server answers the requests that are measured."""

import asyncio
import time

import pytest

from tests.benchmarks import server
from tests.guards import ANSWER


@pytest.mark.long
@pytest.mark.parametrize("workers", [1, 2])
def test_the_measured_server_answers(workers: int) -> None:
    with server.running_server(workers) as port:
        for path in (server.TRIVIAL, server.GRADE):
            requests = [server.request(path, server.tables(i)) for i in range(3)]
            deadline = time.perf_counter() + ANSWER
            assert asyncio.run(server.post_all(port, requests, deadline)) == len(requests)
