"""Write the notice of third-party works in the repository: the file NOTICE.

``python -m tests.docs.notice > NOTICE`` writes it.
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


_STATIC: Final = "service/web/static/vendor"
_ARMS: Final = "tests/importing/arms"
_SWAGGER: Final = "service/api/routes/swagger_ui"
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
    Vendored(
        "airo-models, the joints of the UR5e",
        "0.0.12",
        "https://github.com/airo-ugent/airo-models",
        "Copyright (c) 2024, Andreas Verleysen",
        "MIT",
        f"{_ARMS}/LICENSE.airo-models",
        (f"{_ARMS}/ur5e-airo-models-0.0.12.urdf",),
        shipped=False,
    ),
    Vendored(
        "compas_fab, the joints of the IRB 120 and the IRB 4600",
        "2.0.1",
        "https://github.com/compas-dev/compas_fab",
        "Copyright (c) 2018-2026 Gramazio Kohler Research",
        "MIT",
        f"{_ARMS}/LICENSE.compas_fab",
        (f"{_ARMS}/irb120-compas_fab-2.0.1.urdf", f"{_ARMS}/irb4600-compas_fab-2.0.1.urdf"),
        shipped=False,
    ),
    Vendored(
        "panda_description in example-robot-data, the joints of the Panda",
        "6.0.0",
        "https://github.com/gepetto/example-robot-data",
        "Copyright Franka Emika GmbH",
        "Apache-2.0",
        f"{_ARMS}/LICENSE.panda_description",
        (f"{_ARMS}/panda-example-robot-data-6.0.0.urdf",),
        shipped=False,
    ),
    Vendored(
        "baxter_description in example-robot-data, the joints of the right arm",
        "6.0.0",
        "https://github.com/gepetto/example-robot-data",
        "Copyright (c) 2013-2015, Rethink Robotics",
        "BSD-3-Clause",
        f"{_ARMS}/LICENSE.baxter_description",
        (f"{_ARMS}/baxter-example-robot-data-6.0.0.urdf",),
        shipped=False,
    ),
)
# The licences of further works inside Swagger UI's JavaScript file.
BUNDLED: Final = f"{_SWAGGER}/swagger-ui-5.35.0.js.LICENSE.txt"
_HEADING: Final = """\
DH Grader
Copyright and licence: see the file LICENSE.

The wheel and the image carry the works below, unchanged but for file names and imports. Each
licence is in the file that is named, which the wheel and the image carry, too. Packages that the
program needs are not in the wheel; `python -m service.cli.licences` lists those that are installed,
with their licences, and the image has that list in /opt/dh-grader/LICENCES.
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


# A version in the name, as vendored files have, or a note on rights in the text.
_VERSIONED: Final = re.compile(r"-\d+\.\d+\.\d+\.")
_RIGHTS: Final = re.compile(
    rb"@license|\(c\) *\d{4}|copyright (?:\(c\) |\xc2\xa9 )?\d{4}", re.IGNORECASE
)


def looks_vendored(file: Path) -> bool:
    """True if a file is probably the work of others."""
    return bool(_VERSIONED.search(file.name) or _RIGHTS.search(file.read_bytes()))


if __name__ == "__main__":
    sys.stdout.write(notice())
