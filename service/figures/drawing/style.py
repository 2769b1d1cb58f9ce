"""The light and dark colours of figures, as style sheets inside the SVG."""

from collections.abc import Mapping
from enum import StrEnum
from typing import Final


class Theme(StrEnum):
    """The colours of a figure: light, dark, or those of the reader's system. Printed: light."""

    AUTO = "auto"
    LIGHT = "light"
    DARK = "dark"


_LIGHT: Final = {
    "paper": "#ffffff", "ink": "#1c2430", "rod": "#d5dae1", "turning": "#7fb0e6",
    "turning-light": "#e9f3fd", "cap": "#d3e6f9", "side0": "#fbe9c6", "side1": "#f3d596",
    "side2": "#e2b964", "ground": "#eef0f3", "soft": "#5d6877", "axis": "#7b8696",
    "motion": "#7a2fb0", "chain": "#8e44ad", "x": "#c62828", "y": "#1f7a34", "z": "#1d4fc4",
}  # fmt: skip
_DARK: Final = {
    "paper": "#12161d", "ink": "#e8ecf2", "rod": "#465061", "turning": "#2f5f96",
    "turning-light": "#6da3dd", "cap": "#4a7fb9", "side0": "#c99a44", "side1": "#a67c31",
    "side2": "#7f5e22", "ground": "#232a35", "soft": "#a7b2c2", "axis": "#8b97a8",
    "motion": "#d8a5ff", "chain": "#d19cf0", "x": "#ff8080", "y": "#6fd68a", "z": "#8ab4ff",
}  # fmt: skip
_SHAPES: Final = """\
text{font:italic 17px "STIX Two Text","Latin Modern Roman",Cambria,Georgia,"Times New Roman",serif;\
text-anchor:middle;stroke-width:4px;stroke-linejoin:round;paint-order:stroke}
.number{font-size:13.3px}
.index{font-size:13.3px;font-style:normal}
.sign{font-style:normal}
polyline{fill:none}
.rim,.rod{stroke-linejoin:round}
.turning,.cap,.sliding,.ground{stroke-width:1.3px;stroke-linejoin:round}
.hatch{stroke-width:1.1px}
.edge{stroke-width:2px}
.grip-rim,.grip{stroke-linecap:round;stroke-linejoin:round}
.axis{stroke-width:1px;stroke-dasharray:11 3 2 3}
.witness{stroke-width:.7px}
.leader{stroke-width:.8px}
.dimension{stroke-width:.9px}
.motion{stroke-width:1.7px}
.motion-halo{stroke-width:4px}
.frame{stroke-width:2.2px}
.frame-halo{stroke-width:4.4px}
.origin{stroke-width:1.4px}
.chain{stroke-width:2.6px;stroke-linejoin:round;stroke-linecap:round}
"""


def style_sheet(theme: Theme) -> str:
    """Return the style sheet of a figure."""
    if theme is Theme.DARK:
        return _SHAPES + _colours(_DARK) + _only("print", _LIGHT)
    if theme is Theme.LIGHT:
        return _SHAPES + _colours(_LIGHT)
    dark = _only("screen and (prefers-color-scheme:dark)", _DARK)
    return _SHAPES + _colours(_LIGHT) + dark


def _only(medium: str, palette: Mapping[str, str]) -> str:
    return f"@media {medium}{{\n{_colours(palette)}}}\n"


def _colours(of: Mapping[str, str]) -> str:
    # No CSS variables: some programs ignore them.
    ink, soft, paper = of["ink"], of["soft"], of["paper"]
    rules = {
        ".paper": f"fill:{paper}",
        "text": f"fill:{ink};stroke:{paper}",
        ".rim": f"stroke:{ink}",
        ".rod": f"stroke:{of['rod']}",
        ".turning,.cap,.sliding": f"stroke:{ink}",
        ".cap": f"fill:{of['cap']}",
        ".shade": f"stop-color:{of['turning']}",
        ".light": f"stop-color:{of['turning-light']}",
        ".side0": f"fill:{of['side0']}",
        ".side1": f"fill:{of['side1']}",
        ".side2": f"fill:{of['side2']}",
        ".ground": f"fill:{of['ground']};stroke:{soft}",
        ".hatch": f"stroke:{soft}",
        ".edge": f"stroke:{ink}",
        ".grip-rim": f"stroke:{ink}",
        ".grip": f"stroke:{of['rod']}",
        ".point": f"fill:{ink}",
        ".axis": f"stroke:{of['axis']}",
        ".witness,.dimension,.leader": f"stroke:{soft}",
        ".dimension-head": f"fill:{soft}",
        ".motion": f"stroke:{of['motion']}",
        ".chain": f"stroke:{of['chain']}",
        ".motion-halo,.frame-halo": f"stroke:{paper}",
        ".origin": f"fill:{ink};stroke:{paper}",
        ".motion-head,.variable": f"fill:{of['motion']}",
    }
    for axis in "xyz":
        rules[f".frame-{axis}"] = f"stroke:{of[axis]}"
        rules[f".head-{axis},.name-{axis}"] = f"fill:{of[axis]}"
    return "".join(f"{chosen}{{{rule}}}\n" for chosen, rule in rules.items())
