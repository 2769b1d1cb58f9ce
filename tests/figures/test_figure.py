"""The figures of all exercises are legible and contain no answer."""

import re
import xml.etree.ElementTree as ET
from collections.abc import Callable
from dataclasses import replace
from functools import cache
from itertools import combinations, product
from pathlib import Path
from typing import Final

import numpy as np
import pytest
from dh_grader.catalogue import Exercise
from dh_grader.catalogue.robot import Robot
from dh_grader.catalogue.schema import ViewSpec
from dh_grader.figures import default_view, exercise_figure, reference_figure
from dh_grader.figures.drawing import Theme
from dh_grader.figures.mechanism import (
    JOINT_LENGTH,
    View,
    drawing_numbers,
    given_frames,
    mechanism_of,
)
from dh_grader.kinematics import Numbers

from tests.browser.fixtures import Visit
from tests.shipped import shipped_exercises

DOCS = Path(__file__).parents[2] / "docs"
SVG = "{http://www.w3.org/2000/svg}"
SHIPPED = {
    name: exercise
    for name, exercise in shipped_exercises().items()
    if exercise.reference is not None
}
TABLES = [name for name, exercise in SHIPPED.items() if isinstance(exercise.reference, Robot)]
FRAMED = ("stanford-arm", "baxter-left-arm")
GREEK = str.maketrans({"θ": "theta", "α": "alpha"})


@cache
def drawn(name: str) -> str:
    return exercise_figure(SHIPPED[name])


def texts(svg: str) -> list[str]:
    """Return the texts of a figure, with Greek letters spelled out, such as theta1."""
    found = ET.fromstring(svg).iter(f"{SVG}text")
    return ["".join(each.itertext()).translate(GREEK) for each in found]


def labels(svg: str) -> set[str]:
    return {part for text in texts(svg) for part in re.split(r" \+ |, ", text)}


# JavaScript: all pairs of texts in a figure whose boxes overlap, and all texts beyond its edge.
MISPLACED = """[...document.querySelectorAll('svg')].flatMap(svg => {
    const edge = svg.getBoundingClientRect(), title = svg.querySelector('title').textContent
    const texts = [...svg.querySelectorAll('text')]
        .map(each => [each.textContent, each.getBoundingClientRect()])
    return texts.flatMap(([text, box], i) => [
        ...(box.left < edge.left || box.right > edge.right || box.top < edge.top ||
            box.bottom > edge.bottom ? [[title, text, 'edge']] : []),
        ...texts.slice(0, i)
            .filter(([, its]) => box.left < its.right && its.left < box.right &&
                box.top + 4 < its.bottom - 4 && its.top + 4 < box.bottom - 4)
            .map(([other]) => [title, text, other])
    ])
})"""


@pytest.mark.long
def test_no_labels_overlap_in_a_browser(visit: Callable[..., Visit], tmp_path: Path) -> None:
    # A text's box is as high as the font; its upper and lower 4 pixels are empty.
    shown = [*map(drawn, SHIPPED), *(reference_figure(SHIPPED[name]) for name in FRAMED)]
    file = tmp_path / "figures.html"
    file.write_text("<!doctype html><meta charset=utf-8>" + "".join(shown), encoding="utf-8")
    page = visit().page
    page.goto(file.as_uri())
    assert page.locator("svg").count() == len(shown)
    assert page.evaluate(MISPLACED) == []
    assert page.locator("text").count() > 100


# A phone that is 390 pixels wide shows a figure in this room (`tests/browser/figures`).
PHONE: Final = (340, 384)


@pytest.mark.long
@pytest.mark.parametrize("name", SHIPPED)
def test_a_figure_is_legible_on_a_phone(name: str) -> None:
    # All letters, indices included, are at least 12 CSS pixels high.
    root = ET.fromstring(drawn(name))
    _, _, width, height = map(float, root.attrib["viewBox"].split())
    sizes = map(float, re.findall(r"font(?:-size)?:[a-z ]*([\d.]+)px", drawn(name)))
    assert min(sizes) * min(PHONE[0] / width, PHONE[1] / height) >= 12


@pytest.mark.sampled(4)
@pytest.mark.parametrize("name", SHIPPED)
def test_no_labels_overlap(name: str) -> None:
    # Letters are assumed to be half as wide as high, and lines 11 pixels high.
    boxes = []
    for text in ET.fromstring(drawn(name)).iter(f"{SVG}text"):
        size = 13 if "number" in text.attrib["class"] else 17
        parts = [(each.text or "", each.get("class")) for each in text]
        wide = sum(len(part) * (13 if kind == "index" else size) / 2 for part, kind in parts)
        boxes.append((float(text.attrib["x"]), float(text.attrib["y"]), wide))
    assert boxes
    for (x, y, wide), (u, v, other) in combinations(boxes, 2):
        assert abs(x - u) >= (wide + other) / 2 or abs(y - v) >= 11


@pytest.mark.sampled(8)
@pytest.mark.parametrize("name", SHIPPED)
def test_all_frames_and_lengths_of_the_statement_stand_in_its_figure(name: str) -> None:
    # The figure names all frames, axes, lengths and joint variables of the statement.
    exercise = SHIPPED[name]
    statement = exercise.statement
    told = labels(drawn(name))
    assert set(re.findall(r"\{\w\}", statement)) - {"{i}"} <= told
    assert set(re.findall(r"\b[xyz]\d\b", statement)) <= told
    lengths = {v.name for v in exercise.variables if v.kind == "length" or v.joint}
    assert {each for each in lengths if re.search(rf"\b{each}\b", statement)} <= told
    assert set(re.findall(r"\b\d+\.\d+", statement)) <= told


@pytest.mark.sampled(4)
@pytest.mark.parametrize(
    ("name", "frames"),
    [
        ("planar-rr", "02"), ("planar-rrr", "0e"), ("planar-rrr-standard", "03"), ("scara", "04"),
        ("planar-rrr-drawn", "0123e"), ("rrrp-drawn", "01234"), ("stanford-arm-drawn", "0123456"),
        ("rrrp-proximal", "04"), ("spherical-wrist", "36"), ("planar-rpr-poe", "sb"),
        ("planar-rrr-faded", "0123e"), ("scara-faded", "01234"), ("first-arm", "012"),
        ("first-arm-modified", "012e"), ("rrrp", "04"), ("vertical-axes", "03"),
    ],
)  # fmt: skip
def test_a_figure_draws_the_given_frames_and_no_others(name: str, frames: str) -> None:
    # The other frames are the student's to choose.
    found = {each for each in labels(drawn(name)) if re.fullmatch(r"[xyz].|\{.\}", each)}
    axes = {f"{axis}{frame}" for axis in "xz" for frame in frames}
    assert found == {*axes, f"y{frames[0]}", *(f"{{{frame}}}" for frame in frames)}


# The wrist alone, from {3} to {6}, is in the list above.
@pytest.mark.sampled(8)
@pytest.mark.parametrize("name", sorted({*TABLES} - {"spherical-wrist"}))
def test_a_figure_draws_base_and_tool_if_they_are_given(name: str) -> None:
    exercise, told = SHIPPED[name], labels(drawn(name))
    free = {
        frame
        for part in exercise.parts
        for frame in ("base", "tool")
        if getattr(part, frame, "given") == "free"
    }
    joints = len(exercise.robot.joints)
    base, *ends = ({f"x{i}", f"z{i}", f"{{{i}}}"} for i in (0, joints, "e"))
    # The statements of robots on a free base say that the figure shows one choice of frame {0}.
    assert base <= told
    assert any(end <= told for end in ends) is ("tool" not in free)


# What the statements of the `-drawn` exercises say of each frame in the home configuration: where
# its z and x axes point, and its origin.
X, Y, UP, DOWN = (1, 0, 0), (0, 1, 0), (0, 0, 1), (0, 0, -1)
STATED = {
    "planar-rrr-drawn": [
        (UP, X, ""), (UP, X, ""), (UP, X, "l1 0 0"), (UP, X, "l1+l2 0 0"), (UP, X, "l1+l2+l3 0 0"),
    ],
    "rrrp-drawn": [
        (UP, X, ""), (UP, X, "l2 0 l1"), (DOWN, X, "l2+l3 0 l1"), (DOWN, X, "l2+l3 0 l1-l4"),
        (DOWN, X, "l2+l3 0 l1-l4-q4"),
    ],
    "stanford-arm-drawn": [
        (UP, X, ""), (Y, X, ""), (UP, X, "0 d2 0"), (UP, X, "0 d2 d3"), (Y, X, "0 d2 d3"),
        (UP, X, "0 d2 d3"), (UP, X, "0 d2 d3+d6"),
    ],
}  # fmt: skip


@pytest.mark.parametrize("name", STATED)
def test_drawn_frames_agree_with_the_statement(name: str) -> None:
    exercise = SHIPPED[name]
    numbers = drawing_numbers(exercise.variables)
    values = {symbol: np.array([number]) for symbol, number in numbers.items()}
    poses = given_frames(exercise).at(values, 1)[:, 0]
    for pose, (z, x, origin) in zip(poses, STATED[name], strict=True):
        # The signed sum of symbols of each coordinate.
        at = [
            sum(float(f"{sign}1") * numbers[symbol] for sign, symbol in
                re.findall(r"([+-]?)([a-z]\d)", term))
            for term in origin.split() or ["0"] * 3
        ]  # fmt: skip
        assert pose[:3, 2] == pytest.approx(z, abs=1e-9)
        assert pose[:3, 0] == pytest.approx(x, abs=1e-9)
        assert pose[:3, 3] == pytest.approx(at, abs=1e-9)


@pytest.mark.parametrize("free", ["base", "tool", "frames"])
def test_frames_that_are_free_are_not_drawn(free: str) -> None:
    exercise = SHIPPED["stanford-arm-drawn"]
    [part] = exercise.parts
    choice = {"frames": "free", free: "free"}
    given = given_frames(replace(exercise, parts=(part.model_copy(update=choice),)))
    assert given.labels == {"base": ("6",), "tool": ("0",), "frames": ("0", "6")}[free]


@pytest.mark.parametrize("name", ["planar-rr", "planar-rrr", "scara", "stanford-arm"])
def test_no_column_below_the_origin_suggests_a_length(name: str) -> None:
    # The first joint stands on the ground, with its middle at the origin.
    exercise = SHIPPED[name]
    assert exercise.reference is not None
    numbers = drawing_numbers(exercise.variables)
    mechanism = mechanism_of(exercise.reference, numbers)
    [shown] = mechanism.at(np.array([[numbers[joint.variable] for joint in exercise.joints]]))
    assert shown.centres[0] == pytest.approx([0, 0, 0])
    assert shown.base == pytest.approx([0, 0, -JOINT_LENGTH / 2 * mechanism.size])


@pytest.mark.sampled(4)
@pytest.mark.parametrize("name", SHIPPED)
def test_a_figure_reveals_only_what_the_statement_says(name: str) -> None:
    # All texts are joint variables, lengths and their sums, frames, and stated numbers.
    exercise = SHIPPED[name]
    known = {variable.name for variable in exercise.variables}
    told = {each for each in labels(drawn(name)) if not re.fullmatch(r"[xyz].|\{.\}", each)}
    assert told
    assert {each for each in told if not each[0].isdigit()} <= known
    assert all(re.search(rf"(?<![\w.]){word}\b", stated(exercise)) for word in told)
    words = "".join(ET.fromstring(drawn(name)).find(f"{SVG}desc").itertext())  # type: ignore[union-attr]
    numbers = re.findall(r"(?<![\w.{])\d+(?:\.\d+)?", words.translate(GREEK))
    assert set(numbers) - told <= {"0"}


def stated(exercise: Exercise) -> str:
    described = (f"{variable.name}: {variable.description}" for variable in exercise.variables)
    return "\n".join([exercise.statement, *described])


@pytest.mark.parametrize("name", TABLES)
def test_every_joint_and_length_symbol_of_the_table_is_labelled(name: str) -> None:
    exercise = SHIPPED[name]
    told = labels(drawn(name))
    robot = exercise.robot
    rows = robot.tables[robot.convention].rows
    lengths = {symbol for row in rows for cell in (row[0], row[2]) for symbol in cell.symbols}
    assert lengths | {joint.variable for joint in robot.joints} <= told


@pytest.mark.sampled(4)
@pytest.mark.parametrize("name", SHIPPED)
def test_no_joint_axis_points_at_the_viewer(name: str) -> None:
    exercise = SHIPPED[name]
    assert exercise.reference is not None
    numbers = drawing_numbers(exercise.variables)
    mechanism = mechanism_of(exercise.reference, numbers)
    view = default_view(mechanism, numbers)
    [shown] = mechanism.at(np.array([[numbers[joint.variable] for joint in exercise.joints]]))
    # The sine of the angle between an axis and the line of sight.
    assert np.linalg.norm(np.cross(shown.axes, sight(view)), axis=1).min() > 0.45


def sight(view: View) -> Numbers:
    azimuth, elevation = np.radians([view.azimuth, view.elevation])
    level = np.cos(elevation)
    return np.array([level * np.cos(azimuth), level * np.sin(azimuth), np.sin(elevation)])


@pytest.mark.long
def test_the_author_may_choose_the_view() -> None:
    exercise = SHIPPED["spatial-rrr"]
    other = exercise_figure(replace(exercise, view=ViewSpec(azimuth=-100, elevation=20)))
    assert other != drawn("spatial-rrr")
    # Seen from -y0, the arm along x0 is horizontal.
    level = exercise_figure(replace(exercise, view=ViewSpec(azimuth=-90, elevation=0)))
    heights = [
        {point.split(",")[1] for point in line.get("points", "").split()[-2:]}
        for line in ET.fromstring(level).findall(".//*[@class='rod']")
    ]
    assert all(len(each) == 1 for each in heights[1:])


@pytest.mark.parametrize("theme", Theme)
def test_a_theme_changes_only_the_style_sheet(theme: Theme) -> None:
    themed = exercise_figure(SHIPPED["scara"], theme)
    style = re.compile("<style>.*?</style>", re.DOTALL)
    assert style.sub("", themed) == style.sub("", drawn("scara"))
    sheet = style.search(themed)
    assert sheet is not None
    assert ("prefers-color-scheme:dark" in sheet[0]) == (theme is Theme.AUTO)
    assert ("@media print" in sheet[0]) == (theme is Theme.DARK)
    classes = set(" ".join(re.findall(r'class="([^"]+)"', themed)).split())
    unstyled = {each for each in classes if f".{each}" not in sheet[0]}
    assert unstyled <= {"variable", "length", "frame-name"}


@pytest.mark.parametrize("name", SHIPPED)
def test_a_figure_is_a_picture_with_a_title_and_a_description(name: str) -> None:
    root = ET.fromstring(drawn(name))
    assert root.get("role") == "img"
    ids = [each.get("id") for each in root.iter() if each.get("id")]
    assert len(ids) == len(set(ids))
    labelled = (root.get("aria-labelledby") or "").split()
    assert [each.get("id") for each in root[:2]] == labelled
    assert root[0].text == SHIPPED[name].title
    assert not re.search(r"nan|inf\b|<script|\bon\w+=|style=|href", drawn(name))


@pytest.mark.long
def test_frames_are_drawn_for_tutors() -> None:
    framed = texts(reference_figure(SHIPPED["stanford-arm"]))
    names = {name for text in framed for name in text.split(", ")}
    assert {f"{axis}{i}" for axis in "xyz" for i in range(7)} <= names
    # Frames 3, 4 and 5 are in the wrist: common axes are drawn once.
    assert "x3, x4, x5" in framed


@pytest.mark.parametrize("name", ["scara", "three-link-cylindrical"])
def test_no_arrow_of_a_sliding_joint_crosses_an_axis(name: str) -> None:
    lines: dict[str, list[tuple[complex, complex]]] = {"motion": [], "frame": []}
    for line in ET.fromstring(reference_figure(SHIPPED[name])).iter(f"{SVG}polyline"):
        x, y, *_, u, v = map(float, re.findall(r"-?[\d.]+", line.attrib["points"]))
        kind = line.attrib["class"].split()[0]
        # Arcs have more points.
        if kind == "frame" or (kind == "motion" and line.attrib["points"].count(",") < 20):
            lines[kind].append((complex(x, y), complex(u, v)))
    assert lines["motion"]
    assert lines["frame"]
    for (a, b), (c, d) in product(lines["motion"], lines["frame"]):
        # Two lines cross if each has its ends on both sides of the other.
        sides = [((q - p) * (r - p).conjugate()).imag for p, q, r in
                 [(a, b, c), (a, b, d), (c, d, a), (c, d, b)]]  # fmt: skip
        assert not (sides[0] * sides[1] < 0 and sides[2] * sides[3] < 0)


def test_an_exercise_without_a_robot_has_no_figure() -> None:
    exercise = shipped_exercises()["dh-conditions"]
    with pytest.raises(LookupError, match="no robot"):
        exercise_figure(exercise)


def test_the_figure_of_the_readme_is_current() -> None:
    # To update it: dh-grader exercises show stanford-arm --figure docs/stanford-arm.svg.
    #
    # The last digits may differ between processors.
    number = re.compile(r"-?\d+(?:\.\d+)?")
    kept = (DOCS / "stanford-arm.svg").read_text(encoding="utf-8")
    assert number.sub("0", kept) == number.sub("0", drawn("stanford-arm"))
    one, other = (list(map(float, number.findall(svg))) for svg in (kept, drawn("stanford-arm")))
    assert one == pytest.approx(other, abs=0.05)
