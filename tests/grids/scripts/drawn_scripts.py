"""Generate random scripts for the Robotics Toolbox for Python."""

# Source: P. Corke, Robotics Toolbox for Python, the constructors of RevoluteDH, PrismaticDH, their
# modified forms, DHLink and DHRobot.

from dataclasses import dataclass
from random import Random

_LENGTHS = [
    "0",
    "0.4318",
    "a1",
    "l_2",
    "d1 + 0.1",
    "2*l1",
    "-0.15",
    "1e-3",
    "L3/2",
    "λ",
    "(a1 + a2)",
]
_ANGLES = ["0", "pi/2", "-pi/2", "np.pi/2", "-math.pi / 2", "radians(90)", "np.deg2rad(-90)", "α1"]
_OFFSETS = ["0", "0", "pi/2", "-pi/2", "0.1", "- 0.2"]
# Arguments that no DH table has.
_EXTRAS = [
    "",
    "",
    "qlim=[-pi, pi]",
    "m=4.43, r=[0, 1, 2]",
    "I=np.diag([0, 0.35, 0])",
    "name='a, (1)'",
]
_REMARKS = ["", "", "  # link 1: a, alpha", "  # don't, [ (", "  # θ₁ – Gelenk"]
_HEADS = [
    "",
    "import roboticstoolbox as rtb\nfrom math import pi\n",
    '"""A robot.\n\nRevoluteDH(a=9)\n"""\nimport numpy as np\n',
    "# -*- coding: utf-8 -*-\nl1, l2 = symbols('l1 l2')\n",
]
_TAILS = ["", "\nprint(robot)", "\nT = robot.fkine([0]*6)\nprint(T)", "\nrobot.teach()  # look"]
_OPTIONS = ["", ", name='x'", ", name=\"2R, planar\", manufacturer='me'"]


@dataclass(frozen=True)
class DrawnScript:
    """A script, and the table cells that it defines."""

    text: str
    rows: list[list[str]]
    convention: str


def draw_script(random: Random) -> DrawnScript:
    """Return a script with one to seven links."""
    modified = random.random() < 0.4
    drawn = [_link(random, number, modified=modified) for number in range(1, random.randint(2, 8))]
    links = [text for text, _ in drawn]
    body = _robot(random, links, random.choice(_OPTIONS))
    text = random.choice(_HEADS) + body + random.choice(_TAILS)
    return DrawnScript(text, [row for _, row in drawn], "modified" if modified else "standard")


def _link(random: Random, number: int, *, modified: bool) -> tuple[str, list[str]]:
    is_prismatic, is_general = random.random() < 0.4, random.random() < 0.2
    constant, variable = ("theta", "d") if is_prismatic else ("d", "theta")
    cells = {"a": random.choice(_LENGTHS), "alpha": random.choice(_ANGLES)}
    cells[constant] = random.choice(_ANGLES if is_prismatic else _LENGTHS)
    by_name = [
        f"{name}={cell}" for name, cell in cells.items() if cell != "0" or random.random() < 0.5
    ]
    random.shuffle(by_name)
    if is_general:
        name = "DHLink"
        given = [*by_name, *["sigma=1"] * is_prismatic, *["mdh=True"] * modified]
    else:
        name = f"{'Prismatic' if is_prismatic else 'Revolute'}{'M' * modified}DH"
        by_place = [cells[constant], cells["a"], cells["alpha"]]
        given = random.choice([by_name, by_place])
    moved = f"q{number}"
    if random.random() < 0.1:
        given = [*given, "flip=True"]
        moved = f"-{moved}"
    if (offset := random.choice(_OFFSETS)) != "0":
        given = [*given, f"offset={offset}"]
        moved += offset if offset[0] == "-" else f"+{offset}"
    given = [each for each in [*given, random.choice(_EXTRAS)] if each]
    between = random.choice([", ", ",", " , ", ",\n        "])
    module = random.choice(["", "", "rtb.", "roboticstoolbox."])
    row = cells | {variable: moved}
    call = f"{module}{name}({between.join(given)})"
    return call, [row[column] for column in ("a", "alpha", "d", "theta")]


def _robot(random: Random, links: list[str], options: str) -> str:
    names = [f"L{number}" for number in range(1, len(links) + 1)]
    remark = random.choice(_REMARKS)
    together = ", ".join(links)
    lines = "".join(f"    {link},{remark}\n" for link in links)
    named = "\n".join(f"{name} = {link}{remark}" for name, link in zip(names, links, strict=True))
    appended = "\n".join(f"L.append({link})" for link in links)
    return random.choice(
        [
            f"robot = rtb.DHRobot([\n{lines}]{options})",
            f"links = [{together}]\nrobot = DHRobot(links{options})",
            f"{named}\nrobot = rtb.DHRobot([{', '.join(names)}]{options})",
            f"L = []\n{appended}\nrobot = DHRobot(L{options})",
            f"E1 = [\n{lines}]",
            f"robot = DHRobot(\n    ({together},){options}\n)",
            f"robot = DHRobot(links=[{together}]{options})",
        ]
    )
