"""A small run of `python -m tests.lti.load.rush`."""

import asyncio
from time import process_time

import httpx
import pytest

from tests.lti.conftest import Tool
from tests.lti.load.rush import BUDGET, rush


@pytest.mark.long
def test_a_class_opens_its_exercise_at_once(tool: Tool) -> None:
    # The measured processor time includes that of the platform and of the browsers.
    users = [f"u{i}" for i in range(10)]
    mounts = {tool.platform.tool: httpx.ASGITransport(tool.app)}
    tool.launch("ada")
    before = process_time()
    told = asyncio.run(rush(tool.platform, users, 0, is_new=False, mounts=mounts))
    cost = (process_time() - before) / len(users)
    assert told.failures == []
    assert len(told.waits) == len(users)
    assert tool.counts()["lti_learners"] == len(users) + 1
    assert cost < BUDGET
