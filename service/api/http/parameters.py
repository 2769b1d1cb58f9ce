"""Optional query parameters that several routes have, in the document and checked alike."""

from collections.abc import Mapping
from dataclasses import dataclass
from typing import Any

from fastapi import Depends, Request
from fastapi.exceptions import RequestValidationError
from pydantic import TypeAdapter, ValidationError


@dataclass(frozen=True)
class QueryParameter:
    """An optional query parameter; ``values`` accepts its values."""

    name: str
    description: str
    values: TypeAdapter[str]

    @property
    def documented(self) -> Mapping[str, Any]:
        """The parameter as in the OpenAPI document."""
        return {
            "name": self.name,
            "in": "query",
            "required": False,
            "description": self.description,
            "schema": self.values.json_schema(),
        }

    def check(self, request: Request) -> None:
        """Check the value in a request, if there is one. Raises RequestValidationError."""
        value = request.query_params.get(self.name)
        if value is None:
            return
        try:
            self.values.validate_python(value)
        except ValidationError as error:
            details = error.errors(include_url=False)
            raise RequestValidationError(
                [{**each, "loc": ("query", self.name)} for each in details]
            ) from error


def with_parameters(options: Mapping[str, Any], *parameters: QueryParameter) -> dict[str, Any]:
    """Return FastAPI's arguments for a route that also has these query parameters."""

    async def check(request: Request) -> None:
        for each in parameters:
            each.check(request)

    extra = options.get("openapi_extra", {})
    documented = [*extra.get("parameters", ()), *(each.documented for each in parameters)]
    return {
        **options,
        "openapi_extra": {**extra, "parameters": documented},
        "dependencies": [*options.get("dependencies", ()), Depends(check)],
    }
