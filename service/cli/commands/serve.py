"""`dh-grader serve`: the service on this machine."""

import gc
from typing import Annotated

import typer

from service.cli.terminal import give_up
from service.settings import load_settings

commands = typer.Typer(add_completion=False)


@commands.command("serve")
def command(
    host: Annotated[
        str | None, typer.Option(help="The address to listen on; 0.0.0.0 for all. [127.0.0.1]")
    ] = None,
    port: Annotated[
        int | None, typer.Option(help="The port; 0 takes a free one. [8000]", show_default=False)
    ] = None,
    workers: Annotated[
        int | None, typer.Option(help="How many processes serve. [1]", show_default=False)
    ] = None,
) -> None:
    """Start the service; the environment variables DH_GRADER_… set it up."""
    settings = load_settings(host=host, port=port, workers=workers)
    # Until the application is up: what is loaded stays, so looking for garbage finds none.
    gc.disable()
    # Only here: the web framework is half of the program's weight, and grading needs none of it.
    from service.server.start import serve

    if not serve(settings):
        give_up(
            f"The service cannot listen on {settings.host}, port {settings.port}. Choose another "
            "with --host and --port, or with DH_GRADER_HOST and DH_GRADER_PORT."
        )
