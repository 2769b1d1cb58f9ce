"""Write a textbook robot's table as a script for a robotics toolbox."""

from tests.grading.support.robots import COLUMNS, Robot, in_pi


def cells(robot: Robot) -> list[dict[str, str]]:
    found = []
    for row in robot.rows:
        named = dict(zip(COLUMNS, row, strict=True))
        named["alpha"] = in_pi(int(named["alpha"]))
        found.append({name: "" if "*" in cell else cell for name, cell in named.items()})
    return found


def in_matlab(robot: Robot) -> str:
    """Return a script with vectors [θ d a α σ] for MATLAB's toolbox."""
    lines = [
        f"L({i}) = Link([{row['theta'] or 0} {row['d'] or 0} {row['a']} {row['alpha']} "
        f"{int(not row['d'])}]);"
        for i, row in enumerate(cells(robot), 1)
    ]
    return "\n".join(["clear, close all", *lines, "robot = SerialLink(L);", "robot.teach()"])


def by_name(robot: Robot) -> str:
    lines = []
    for row in cells(robot):
        given = ", ".join(f"'{name}', {cell}" for name, cell in row.items() if cell)
        lines.append(f"    Link({given})")
    return "\n".join(["robot = SerialLink([", *lines, "]);"])


def in_python(robot: Robot) -> str:
    """Return a script for the Robotics Toolbox for Python."""
    lines = []
    for row in cells(robot):
        kind = "Revolute" if row["d"] else "Prismatic"
        given = ", ".join(f"{name}={cell}" for name, cell in row.items() if cell not in ("", "0"))
        lines.append(f"    rtb.{kind}DH({given}),")
    return "\n".join(["import roboticstoolbox as rtb", "robot = rtb.DHRobot([", *lines, "])"])


def of_bodies(robot: Robot) -> str:
    """Return a script for MATLAB's Robotics System Toolbox."""
    lines = []
    for i, row in enumerate(cells(robot), 1):
        kind = "revolute" if row["d"] else "prismatic"
        values = " ".join(row[name] or "0" for name in COLUMNS)
        lines.append(f"jnt{i} = rigidBodyJoint('jnt{i}', '{kind}');")
        lines.append(f"setFixedTransform(jnt{i}, [{values}], 'dh');")
    return "\n".join(["robot = rigidBodyTree;", *lines])


def by_column(robot: Robot) -> str:
    columns = ((name, i) for i, name in enumerate(COLUMNS))
    lists = ", ".join(
        f"'{name}': [{', '.join(_value(name, row[i]) for row in robot.rows)}]"
        for name, i in columns
    )
    return f"import pandas as pd\ndh = pd.DataFrame({{{lists}}})"


def _value(name: str, cell: str) -> str:
    return in_pi(int(cell)) if name == "alpha" else cell.removesuffix("*")
