"""`dh-grader serve`: run the service on this machine."""

import gc
from typing import Annotated

import typer

from service.cli.terminal import give_up
from service.settings import load_settings
from service.translations import say

commands = typer.Typer(add_completion=False)


@commands.command("serve")
def command(
    host: Annotated[
        str | None, typer.Option(help="The address to listen on; 0.0.0.0 for all. [127.0.0.1]")
    ] = None,
    port: Annotated[
        int | None, typer.Option(help="The port; 0 for a free one. [8000]", show_default=False)
    ] = None,
    workers: Annotated[
        int | None, typer.Option(help="The number of processes. [1]", show_default=False)
    ] = None,
) -> None:
    """Start the service. Configure it by environment variables DH_GRADER_…."""
    settings = load_settings(host=host, port=port, workers=workers)
    # Until the application has started: loading modules produces no garbage to search for.
    gc.disable()
    # Import here: the web framework is half of the program, and grading needs none of it.
    from service.server.start import serve

    if not serve(settings):
        give_up(
            say(
                "The service cannot listen on {host}, port {port}. Choose another with --host and "
                "--port, or with DH_GRADER_HOST and DH_GRADER_PORT.",
                host=settings.host,
                port=settings.port,
            )
        )
