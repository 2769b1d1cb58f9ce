"""Test how headers of columns, labels of rows, and rows of units are read."""

import pytest
from dh_grader.grading.reading.headers import LAST, Header, label_place, read_header
from dh_grader.grading.reading.pasted_table import with_units_in_headers
from dh_grader.pasting import read_grid

from tests.together import together

# --- Read the headers of table columns

SPELLINGS = {
    "a": [
        "a", "A", "a_i", "a_{i}", "aᵢ", "$a_i$", "ai", "a i", "a(i)", "a_j", "a_n", "r", "r_i", "R",
        "link length", "Link Length", "length", "link length a", "a (link length)",
        "Link length, a_i", "length a_i", r"\mathrm{a}_i", r"\textbf{a}", "**a**",
        "`a`", "*a*", "a:", "𝑎", "a_x", "d_x", "Link length L",
    ],
    "alpha": [
        "alpha", "Alpha", "ALPHA", "α", "α_i", "α_{i}", "αᵢ", r"\alpha", r"\alpha_i", r"$\alpha_i$",
        "alpha_i", "alpha i", "alphai", "twist", "link twist", "Link twist α", "twist angle",
        "∝", "∝_i", "α_x",
        "link twist angle", "alpha (twist)", "⍺ⱼ", "⍺", "𝛼", "𝛼ᵢ", "al",
    ],
    "d": [
        "d", "D", "d_i", "d_{i}", "dᵢ", "$d_i$", "di", "offset", "link offset", "joint offset",
        "Link Offset d", "d (offset)", "dⱼ", "d_z",
    ],
    "theta": [
        "theta", "Theta", "θ", "Θ", "ϑ", "θ_i", "θ_{i}", "θᵢ", r"\theta", r"\theta_i",
        r"$\theta_{i}$", "theta_i", "thetai", "q", "q_i", "qᵢ", "qi", "joint angle",
        "Joint angle θ", "angle", "th", "θⱼ",
        "φ_i", r"$\phi_i$", "θ_z", r"$\theta_i^*$", "theta*",
    ],
    "label": [
        "i", "j", "n", "k", "#", "link", "Link", "joint", "Joint", "Link i", "joint i", "Joint #",
        "link no.", "No.", "no", "row", "frame", "$i$", "i (link)", "joint number", "link number",
        "index", "axis", "Glied", "Gelenk Nr.", "Glied-Nr.", "Gelenknummer", "Zeile", "Reihe",
        "Körper", "Articulation", "N° d'articulation", "numéro de l’axe", "Segment", "Liaison",
        "Corps", "Articulación", "Eslabón", "N.º de eslabón", "连杆", "关节", "连杆 i",
        "连杆号", "行", "Links", "Joints",
    ],
    "aside": ["type", "Joint type", "variable", "joint variable", "comment", "limits", "home",
        "q_min [deg]", "θ_max", "max", "lower limit", "upper bound", "cos(alpha)", "sin(α_i)"],
}  # fmt: skip
CASES = [(text, column) for column, texts in SPELLINGS.items() for text in texts]


@together(("text", "column"), CASES)
def test_a_spelling_means_this_column(text: str, column: str) -> None:
    assert read_header(text) == Header(column)
    assert read_header(f"  {text}\u00a0") == Header(column)


SHIFTED = [
    "a_{i-1}", "aᵢ₋₁", "a_{i−1}", "$a_{i-1}$", "a_i-1", "a(i-1)", "a_{i - 1}", "ai-1", "a i-1",
    "a_{n-1}", "a_{j-1}", "r_{i-1}", "link length a_{i-1}",
]  # fmt: skip


@pytest.mark.parametrize("text", SHIFTED)
def test_an_index_one_lower_is_recognized(text: str) -> None:
    assert read_header(text) == Header("a", shifted=True)


@pytest.mark.parametrize("text", ["α_{i-1}", r"\alpha_{i-1}", "alphai-1", "alpha(i-1)", "α i-1"])
def test_an_index_of_alpha_one_lower_is_recognized(text: str) -> None:
    assert read_header(text) == Header("alpha", shifted=True)


@pytest.mark.parametrize(
    ("text", "column", "unit", "radians"),
    [
        ("theta [deg]", "theta", "deg", False),
        ("theta (deg)", "theta", "deg", False),
        ("θ (°)", "theta", "°", False),
        ("θ °", "theta", "°", False),
        ("θ°", "theta", "°", False),
        ("θ_i (º)", "theta", "°", False),
        ("theta_deg", "theta", "deg", False),
        ("theta / deg", "theta", "deg", False),
        ("theta, degrees", "theta", "degrees", False),
        ("theta in degrees", "theta", "degrees", False),
        ("θ in °", "theta", "°", False),
        (r"$\theta_i$ [$^\circ$]", "theta", "°", False),
        (r"$\theta_i\,[^{\circ}]$", "theta", "°", False),
        (r"$\alpha_{i}[^\circ]$", "alpha", "°", False),
        ("alpha (rad)", "alpha", "rad", True),
        ("alpha [radians]", "alpha", "radians", True),
        ("alpha_rad", "alpha", "rad", True),
        ("Link twist (deg)", "alpha", "deg", False),
        ("joint angle (°)", "theta", "°", False),
        ("θ en °", "theta", "°", False),
        ("α en grados", "alpha", "grados", False),
        (r"$\vartheta_i$ (rad)", "theta", "rad", True),
        ("Drehwinkel θ (deg)", "theta", "deg", False),
        ("Giro α (°)", "alpha", "°", False),
        (r"\makecell{$\alpha_i$} (rad)", "alpha", "rad", True),
    ],
)
def test_units_of_angles(text: str, column: str, unit: str, radians: bool) -> None:
    header = read_header(text)
    assert header == Header(column, unit)
    assert header.angle_unit == ("radians" if radians else "degrees")
    assert header.metres is None


@pytest.mark.parametrize(
    ("text", "column", "metres"),
    [
        ("d (m)", "d", 1.0),
        ("d [mm]", "d", 0.001),
        ("d in mm", "d", 0.001),
        ("d en mm", "d", 0.001),
        ("连杆偏移 (mm)", "d", 0.001),
        ("d_mm", "d", 0.001),
        ("d / mm", "d", 0.001),
        ("a (cm)", "a", 0.01),
        ("a [metres]", "a", 1.0),
        ("link length (inches)", "a", 0.0254),
        ("a (in)", "a", 0.0254),
        (r"$a_i$ [$\mathrm{mm}$]", "a", 0.001),
    ],
)
def test_units_of_lengths(text: str, column: str, metres: float) -> None:
    header = read_header(text)
    assert header is not None
    assert (header.column, header.metres, header.angle_unit) == (column, metres, None)


@together(
    "text",
    [
        "", " ", "foo",
        "a1", "a_1", "theta1", "θ₁", "0", "-90", "pi/2", "a alpha", "a+d", "d_{i+1}",
        "alpha (rad/s)", "b", "x", "beta", "a, d", "Abstand", "i [m]", "a" * 100, "cos",
        "q1*", "=", "a=", "90deg", "\x00", "\ud800",
    ],
)  # fmt: skip
def test_other_texts_are_not_headers(text: str) -> None:
    assert read_header(text) is None


@pytest.mark.parametrize("text", ["theta_offset", "θ offset", r"$\theta_{offset}$", "offset θ"])
def test_an_offset_of_theta_is_no_column_of_theta(text: str) -> None:
    assert read_header(text) == Header("theta offset")


@pytest.mark.parametrize("text", ["L", "l", "L_i", "l_i"])
def test_the_letter_l_depends_on_the_other_headers(text: str) -> None:
    assert read_header(text) == Header("l")


# --- Read row labels such as 1, Link 2, 0→1 or TCP


@together(
    ("text", "place"),
    [
        ("1", 1), ("12", 12), ("1.", 1), ("Link 1", 1), ("link1", 1), ("J3", 3), ("joint 3", 3),
        ("{2}", 2), ("$2$", 2), ("A_2", 2), ("L_{2}", 2), ("0→1", 1), ("2 - 3", 3), ("0 -> 1", 1),
        ("1 to 2", 2), ("①", 1),
        ("e", LAST), ("E", LAST), ("ee", LAST), ("tool", LAST), ("TCP", LAST),
        ("End effector", LAST), ("end-effector", LAST), ("n+1", LAST), ("$e$", LAST),
        ("Glied 1", 1), ("Gelenk 2", 2), ("Zeile 3", 3), ("Reihe 1", 1), ("Glied-Nr. 2", 2),
        ("Gelenk Nr 3", 3), ("1. Gelenk", 1), ("Körper 2", 2), ("Nr. 4", 4),
        ("Articulation 1", 1), ("Articulation n° 2", 2), ("Segment 3", 3), ("Liaison 1", 1),
        ("Corps 2", 2), ("Axe 3", 3), ("Articulación 1", 1), ("articulacio\u0301n 2", 2),
        ("Eslabón 3", 3), ("Fila 1", 1), ("连杆 1", 1), ("连杆2", 2), ("关节三", 3), ("第2关节", 2),
        ("行 1", 1), ("连杆１", 1),
        ("Endeffektor", LAST), ("effecteur", LAST), ("efector final", LAST), ("末端执行器", LAST),
        ("", None), ("arm", None), ("1→3", None), ("q1", None), ("-1", None), ("1" * 40, None),
        ("100", None), ("pi", None), ("0.5", None), ("\ud800", None),
        ("Glied", None), ("连杆 i", None), ("Gelenkwinkel 1", None), ("长度 1", None),
        ("Nr. 0.5", None),
    ],
)  # fmt: skip
def test_row_labels(text: str, place: int | None) -> None:
    assert label_place(text) == place


# --- Read a row of units below the column headers

HEADERS = "i;a;alpha;d;theta"
ROW = "1;0.3;90;0;q1"


def headers(units: str) -> list[str]:
    grid = with_units_in_headers(read_grid(f"{HEADERS}\n{units}\n{ROW}"))
    return [cell.text for cell in grid.rows[0]]


@pytest.mark.parametrize("units", [";m;deg;m;deg", ";(m);(deg);(m);(deg)", "-;[m];[deg];[m];[deg]"])
def test_units_are_put_into_the_headers(units: str) -> None:
    assert headers(units) == ["i", "a [m]", "alpha [deg]", "d [m]", "theta [deg]"]


@pytest.mark.parametrize("units", ["Unit;m;deg;m;deg", "Einheit;[m];[deg];[m];[deg]"])
def test_a_row_of_units_may_have_a_label_and_stand_at_the_end(units: str) -> None:
    named = ["i", "a [m]", "alpha [deg]", "d [m]", "theta [deg]"]
    assert headers(units) == named
    grid = with_units_in_headers(read_grid(f"{HEADERS}\n{ROW}\n{ROW}\n{units}"))
    assert [cell.text for cell in grid.rows[0]] == named
    assert len(grid.rows) == 3


def test_one_unit_is_enough() -> None:
    assert headers(";;°;;") == ["i", "a", "alpha [°]", "d", "theta"]


@pytest.mark.parametrize(
    "row",
    ["Unit;m;x;m;deg", "Unit;;;;", "1;m;deg;m;deg", ";m;0;0;q1", ";deg;m;deg;m", ";;;;", ";l1;;;"],
)
def test_any_other_row_is_a_row(row: str) -> None:
    assert headers(row) == HEADERS.split(";")
