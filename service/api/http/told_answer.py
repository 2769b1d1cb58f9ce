"""Headers and parameters of responses in the language of the reader."""

from collections.abc import Mapping
from http import HTTPStatus
from typing import Annotated, Any, Final

from fastapi import Response
from pydantic import StringConstraints, TypeAdapter

from service.api.http.language import LANGUAGE_FIELD
from service.api.http.parameters import QueryParameter, with_parameters
from service.translations import Language

_LANGUAGE: Final = QueryParameter(
    LANGUAGE_FIELD,
    "The language of sentences for people: `en`, `de`, `es`, `fr` or `zh`. Default: "
    "`Accept-Language`. A sentence without a translation is in English, and so is an answer in a "
    "language that the service does not have.",
    TypeAdapter(Annotated[str, StringConstraints(max_length=35)]),
)
# Caches keep an answer for each language.
_VARY: Final = {"Vary": "Accept-Language, Cookie"}


def in_languages(options: dict[str, Any]) -> dict[str, Any]:
    """Return FastAPI's arguments for a route that also has the query parameter ``lang``."""
    return with_parameters(options, _LANGUAGE)


def language_headers(language: Language) -> dict[str, str]:
    """Return the headers ``Content-Language`` and ``Vary`` of a response in this language."""
    return {"Content-Language": language.tag, **_VARY}


def told_json(
    content: bytes | str,
    language: Language,
    status: HTTPStatus = HTTPStatus.OK,
    headers: Mapping[str, str] | None = None,
) -> Response:
    """Return a JSON response whose headers name its language."""
    named = {**language_headers(language), **(headers or {})}
    return Response(content, status, named, "application/json")
