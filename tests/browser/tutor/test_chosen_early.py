"""The page uses files that a tutor chose before the page's scripts had arrived."""

from collections.abc import Callable
from pathlib import Path

import pytest
from playwright.sync_api import Page, Route, expect

from tests.browser.fixtures import Visit


def choose_before_scripts(
    page: Page, address: str, field: str, chosen: Path, *pressed: str
) -> None:
    """Choose a file and press buttons before the page's scripts arrive."""
    # A button has no effect before the scripts arrive.
    held: list[Route] = []
    is_chosen = False

    def hold(route: Route) -> None:
        if is_chosen:
            route.continue_()
        else:
            held.append(route)

    page.route("**/*.js*", hold)
    page.goto(address, wait_until="commit")
    page.get_by_label(field, exact=True).set_input_files(chosen)
    for text in pressed:
        page.get_by_text(text, exact=True).click()
    is_chosen = True
    assert held
    for route in held:
        route.continue_()


@pytest.mark.long
def test_a_robot_chosen_before_the_scripts_is_read(
    visit: Callable[..., Visit], service: str, tmp_path: Path
) -> None:
    chosen = tmp_path / "Our Arm.urdf"
    chosen.write_text('<robot name="arm"/>', "utf-8")
    page = visit().page
    address = f"{service}/tutor/editor"
    opened = "New exercise from a URDF file or a DH table …"
    choose_before_scripts(page, address, "File", chosen, opened, "Make the exercise")
    assert page.url == address
    expect(page.get_by_label("Exercise id")).to_have_value("our-arm")
    expect(page.get_by_label("or paste it")).to_have_value('<robot name="arm"/>')


@pytest.mark.long
def test_a_submission_chosen_before_the_scripts_is_graded(
    visit: Callable[..., Visit], service: str, tmp_path: Path
) -> None:
    chosen = tmp_path / "alice.json"
    chosen.write_text("{}", "utf-8")
    page = visit().page
    choose_before_scripts(page, f"{service}/tutor/class", "or files", chosen)
    expect(page.locator("#state")).to_contain_text("1 submission.")
