"""The application as a whole, beside its routes."""

import asyncio
import gc

from service.api.application import application


def test_garbage_is_collected_while_it_serves() -> None:
    """Also in a process that has collected none while it started."""

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
