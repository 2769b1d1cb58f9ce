"""Web pages of allowed origins can read the responses that refuse their requests."""

import pytest
from dh_grader.server.connections import cors_headers, origin_in

COURSE, OTHER = "https://course.example.edu", "https://other.example.edu"


@pytest.mark.parametrize(
    ("origins", "origin", "allowed"),
    [
        ((), COURSE, None),
        ((COURSE,), COURSE, COURSE),
        ((COURSE,), OTHER, None),
        ((COURSE,), "", COURSE),
        ((COURSE, OTHER), OTHER, OTHER),
        ((COURSE, OTHER), "", None),
        (("*",), OTHER, "*"),
    ],
)
def test_only_configured_origins_are_allowed(
    origins: tuple[str, ...], origin: str, allowed: str | None
) -> None:
    assert cors_headers(origins, origin).get("Access-Control-Allow-Origin") == allowed


@pytest.mark.parametrize(
    ("head", "origin"),
    [
        (b"GET / HTTP/1.1\r\norigin:  https://a.example \r\n\r\n", "https://a.example"),
        (b"GET / HTTP/1.1\r\nOrigin: https://a.exam", ""),
        (b"GET / HTTP/1.1\r\nX-Origin: https://a.example\r\n", ""),
        (b"", ""),
    ],
)
def test_the_origin_is_found_in_an_incomplete_head(head: bytes, origin: str) -> None:
    assert origin_in(head) == origin
