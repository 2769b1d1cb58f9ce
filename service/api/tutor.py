"""Who has the tutor's right: model solutions, the editor, the report on a class.

Until there are keys it goes by the machine: whoever asks from the machine that serves is the tutor,
unless a proxy stands in between, which brings in the students.
"""

from collections.abc import Callable
from http import HTTPStatus
from ipaddress import ip_address
from typing import Final
from urllib.parse import urlsplit

from fastapi import Request

from service.api.problems import ProblemError

TutorRight = Callable[[Request], bool]

# A proxy names whom it speaks for in one of these. One that does not still asks for its own host.
_OF_PROXIES: Final = ("forwarded", "x-forwarded-for", "x-forwarded-host", "x-real-ip", "via")


def tutor_right(solutions: bool | None) -> TutorRight:
    """The right as ``DH_GRADER_SOLUTIONS`` gives it: to all, to nobody, or at the machine itself.

    In no case to a page of another origin, which would ask with the tutor's own browser.
    """

    def is_tutor(request: Request) -> bool:
        if not _is_same_origin(request):
            return False
        return is_at_the_machine(request) if solutions is None else solutions

    return is_tutor


def require_tutor(request: Request, is_tutor: TutorRight) -> None:
    """Raises ProblemError where the request has no tutor's right."""
    if not is_tutor(request):
        raise ProblemError(
            HTTPStatus.FORBIDDEN,
            "Model solutions are for tutors, and this service does not show them. To have them "
            "shown to whoever can reach it, start it with DH_GRADER_SOLUTIONS=true; on the "
            "machine itself, use dh-grader exercises show ID --solution.",
            "solutions-off",
            "Model solutions are not shown here",
        )


def is_at_the_machine(request: Request) -> bool:
    """Whether the request was made on this machine, to this machine, and for nobody else.

    Both ends of the connection are on it, the client asks for it by a name of its own (a page of
    another name that leads here asks for that name), and no proxy stands in between.
    """
    server = request.scope.get("server") or ("",)
    client = request.scope.get("client") or ("",)
    asked = _host_name(request.headers.get("host", ""))
    return (
        _is_loopback(server[0])
        and _is_loopback(client[0])
        and (asked == "localhost" or _is_loopback(asked))
        and not any(name in request.headers for name in _OF_PROXIES)
    )


def _is_loopback(host: str) -> bool:
    try:
        return ip_address(host).is_loopback
    except ValueError:
        return False


def _host_name(netloc: str) -> str:
    try:
        return urlsplit(f"//{netloc}").hostname or ""
    except ValueError:
        return ""


def _is_same_origin(request: Request) -> bool:
    """Whether no page of another origin asks; programs name no origin."""
    origin = request.headers.get("origin")
    return origin is None or origin.partition("://")[2] == request.headers.get("host", "")
