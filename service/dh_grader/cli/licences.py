"""`python -m dh_grader.cli.licences`: list the required packages with their licences.

The container image includes this list as a file.
"""

import re
import sys
from collections.abc import Iterator
from importlib.metadata import Distribution, PackageNotFoundError, distribution
from typing import Final

from dh_grader.regex import regex

_PROGRAM: Final = "dh-grader"
_LICENCE_FILE: Final = regex(r"(licen[cs]e|copying|notice|authors)[^/]*$", re.IGNORECASE)
_NAME: Final = regex(r"[A-Za-z0-9][A-Za-z0-9._-]*")
_CLASSIFIER: Final = "License :: "


def licences() -> Iterator[str]:
    """Yield a section for each package: its name, version, source, licence, and licence files."""
    for package in sorted(needed(_PROGRAM).values(), key=lambda each: each.name.lower()):
        yield f"{package.name} {package.version}"
        yield f"    licence: {licence_of(package)}"
        yield from (f"    {url}" for url in _urls(package))
        for name, text in _texts(package):
            yield f"\n    {name}:\n"
            yield from (f"    {line}".rstrip() for line in text.splitlines())
        yield f"\n{'-' * 80}\n"


def needed(name: str) -> dict[str, Distribution]:
    """Return the installed direct and indirect dependencies of a package, by name."""
    found: dict[str, Distribution] = {}
    waiting = [name]
    while waiting:
        for requirement in distribution(waiting.pop()).requires or ():
            # A missing package is for another platform, or for an extra that is not installed.
            match = _NAME.match(requirement)
            key = match[0].lower().replace("_", "-") if match else ""
            if key and key not in found:
                try:
                    found[key] = distribution(key)
                except PackageNotFoundError:
                    continue
                waiting.append(key)
    return found


def licence_of(package: Distribution) -> str:
    """Return the licence that the metadata of a package names."""
    named = (_all(package, "License-Expression") or _all(package, "License") or [""])[0].strip()
    # Some packages have the whole text there.
    if named and "\n" not in named:
        return named
    classified = [each for each in _all(package, "Classifier") if each.startswith(_CLASSIFIER)]
    return ", ".join(each.rpartition(" :: ")[2] for each in classified) or "see its files"


def _urls(package: Distribution) -> Iterator[str]:
    urls = [each.partition(",")[2].strip() for each in _all(package, "Project-URL")]
    yield from [*_all(package, "Home-page"), *urls][:1]


def _all(package: Distribution, field: str) -> list[str]:
    return package.metadata.get_all(field) or []


def _texts(package: Distribution) -> Iterator[tuple[str, str]]:
    for file in package.files or ():
        if ".dist-info" in str(file) and _LICENCE_FILE.search(file.name):
            yield file.name, file.read_text(encoding="utf-8")


if __name__ == "__main__":
    sys.stdout.writelines(f"{line}\n" for line in licences())
