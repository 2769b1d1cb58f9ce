"""Headers and parameters of responses in the language of the reader."""

from collections.abc import Mapping
from http import HTTPStatus
from typing import Any, Final

from fastapi import Response

from service.api.http.language import LANGUAGE_FIELD
from service.translations import Language

_PARAMETER: Final = {
    "name": LANGUAGE_FIELD,
    "in": "query",
    "required": False,
    "description": "The language of sentences for people: `en`, `de`, `es`, `fr` or `zh`. Default: "
    "`Accept-Language`. A sentence without a translation is in English, and so is an answer in a "
    "language that the service does not have.",
    "schema": {"type": "string", "maxLength": 35},
}
# Caches keep an answer for each language.
_VARY: Final = {"Vary": "Accept-Language, Cookie"}


def in_languages(options: dict[str, Any]) -> dict[str, Any]:
    """Return FastAPI's arguments for a route that also has the query parameter ``lang``."""
    extra = options.get("openapi_extra", {})
    parameters = [*extra.get("parameters", ()), _PARAMETER]
    return {**options, "openapi_extra": {**extra, "parameters": parameters}}


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
