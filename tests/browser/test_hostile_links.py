"""Pages treat the answers in a forged link as plain text."""

import base64
import json
from collections.abc import Callable

import pytest
from playwright.sync_api import expect

from tests.browser.fixtures import Visit
from tests.browser.hostile import PICTURE, SCRIPT, TEXTS
from tests.browser.steps import cells, open_exercise

Opening = Callable[..., Visit]

WATCH = "window.taken = []; window.stolen = (what) => taken.push(what);"


def packed(text: str) -> str:
    return base64.urlsafe_b64encode(text.encode()).decode().rstrip("=")


def row(kind: object, cells: object) -> dict[str, object]:
    return {"kind": kind, "cells": cells}


BAD_ROBOTS = [
    "", "%%%", "é", "A" * 70_000, packed("[" * 30_000), packed("{"), packed("null"), packed("[]"),
    packed('{"rows": {"length": 1}}'), packed('{"__proto__": {"rows": [1]}}'),
    *(packed(json.dumps({"rows": rows})) for rows in [
        [], "RP", [None], [1], [row("R", "abcd")], [row(["R"], ["0"] * 4)], [row("X", ["0"] * 4)],
        [row("R", ["0"] * 5)], [row("R", ["0", 0, None, {}])], [row("R", ["0"] * 4)] * 13,
    ]),
]  # fmt: skip
BAD_ANSWERS = [
    "", "%%%", "A" * 70_000, packed("[" * 30_000), packed("{"), packed("null"), packed("[]"),
    *(packed(json.dumps({"parts": parts})) for parts in [
        None, "x", [1], {"table": None}, {"table": {"cells": "abcd"}},
        {"table": {"cells": [1, {}]}}, {"table": {"cells": {"length": 9}}},
    ]),
]  # fmt: skip


@pytest.mark.campaign
def test_a_link_of_free_play_does_no_harm(visit: Opening, service: str) -> None:
    page = visit().page
    page.add_init_script(WATCH)
    for fragment in BAD_ROBOTS:
        page.goto(f"{service}/play#robot={fragment}")
        page.reload()
        # The robot of a first visit.
        expect(page.locator(".entry input")).to_have_count(24)
        expect(page.locator(".slider")).to_have_count(6)
    # A link of the right shape: every text is in its cell, and marked as unreadable.
    robot = {
        "convention": SCRIPT, "unit": ["degrees"], "__proto__": {"x": 1}, "constructor": PICTURE,
        "rows": [row("F", TEXTS[:4]), row("R", ["x" * 9000, *TEXTS[4:], "theta1"])],
    }  # fmt: skip
    page.goto(f"{service}/play#robot={packed(json.dumps(robot))}")
    page.reload()
    entries = page.locator(".entry input")
    expect(entries).to_have_count(8)
    assert [each.input_value() for each in entries.all()][:4] == TEXTS[:4]
    expect(page.locator("td.unread").first).to_be_visible()
    expect(page.locator(".told")).to_contain_text("Row 1, a")
    assert page.locator("dh-play").locator("script, [onerror], img, svg, iframe").count() == 0
    assert page.evaluate("taken") == []
    assert "#" not in page.url


@pytest.mark.campaign
def test_a_link_of_an_exercise_does_no_harm(visit: Opening, service: str) -> None:
    page = visit().page
    page.add_init_script(WATCH)
    for fragment in BAD_ANSWERS:
        open_exercise(page, service, "planar-rr", f"#answers={fragment}")
        page.reload()
        expect(cells(page).last).to_have_value("")
        expect(page.get_by_text("These answers came with the link.")).to_be_hidden()
    # Unknown parts and additional cells are ignored.
    one = {"cells": [PICTURE] * 50, "choice": SCRIPT}
    given = {"parts": {"__proto__": one, "constructor": one, "toString": one, "table": one}}
    open_exercise(page, service, "planar-rr", f"#answers={packed(json.dumps(given))}")
    page.reload()
    expect(cells(page).first).to_have_value(PICTURE)
    assert page.evaluate("({}).cells === undefined && taken.length === 0")
    assert page.locator("dh-exercise").locator("script, [onerror], svg, iframe").count() == 0
