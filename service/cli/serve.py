"""`dh-grader serve`: the service on this machine."""

from typing import Annotated

import typer

from service.catalogue import open_catalogue
from service.settings import load_settings


def command(
    host: Annotated[
        str | None, typer.Option(help="The address to listen on; 0.0.0.0 for all. [127.0.0.1]")
    ] = None,
    port: Annotated[
        int | None, typer.Option(min=0, max=65535, help="The port; 0 takes a free one. [8000]")
    ] = None,
) -> None:
    """Start the service; the environment variables DH_GRADER_… set it up."""
    settings = load_settings()
    catalogue = open_catalogue(settings.exercises_dir, reload=settings.reload_exercises)
    # Only here: the web framework is half of the program's weight, and grading needs none of it.
    import uvicorn

    from service.api.application import application

    uvicorn.run(
        application(
            catalogue,
            settings.cors_origins,
            solutions=settings.solutions,
            feedback=settings.feedback,
        ),
        host=settings.host if host is None else host,
        port=settings.port if port is None else port,
        log_level=settings.log_level,
        server_header=False,
    )
