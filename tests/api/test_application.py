"""Test the application as a whole, apart from its routes."""

import asyncio
import gc

from dh_grader.api.application import application
from dh_grader.catalogue import LateCatalogue, open_catalogue, shipped_folder


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


def test_the_exercises_are_compiled_one_by_one_after_the_start() -> None:
    catalogue = open_catalogue([shipped_folder()], reload=False)
    assert isinstance(catalogue, LateCatalogue)

    async def serve() -> None:
        app = application(catalogue)
        async with app.router.lifespan_context(app):
            # The first requests come between two exercises.
            assert next(catalogue.compile_one_by_one(), None) is not None
            await asyncio.sleep(0)
            assert next(catalogue.compile_one_by_one(), None) is not None
            while next(catalogue.compile_one_by_one(), None) is not None:
                await asyncio.sleep(0)

    asyncio.run(asyncio.wait_for(serve(), 60))


def test_the_service_may_end_before_all_exercises_are_compiled() -> None:
    catalogue = open_catalogue([shipped_folder()], reload=False)
    assert isinstance(catalogue, LateCatalogue)

    async def serve() -> None:
        app = application(catalogue)
        async with app.router.lifespan_context(app):
            await asyncio.sleep(0)

    asyncio.run(serve())
    assert next(catalogue.compile_one_by_one(), None) is not None
