"""Test the application as a whole, apart from its routes."""

import asyncio
import gc

from service.api.application import application


def test_garbage_is_collected_while_it_serves() -> None:
    # This also holds if the process started with the collector off.
    async def serve() -> None:
        app = application({})
        async with app.router.lifespan_context(app):
            assert gc.isenabled()
            assert gc.get_freeze_count() > 0

    gc.disable()
    try:
        asyncio.run(serve())
    finally:
        gc.enable()
