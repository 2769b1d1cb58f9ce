"""Read the headers of table columns."""

import pytest
from dh_grader.grading.reading.headers import Header, read_header

from tests.together import together

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
