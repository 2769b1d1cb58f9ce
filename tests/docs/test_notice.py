"""NOTICE names every third-party work in the repository, with its licence."""

import subprocess

import pytest

from tests.docs.notice import BUNDLED, ROOT, VENDORED, looks_vendored, notice

# The files with licences, and other files that belong to third-party works.
BESIDE = {each.text for each in VENDORED} | {
    BUNDLED,
    "LICENSE",
    "NOTICE",
    "service/dh_grader/api/swagger_ui/NOTICE",
    "service/dh_grader/web/static/vendor/three-0.185.1.README.md",
    # Types for our checks, written in this project.
    "service/dh_grader/web/static/vendor/three-0.185.1.module.min.d.ts",
    "service/dh_grader/web/static/vendor/three-0.185.1.orbit-controls.d.ts",
    "tests/docs/notice.py",
}


def test_the_notice_is_up_to_date() -> None:
    written = (ROOT / "NOTICE").read_text(encoding="utf-8")
    assert written == notice(), "run `python -m tests.docs.notice > NOTICE`"


def test_each_vendored_file_has_an_entry() -> None:
    listed = subprocess.run(["git", "ls-files"], cwd=ROOT, capture_output=True, check=False)
    files = [name for name in listed.stdout.decode().splitlines() if (ROOT / name).is_file()]
    if not files:
        pytest.skip("this is no clone of the repository")
    carried = {
        name
        for name in files
        if name.startswith(("service/", "exercises/", "tests/")) and looks_vendored(ROOT / name)
    }
    named = {file for each in VENDORED for file in each.files}
    assert named <= carried, "looks_vendored() finds less than it must"
    assert carried - named - BESIDE == set()


def test_each_entry_has_the_text_of_its_licence() -> None:
    phrases = {"MIT": "MIT License", "Apache-2.0": "Apache License", "MPL-2.0": "Mozilla Public"}
    phrases["BSD-3-Clause"] = "Redistribution and use in source and binary forms"
    phrases["BSD-2-Clause"] = "BSD 2-Clause License"
    for each in VENDORED:
        assert phrases[each.licence] in (ROOT / each.text).read_text(encoding="utf-8")
        assert all((ROOT / file).is_file() for file in each.files)
        assert all(each.version in file for file in each.files)
        # Files in the wheel are inside the package.
        assert each.shipped == each.text.startswith("service/")
