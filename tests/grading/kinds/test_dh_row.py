"""Grade answers that give the DH row of a transform."""

from collections.abc import Mapping
from typing import Any

import pytest
from dh_grader.catalogue import Exercise
from dh_grader.grading import Verdict

from tests.grading.support.exercise_texts import Make, all_codes, graded, one_part
from tests.grading.support.submitting import full_marks, handed_in, not_correct, part
from tests.together import together

Cells = dict[str, Any]

FIRST: Cells = {"a": "l", "alpha": "-90deg", "d": "h", "theta": "phi"}
FOURTH: Cells = {"a": 3, "alpha": 0, "d": 2, "theta": "pi/2"}
NONE: Cells = {"none": True}


@pytest.fixture
def conditions(catalogue: Mapping[str, Exercise]) -> Exercise:
    return catalogue["dh-conditions"]


@together(
    ("part_id", "answer"),
    [
        ("first", FIRST),
        ("first", {"rows": [FIRST]}),
        ("first", {**FIRST, "alpha": "3pi/2", "theta": "phi - 2pi"}),
        ("second", NONE),
        ("second", "none"),
        ("third", " None "),
        ("third", "none."),
        ("third", '"none"'),
        ("third", '{"none": true}'),
        ("second", {**NONE, "a": "", "alpha": None, "d": " "}),
        ("second", {**NONE, "why": "x1 is not perpendicular to z0"}),
        ("fourth", FOURTH),
        ("fourth", {"none": False, **FOURTH}),
        ("fourth", {"none": None, **FOURTH}),
        ("fourth", {"a": 3, "α": 0, "d_i": 2, "θ": "pi/2"}),
        ("fourth", [3, 0, 2, "pi/2"]),
        ("fourth", [[3, 0, 2, "pi/2"]]),
        ("fourth", "3, 0, 2, pi/2"),
        ("fourth", "a,alpha,d,theta\n3,0,2,pi/2"),
        ("fourth", "a=3, d=2, theta=90deg, alpha=0"),
        ("fourth", "a = 3; alpha = 0; d = 2; theta = pi/2"),
        ("fourth", "α: 0\nθ: 90°\na: 3\nd: 2\n"),
        ("fourth", r"$a_1 = 3,\ \alpha_1 = 0,\ d_1 = 2,\ \theta_1 = \frac{\pi}{2}$"),
        ("fourth", "a=3 alpha=0 d=2 theta=90deg"),
        ("first", "a=l, d=h, theta=phi and alpha=-90deg"),
        ("fourth", "(3, 0, 2, pi/2)"),
        ("fourth", "3; 0; 2; pi/2"),
        ("fourth", "3\n0\n2\npi/2"),
        ("fourth", "3 0 2 pi/2"),
        ("second", r"\text{none}"),
        ("second", r"$\mathrm{None}$"),
        ("third", "N/A"),
        ("third", "There is no row."),
        ("third", {"a": "n/a", "alpha": "", "d": None, "theta": "n/a"}),
    ],
)
def test_right_rows_get_full_marks(part_id: str, answer: object, conditions: Exercise) -> None:
    report = part(handed_in(conditions, {part_id: answer}), part_id)
    assert full_marks(report), report
    assert [row.label for row in report.rows] == ["1"]


@pytest.mark.parametrize(
    ("part_id", "answer", "code"),
    [
        ("first", NONE, "dh_row_exists"),
        ("second", {"a": "l", "alpha": 0, "d": "h", "theta": "phi"}, "dh_not_perpendicular"),
        ("third", {"a": "l", "alpha": "phi", "d": "h", "theta": 0}, "dh_not_intersecting"),
    ],
)
def test_a_row_instead_of_none_and_none_instead_of_a_row(
    part_id: str, answer: object, code: str, conditions: Exercise
) -> None:
    report = part(handed_in(conditions, {part_id: answer}), part_id)
    assert (report.verdict, report.points) == (Verdict.INCORRECT, 0)
    assert [message.code for message in report.rows[0].feedback] == [code]


@pytest.mark.parametrize(
    ("cells", "blamed", "codes"),
    [
        ({"a": 2, "d": 3}, {"a", "d"}, {"exchanged_parameters"}),
        ({"alpha": "pi/2", "theta": 0}, {"alpha", "theta"}, {"exchanged_parameters"}),
        ({"a": -3}, {"a"}, {"sign"}),
        ({"theta": "-90deg"}, {"theta"}, {"sign"}),
        ({"theta": "90"}, {"theta"}, {"degrees_as_radians"}),
        ({"d": "2.5"}, {"d"}, {"value"}),
        ({"d": "(2"}, {"d"}, {"unbalanced_bracket"}),
    ],
)
def test_a_wrong_cell_affects_only_itself(
    cells: Cells, blamed: set[str], codes: set[str], conditions: Exercise
) -> None:
    report = part(handed_in(conditions, {"fourth": FOURTH | cells}), "fourth")
    assert {cell for _, cell in not_correct(report)} == blamed
    # a, d and theta are worth a third of the points each; alpha is 0.
    assert report.points == pytest.approx(6 * (3 - len(blamed)) / 3, abs=1e-5)
    assert codes <= all_codes(report) <= codes | {"sign", "quarter_turn"}


@pytest.mark.parametrize(
    "answer", [[], 1, "", "no idea", {"none": "yes"}, {"rows": [FIRST, FIRST]}, {"rows": 3}, [1, 2]]
)
def test_an_answer_of_another_shape_is_unreadable(answer: object, conditions: Exercise) -> None:
    report = part(handed_in(conditions, {"first": answer}), "first")
    assert report.points == 0
    assert report.verdict in (Verdict.UNREADABLE, Verdict.MISSING)


@pytest.mark.parametrize("part_id", ["second", "fourth"])
@pytest.mark.parametrize(
    "answer",
    [
        {**NONE, **FOURTH},
        {**NONE, "a": 0},
        {**NONE, "θ": "phi"},
        {**NONE, "a": "", "alpha (deg)": 90},
        {**NONE, "rows": [FOURTH]},
        {"none": "yes", **FOURTH},
    ],
)
def test_none_with_a_row_contradicts_itself(
    part_id: str, answer: object, conditions: Exercise
) -> None:
    report = part(handed_in(conditions, {part_id: answer}), part_id)
    assert (report.verdict, report.points) == (Verdict.UNREADABLE, 0)
    assert all_codes(report) == {"contradiction"}


@pytest.mark.parametrize("text", ["no", "-", "impossible", "3, 0, 2", "3 0 2", "3,0\n2,1"])
def test_text_without_a_row_gets_a_message_on_rows(text: str, conditions: Exercise) -> None:
    report = part(handed_in(conditions, {"fourth": text}), "fourth")
    assert (report.verdict, all_codes(report)) == (Verdict.UNREADABLE, {"wrong_shape"})
    [message] = report.feedback
    assert "One row" in message.message
    assert "none" in message.message
    assert "table" not in message.message


MODIFIED = one_part(
    "dh_row",
    """convention = "modified"
transform = [
    ["cos(phi)", "-sin(phi)", "0", "l"],
    ["0", "0", "1", "k"],
    ["-sin(phi)", "-cos(phi)", "0", "0"],
    ["0", "0", "0", "1"],
]""",
)


def test_a_modified_row_is_right(make_exercise: Make) -> None:
    # The transform is Rot_x(−90°) Trans_x(l) Rot_z(φ) Trans_z(k), multiplied out by hand.
    exercise = make_exercise(MODIFIED)
    row = {"a": "l", "alpha": "-pi/2", "d": "k", "theta": "phi"}
    assert full_marks(graded(exercise, row))
    assert all_codes(graded(exercise, "none")) == {"dh_row_exists"}


def test_a_row_of_the_other_convention_is_named(make_exercise: Make) -> None:
    # A turn about z and a shift along x form a DH row in both conventions.
    exercise = make_exercise(
        one_part(
            "dh_row",
            'transform = [["0", "-1", "0", "0"], ["1", "0", "0", "l"], ["0", "0", "1", "0"], '
            '["0", "0", "0", "1"]]',
        )
    )
    assert full_marks(graded(exercise, {"a": "l", "alpha": 0, "d": 0, "theta": "pi/2"}))
    inverse = {"a": "-l", "alpha": 0, "d": 0, "theta": "-pi/2"}
    assert all_codes(graded(exercise, inverse)) >= {"sign"}


def test_an_unreadable_named_cell_has_its_span(conditions: Exercise) -> None:
    text = "a = 3, d = 2 + foo, theta = 90deg, alpha = 0"
    report = part(handed_in(conditions, {"fourth": text}), "fourth")
    assert not_correct(report) == {("1", "d"): Verdict.UNREADABLE}
    [message] = report.rows[0].cells[2].feedback
    assert message.span is not None
    assert text[slice(*message.span)] == "foo"


def test_an_unnamed_cell_is_missing(conditions: Exercise) -> None:
    report = part(handed_in(conditions, {"fourth": "a=3, theta=pi/2"}), "fourth")
    assert not_correct(report) == {
        ("1", "alpha"): Verdict.MISSING,
        ("1", "d"): Verdict.MISSING,
    }


@pytest.mark.parametrize(
    "text", ["a=3, a=2, d=0, theta=0", "b=3, d=2", "3 - 2 pi", "-", "x: 3, alpha: 0", "(3)(0)"]
)
def test_other_texts_are_not_rows(text: str, conditions: Exercise) -> None:
    report = part(handed_in(conditions, {"fourth": text}), "fourth")
    assert report.verdict is Verdict.UNREADABLE


def test_a_message_without_joints_does_not_mention_home(conditions: Exercise) -> None:
    report = part(handed_in(conditions, {"fourth": "3, 0, 2, 0"}), "fourth")
    [message] = report.rows[0].cells[3].feedback
    assert message.code == "quarter_turn"
    assert "home" not in message.message
