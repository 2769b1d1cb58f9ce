"""Open the service in a frame of another site, without third-party cookies."""

import jwt
import pytest
from playwright.sync_api import Request, expect

from tests.browser.lti.conftest import Course
from tests.lti.platform import DL, deep_linking

# Return what the page has stored; Chromium mostly denies the access to a frame of another site.
KEPT = """() => {
  try { return JSON.stringify([{ ...sessionStorage }, { ...localStorage }]); } catch { return ""; }
}"""


def sent_keys(course: Course) -> set[str]:
    keys: set[str] = set()

    def note(request: Request) -> None:
        if sent := request.headers.get("authorization"):
            keys.add(sent.removeprefix("Bearer "))

    course.context.on("request", note)
    return keys


@pytest.mark.long
def test_a_learner_gets_in_by_the_storage_of_the_platform(course: Course) -> None:
    keys = sent_keys(course)
    page = course.opened("ada")
    frame = page.frame_locator("iframe")
    expect(frame.get_by_role("button", name="Hand in")).to_be_visible()
    [key] = keys
    # The key is neither in the address nor stored nor in the data of the page; no cookie is set.
    [inner] = [each for each in page.frames if each.name == "tool"]
    assert inner.url.startswith(f"{course.platform.tool}/lti/launch#/lti-")
    assert key not in inner.url
    assert inner.evaluate("document.querySelector('[data-key]')") is None
    assert key not in inner.evaluate(KEPT)
    assert course.context.cookies(course.platform.tool) == []


@pytest.mark.long
def test_without_storage_the_exercise_opens_in_a_window(course: Course) -> None:
    course.platform.storage = False
    keys = sent_keys(course)
    page = course.opened("ada")
    button = page.frame_locator("iframe").get_by_role("link", name="Open in a new window")
    with course.context.expect_page() as opened:
        button.click()
    expect(opened.value.get_by_role("button", name="Hand in")).to_be_visible()
    # Here Chromium always gives access to what is stored.
    [key] = keys
    assert key not in opened.value.evaluate(KEPT)


@pytest.mark.long
def test_a_tutor_opens_the_course_in_a_window(course: Course) -> None:
    page = course.opened("turing")
    button = page.frame_locator("iframe").get_by_role("button", name="Open the course")
    with course.context.expect_page() as opened:
        button.click()
    expect(opened.value.get_by_role("heading", name="Robotics 2026")).to_be_visible()


# Return the width of the picture of the chosen exercise, once it is there.
DRAWN = """async () => {
  const picture = document.querySelector("li:has(:checked) img");
  picture.scrollIntoView();
  if (!picture.complete) await new Promise((end) => picture.onload = picture.onerror = end);
  return picture.naturalWidth;
}"""
SIZES = {"wide": (1280, 900), "narrow": (375, 800)}


@pytest.mark.long
@pytest.mark.parametrize("size", ["wide", "narrow"])
def test_a_tutor_picks_exercises_in_a_frame(course: Course, axe: str, size: str) -> None:
    platform = course.platform
    platform.habits.append(deep_linking(f"{platform.address}/return?course=1"))
    page = course.opened("turing")
    width, height = SIZES[size]
    page.set_viewport_size({"width": width, "height": height})
    page.eval_on_selector("iframe", "(it, width) => { it.width = width }", width - 30)
    frame = page.frame_locator("iframe")
    frame.get_by_label("Find an exercise").fill("scara")
    frame.get_by_role("button", name="Search").click()
    expect(frame.locator('[name="exercise"][value="planar-rr"]')).to_have_count(0)
    box = frame.locator('[name="exercise"][value="scara"]')
    box.check()
    frame.locator('[name="points:scara"]').fill("7")
    [inner] = [each for each in page.frames if each.name == "tool"]
    assert inner.evaluate(DRAWN) > 0
    assert inner.evaluate("document.documentElement.scrollWidth <= innerWidth")
    inner.evaluate(f"() => {{ {axe} }}")
    found = inner.evaluate("axe.run(document, { resultTypes: ['violations'] })")
    assert [(each["id"], each["nodes"][0]["target"]) for each in found["violations"]] == []
    frame.get_by_label("Title").fill("Arms")
    frame.get_by_role("button", name="Add to the course").click()
    expect(frame.get_by_role("heading", name="Added")).to_be_visible()
    [text] = platform.returned
    [item] = jwt.decode(text, options={"verify_signature": False})[f"{DL}content_items"]
    assert (item["title"], item["custom"]) == ("Arms", {"exercise": "scara=7"})
