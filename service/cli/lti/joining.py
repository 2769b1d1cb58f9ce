"""`dh-grader lti invite`, `allow` and `canvas`: how platforms join."""

import json
from datetime import UTC, datetime
from typing import Annotated

import typer

from service.attempts.storage.database import in_transaction
from service.cli.commands.attempts import database, encodable
from service.cli.terminal import give_up, stdout, tell
from service.lti.joining.invitations import LONGEST_DAYS, allow, invite
from service.lti.joining.tool_configuration import canvas_configuration
from service.lti.registrations import RegistrationError, unusable
from service.settings import load_settings
from service.translations import joined, say

Address = Annotated[
    str | None,
    typer.Option(help="This service: https://grader.example.edu \\[DH_GRADER_PUBLIC_URL]"),
]


def invite_platform(
    name: Annotated[str, typer.Argument(help="The platform in words.", callback=encodable)],
    address: Address = None,
    zone: Annotated[str, typer.Option(help="The time zone of its courses.")] = "UTC",
    days: Annotated[int, typer.Option(min=1, max=LONGEST_DAYS, help="How long it is valid.")] = 7,
    hold: Annotated[
        bool, typer.Option("--hold", help="The platform launches only after `lti allow`.")
    ] = False,
) -> None:
    """Make a link by which a platform registers itself, once. Keep it secret until then."""
    now, own = datetime.now(UTC), own_address(address)
    with database(create=True) as engine:
        try:
            link = in_transaction(
                engine,
                lambda it: invite(it, name[:200], own, zone, now, days=days, waits=hold),
            )
        except RegistrationError as error:
            give_up(error)
    stdout().print(link, soft_wrap=True)


def allow_platform(
    registration: Annotated[
        str, typer.Argument(help="The id of a registration, as list shows it.", callback=encodable)
    ],
) -> None:
    """Let a platform launch that has registered itself by an invitation with --hold."""
    with database(create=False) as engine:
        try:
            in_transaction(engine, lambda it: allow(it, registration))
        except RegistrationError as error:
            give_up(error)
    tell(say("Allowed."))


def canvas(
    address: Address = None,
    files: Annotated[
        bool, typer.Option("--files", help="Also grade files that students hand in at Canvas.")
    ] = False,
) -> None:
    """Print the JSON configuration for a developer key of Canvas."""
    own = own_address(address)
    if reason := unusable(own, local=True):
        give_up(joined(": ", ["address", reason]))
    typer.echo(json.dumps(canvas_configuration(own, files=files), indent=2))


def own_address(option: str | None) -> str:
    """Return the address of this service, from the option or the setting; exit without both."""
    found = option or load_settings().public_url
    if found is None:
        give_up(say("Give the address of this service: set DH_GRADER_PUBLIC_URL, or --address."))
    return found.rstrip("/")
