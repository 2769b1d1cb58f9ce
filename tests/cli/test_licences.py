"""Test the list of installed packages and their licences."""

import re
from importlib.metadata import PackageNotFoundError, distribution
from pathlib import Path

from dh_grader.cli.licences import licence_of, licences, needed

LOCK = (Path(__file__).parents[2] / "requirements.lock").read_text(encoding="utf-8")


def test_every_locked_package_that_is_installed_is_listed_with_its_licence() -> None:
    locked = set(re.findall(r"^([a-z0-9-]+)(?:\[[a-z0-9,-]+\])?==", LOCK, re.MULTILINE))
    installed = set()
    for name in locked:
        try:
            distribution(name)
        except PackageNotFoundError:  # of another platform
            continue
        installed.add(name)
    listed = needed("dh-grader")
    assert len(installed) > 20
    assert installed <= listed.keys()
    unclear = {name for name, each in listed.items() if licence_of(each) == "see its files"}
    text = "\n".join(licences())
    for name, package in listed.items():
        assert f"{package.name} {package.version}\n" in text
        has_file = any("licen" in str(file).lower() for file in package.files or ())
        assert has_file or name not in unclear


def test_the_list_includes_the_texts_of_licences() -> None:
    text = "\n".join(licences())
    assert "Permission is hereby granted, free of charge" in text
    assert "Redistributions of source code must retain" in text
