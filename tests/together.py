"""Run many small cases in one test, because each test costs more time than a small case."""

import inspect
from collections.abc import Callable, Iterable
from functools import wraps
from typing import Any

import pytest

SHOWN = 20


def together(
    names: str | tuple[str, ...], cases: Iterable[Any]
) -> Callable[[Callable[..., None]], Callable[..., None]]:
    """Run all test cases in one test, and report each failed case."""
    # Use this function like `pytest.mark.parametrize`. A case with several parameters is a tuple.
    # All cases share the fixtures, so no case may change them.
    parameters = (names,) if isinstance(names, str) else names
    each: list[tuple[Any, ...]] = [case if isinstance(names, tuple) else (case,) for case in cases]

    def decorate(test: Callable[..., None]) -> Callable[..., None]:
        @wraps(test)
        def tried(**fixtures: object) -> None:
            failures = []
            for values in each:
                try:
                    test(**fixtures, **dict(zip(parameters, values, strict=True)))
                except (Exception, pytest.fail.Exception) as error:  # noqa: BLE001 (it is raised below)
                    error.add_note(f"The case: {', '.join(map(repr, values)):.500}")
                    failures.append(error)
            if failures:
                message = f"{len(failures)} of {len(each)} cases failed"
                raise BaseExceptionGroup(message, failures[:SHOWN])

        assert each, "there is no case"
        signature = inspect.signature(test)
        fixtures = [one for name, one in signature.parameters.items() if name not in parameters]
        tried.__signature__ = signature.replace(parameters=fixtures)  # type: ignore[attr-defined]
        return tried

    return decorate
