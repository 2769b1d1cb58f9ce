"""Read column names and units from the comments of a script."""

from collections.abc import Mapping

import pytest
from dh_grader.catalogue import Exercise
from dh_grader.grading import Verdict
from dh_grader.grading.reading import PastedPreview, preview_pasted

from tests.grading.support.submitting import handed_in, part

CAPTION = r"""\caption{Parameters (mm)}
\begin{tabular}{cccc} a & $\alpha$ & d & $\theta$ \\ 400 & 0 & 0 & $q_1$ \\ 0 & 0 & 0 & $q_2$
\end{tabular}"""
HTML = """<table><caption>lengths in mm</caption>
<tr><th>a</th><th>alpha</th><th>d</th><th>theta</th></tr>
<tr><td>400</td><td>0</td><td>0</td><td>q1</td></tr></table>"""
ROWS = "[q1 400 300 90; q2 0 0 0; q3 0 0 0]"


@pytest.fixture
def arm(catalogue: Mapping[str, Exercise]) -> Exercise:
    return catalogue["rrrp"]


def first_row(shown: PastedPreview) -> list[str]:
    return [cell.text for cell in shown.rows[0]]


@pytest.mark.parametrize(
    "comment",
    [
        "% theta [deg], d [mm], a [mm], alpha [deg]",
        "# theta(deg) d(mm) a(mm) alpha(deg)",
        "// theta_deg | d/mm | a/mm | alpha/deg",
    ],
)
def test_a_comment_names_the_columns_and_their_units(comment: str, arm: Exercise) -> None:
    shown = preview_pasted(f"{comment}\nDH = {ROWS};", arm, "table")
    assert first_row(shown) == ["300/1000", "90deg", "400/1000", "q1"]


@pytest.mark.parametrize(
    "text",
    [
        "dh = {(* theta, d, a, alpha *) {q1, l1, l2, 0}, {q2, 0, l3, Pi}, {q3, l4, 0, 0}};",
        "{ /* theta, d, a, alpha */\n  {q1, l1, l2, 0},\n  {q2, 0, l3, Pi},\n  {q3, l4, 0, 0} }",
    ],
)
def test_a_comment_in_brackets_names_the_columns(text: str, arm: Exercise) -> None:
    assert first_row(preview_pasted(text, arm, "table")) == ["l2", "0", "l1", "q1"]


@pytest.mark.parametrize(
    "comment", ["% lengths in mm", "% angles in degrees", "# Winkel in Grad", "% [mm, deg]"]
)
def test_a_unit_without_columns_is_refused(comment: str, arm: Exercise) -> None:
    problem = preview_pasted(f"{comment}\nDH = {ROWS};", arm, "table").problem
    assert problem is not None
    assert problem.code == "text_around"


@pytest.mark.parametrize("comment", ["% angles in rad", "% in m", "% joint 1 turns by 90 deg"])
def test_other_comments_are_ignored(comment: str, arm: Exercise) -> None:
    shown = preview_pasted(f"{comment}\nDH = [0 0 0.4 q1; 0 0 0 q2];", arm, "table")
    assert first_row(shown) == ["0", "0", "0.4", "q1"]


def test_headers_in_the_table_count_more_than_a_comment(arm: Exercise) -> None:
    shown = preview_pasted(
        "#, d (mm), theta, a (mm), alpha (deg)\n1, 400, q1, 300, 90", arm, "table"
    )
    assert first_row(shown) == ["300/1000", "90deg", "400/1000", "q1"]


def test_a_unit_of_the_other_kind_is_refused(arm: Exercise) -> None:
    shown = preview_pasted(f"% theta [mm], d, a, alpha\nDH = {ROWS};", arm, "table")
    assert shown.problem is not None
    assert shown.problem.code == "header_unit"


@pytest.mark.parametrize(
    "text",
    [
        "% all dimensions in mm\nL(1) = Link('d', 135, 'a', 0, 'alpha', 0);",
        "# angles in degrees\nDHRobot([RevoluteDH(d=0.135, alpha=90), RevoluteDH(a=0.4)])",
        "a = [0, 400]  # mm\nalpha = [0, 0]\nd = [135, 0]\ntheta = [q1, q2]",
        CAPTION,
        HTML,
    ],
)
def test_a_unit_in_a_script_or_a_caption_is_refused(text: str, arm: Exercise) -> None:
    problem = preview_pasted(text, arm, "table").problem
    assert problem is not None
    assert problem.code == "text_around"
    graded = part(handed_in(arm, {"table": text}), "table")
    assert graded.verdict is Verdict.UNREADABLE
    assert [message.code for message in graded.feedback] == ["text_around"]


@pytest.mark.parametrize(
    "comment", ["% angles in degrees", "% limits in deg", "% all lengths in metres"]
)
def test_a_script_that_converts_its_angles_is_read(comment: str, arm: Exercise) -> None:
    script = f"{comment}\nL(1) = Link('d', 0.4, 'a', 0, 'alpha', deg2rad(90));"
    assert first_row(preview_pasted(script, arm, "table")) == ["0", "90deg", "0.4", "q1"]
