"""A student solves exercises in a real browser with a real service."""

import re
import statistics
from collections.abc import Callable, Mapping

import pytest
from dh_grader.catalogue import Exercise
from playwright.sync_api import Locator, Page, expect

from tests.browser.fixtures import Visit
from tests.browser.steps import answer, cells, open_exercise, paste, right_answers
from tests.samples import one_in

Opening = Callable[..., Visit]

# They have the answer kinds that the four core exercises lack.
OTHER_KINDS = ("dh-conditions", "planar-rpr-poe", "simple-twist", "spherical-wrist")
CLIPBOARD = ["clipboard-read", "clipboard-write"]
IS_FOCUSED = "each => each.matches(':focus')"
TABLE = ["l2", "0", "l1", "q1", "l3", "pi", "0", "q2", "0", "0", "l4", "q3", "0", "0", "q4", "0"]
WRONG_ALPHA = 5
# The same table from a spreadsheet, LaTeX, MATLAB and Markdown. The headers name the columns.
PASTED = {
    "spreadsheet": "a\talpha [deg]\td\ttheta\n"
    "l2\t0\tl1\tq1\nl3\t180\t0\tq2\n0\t0\tl4\tq3\n0\t0\tq4\t0\n",
    "LaTeX": r"""\begin{tabular}{|c|c|c|c|c|} \hline
        $i$ & $a_i$ & $\alpha_i$ & $d_i$ & $\theta_i$ \\ \hline
        1 & $l_2$ & 0 & $l_1$ & $\theta_1^*$ \\ 2 & $l_3$ & $\pi$ & 0 & $\theta_2^*$ \\
        3 & 0 & 0 & $l_4$ & $\theta_3^*$ \\ 4 & 0 & 0 & $q_4$ & 0 \\ \hline
        \end{tabular}""",
    "MATLAB": "DH = [l2 0 l1 q1; l3 pi 0 q2; 0 0 l4 q3; 0 0 q4 0];",
    "Markdown": "| d | a | alpha | theta |\n|---|---|---|---|\n| l1 | l2 | 0 | q1 |\n"
    "| 0 | l3 | 180° | q2 |\n| l4 | 0 | 0 | q3 |\n| q4 | 0 | 0 | 0 |",
}  # fmt: skip

# Resolves as soon as more than ``count`` answers were shown; the test's time limit is the guard.
SHOWN = """(count) => new Promise((done) => {
  const look = () => (waits.length > count ? done() : setTimeout(look, 2));
  look();
})"""


def values(part: Locator) -> list[str]:
    return [each.input_value() for each in part.all()]


def total(page: Page) -> Locator:
    return page.locator(".total")


# The first exercise has all answer kinds of the others.
@pytest.mark.parametrize(
    "exercise",
    [
        pytest.param("spatial-rrr", marks=pytest.mark.long),
        "planar-rrr",
        pytest.param("rrrp", marks=pytest.mark.long),
    ],
)
def test_an_exercise_is_solved_by_keyboard(
    visit: Opening, service: str, catalogue: Mapping[str, Exercise], exercise: str
) -> None:
    page = visit(permissions=CLIPBOARD).page
    open_exercise(page, service, exercise)
    answers = right_answers(catalogue[exercise])
    page.get_by_role("link", name="Skip to the content").focus()
    page.keyboard.press("Enter")
    for part, spec in enumerate(catalogue[exercise].parts):
        # Press Tab until the first cell of the part has the focus.
        while not cells(page, part).first.evaluate(IS_FOCUSED):
            page.keyboard.press("Tab")
        answer(page, spec, part, answers[spec.id])
    page.get_by_role("button", name="Check").focus()
    page.keyboard.press("Enter")
    points = sum(part.points for part in catalogue[exercise].parts)
    expect(total(page)).to_have_text(f"{points:g} / {points:g} points")
    count = page.locator("td[data-verdict=correct]").count()
    assert count == sum(map(len, answers.values()))


@pytest.mark.long
@pytest.mark.parametrize("name", one_in(4, OTHER_KINDS))
def test_every_kind_of_answer_has_its_input(
    visit: Opening, service: str, catalogue: Mapping[str, Exercise], name: str
) -> None:
    page = visit(permissions=CLIPBOARD).page
    open_exercise(page, service, name)
    exercise = catalogue[name]
    for part, spec in enumerate(exercise.parts):
        texts = right_answers(exercise)[spec.id]
        if not texts:
            page.locator(".part").nth(part).locator("select").select_option("none")
            continue
        cells(page, part).first.focus()
        answer(page, spec, part, texts)
    page.get_by_role("button", name="Check").click()
    points = sum(part.points for part in exercise.parts)
    expect(total(page)).to_have_text(f"{points:g} / {points:g} points")


@pytest.mark.long
def test_a_table_in_four_formats_fills_the_grid(visit: Opening, service: str) -> None:
    opened = visit(permissions=CLIPBOARD)
    page = opened.page
    open_exercise(page, service, "rrrp")
    table = cells(page)
    for text in PASTED.values():
        table.nth(6).focus()
        paste(page, text)
        expect(table.nth(14)).to_have_value(re.compile("q_?4"))
        page.keyboard.press("Control+Enter")
        expect(page.locator(".part").first.locator(".badge").first).to_have_text("correct")
        page.keyboard.press("Control+Z")
        expect(table.nth(14)).to_have_value("")
    # A text that does not fit stays in one cell, with a message.
    paste(page, "1\t2\t3\t4\t5\t6\n7\t8\t9\t0\t1\t2")
    expect(page.locator(".reading").first).to_contain_text("Not read as a table")
    # A single matrix fills the matrix of the cursor.
    open_exercise(page, service, "spatial-rrr")
    page.get_by_role("tab", name="A2").click()
    cells(page, 1).nth(20).focus()
    paste(page, "[c2 -s2 0 L1*c2; s2 c2 0 L1*s2; 0 0 1 0; 0 0 0 1]")
    expect(cells(page, 1).nth(16)).to_have_value("c2")
    assert values(cells(page, 1))[16:20] == ["c2", "-s2", "0", "L1*c2"]


@pytest.mark.long
def test_answers_are_previewed_marked_saved_and_shared(
    visit: Opening, service: str, catalogue: Mapping[str, Exercise]
) -> None:
    page = visit(permissions=CLIPBOARD).page
    open_exercise(page, service, "rrrp")
    table = cells(page)
    shown = page.locator(".part").first.locator(".shown")

    # The keyboard of a spreadsheet.
    table.first.focus()
    page.keyboard.insert_text("l2")
    page.keyboard.press("Enter")
    page.keyboard.insert_text("l3")
    page.keyboard.press("ArrowRight")
    expect(table.nth(5)).to_be_focused()
    page.keyboard.insert_text("sin(pi/2")
    expect(shown.nth(5).get_by_role("button")).to_have_text("Write → sin(pi/2)")
    expect(table.nth(5)).to_have_attribute("aria-invalid", "true")
    assert page.locator(".echo u").all_inner_texts() == ["("]
    page.keyboard.press("ArrowUp")
    expect(table.nth(1)).to_be_focused()

    # A click on the repair writes it, and Ctrl+Z restores the text.
    shown.nth(5).get_by_role("button").click()
    expect(table.nth(5)).to_have_value("sin(pi/2)")
    page.keyboard.press("Control+Z")
    expect(table.nth(5)).to_have_value("sin(pi/2")
    page.keyboard.press("Control+Shift+Z")
    expect(table.nth(5)).to_have_value("sin(pi/2)")
    expect(shown.nth(5).locator("msub, mfrac")).to_have_count(1)

    # One wrong cell in a row; the others are right.
    table.first.focus()
    page.keyboard.press("Control+A")
    for i, text in enumerate(TABLE):
        table.nth(i).fill("pi/2" if i == WRONG_ALPHA else text)
    page.get_by_role("button", name="Check").click()
    rows = page.locator(".part").first.locator("tbody tr:not(.notes)")
    expect(rows.nth(1)).to_have_attribute("data-verdict", re.compile("partial|incorrect"))
    expect(page.locator("td[data-verdict=incorrect] .sign").first).to_contain_text("✗")
    expect(page.locator(".notes:not([hidden]) li").first).to_contain_text("α")
    assert rows.first.get_attribute("data-verdict") == "correct"
    wrong = page.locator("td[data-verdict=incorrect] input")
    expect(wrong).to_have_count(1)
    expect(wrong).to_have_attribute("aria-label", "alpha, link twist, row 2: incorrect")
    expect(page.get_by_role("status").last).to_contain_text("Denavit-Hartenberg table: partial")

    # A change removes the mark of the cell.
    wrong.fill("pi/2 ")
    expect(page.locator("td[data-verdict=incorrect]")).to_have_count(0)

    # A reload keeps the answers. A link contains them, but never sends them to a server.
    expect(page.locator(".saved")).to_have_text("Saved in this browser")
    page.reload()
    expect(cells(page).nth(4)).to_have_value("l3")
    page.get_by_role("button", name="Copy link").click()
    expect(page.locator(".saved")).to_contain_text("Link copied")
    link = page.evaluate("navigator.clipboard.readText()")
    friend = visit()
    friend.page.goto(link)
    expect(cells(friend.page).nth(4)).to_have_value("l3")
    assert values(cells(friend.page)) == values(cells(page))
    sent = [url.partition("#")[0] for url in friend.requests]
    assert [url for url in sent if "answers" in url] == []

    page.get_by_role("button", name="Clear").click()
    expect(cells(page).nth(4)).to_have_value("")
    page.keyboard.press("Control+Z")
    expect(cells(page).nth(4)).to_have_value("l3")


@pytest.mark.long
def test_a_preview_follows_each_key_at_once(
    visit: Opening, service: str, figure: Callable[[str], None]
) -> None:
    page = visit().page
    open_exercise(page, service, "stanford-arm")
    cells(page).first.focus()
    page.evaluate(
        """() => {
          window.waits = [];
          const root = document.querySelector("dh-exercise").shadowRoot;
          const input = root.querySelector(".part input");
          let at = 0;
          input.addEventListener("input", () => (at = performance.now()));
          const observer = new MutationObserver(() => waits.push(performance.now() - at));
          observer.observe(root.querySelector(".part .shown"), { childList: true });
        }"""
    )
    text = "sin(theta1)*cos(theta2)"
    for i, key in enumerate(text):
        page.keyboard.type(key)
        page.evaluate(SHOWN, i)
    waits = sorted(page.evaluate("waits"))
    p95 = statistics.quantiles(waits, n=20)[-1]
    figure(f"keystroke to preview: {statistics.median(waits):.0f} ms, p95 {p95:.0f} ms")
    # Ten times the slowest run on a busy machine.
    assert p95 < 4000


@pytest.mark.campaign
def test_without_the_service_the_answers_stay(visit: Opening, service: str) -> None:
    opened = visit()
    page = opened.page
    open_exercise(page, service, "rrrp")
    page.context.set_offline(True)
    cells(page).first.fill("l2")
    expect(page.locator(".trouble-line")).to_contain_text("saved in this browser")
    page.context.set_offline(False)
    expect(page.locator(".shown").first.locator("math")).to_be_visible()
    expect(page.locator(".trouble-line")).to_be_hidden()
    page.reload()
    expect(cells(page).first).to_have_value("l2")
    # These are the browser's complaints about failed requests.
    assert opened.complaints
    opened.complaints.clear()
