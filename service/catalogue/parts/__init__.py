"""The answer kinds in exercise files: the subclass of ``PartSpec`` of each kind."""

from collections.abc import Mapping
from functools import reduce
from operator import or_
from typing import TYPE_CHECKING, Annotated, Final, get_type_hints

from pydantic import Field

from service.catalogue.part import PartSpec
from service.catalogue.parts.dh_row import DhRowSpec
from service.catalogue.parts.dh_table import DhTableSpec
from service.catalogue.parts.euler_angles import EulerAnglesSpec
from service.catalogue.parts.find_slip import FindSlipSpec
from service.catalogue.parts.frames import FramesSpec
from service.catalogue.parts.link_transforms import LinkTransformsSpec
from service.catalogue.parts.matrix import MatrixSpec
from service.catalogue.parts.position import PositionSpec
from service.catalogue.parts.rotation import RotationSpec
from service.catalogue.parts.screw_axes import ScrewAxesSpec
from service.catalogue.parts.transform import TransformSpec
from service.catalogue.parts.vector import VectorSpec
from service.catalogue.shapes import AnswerShape

SPECS: Final[Mapping[str, type[PartSpec]]] = {
    "dh_row": DhRowSpec,
    "dh_table": DhTableSpec,
    "euler_angles": EulerAnglesSpec,
    "find_slip": FindSlipSpec,
    "frames": FramesSpec,
    "link_transforms": LinkTransformsSpec,
    "matrix": MatrixSpec,
    "position": PositionSpec,
    "rotation": RotationSpec,
    "screw_axes": ScrewAxesSpec,
    "transform": TransformSpec,
    "vector": VectorSpec,
}

_SHAPES: Final[Mapping[str, type[AnswerShape]]] = {
    kind: get_type_hints(spec.shape)["return"] for kind, spec in SPECS.items()
}

if TYPE_CHECKING:
    AnyPartSpec = PartSpec
    AnyShape = AnswerShape
else:
    # Discriminated by kind, so that faults are reported for the intended model only.
    AnyPartSpec = Annotated[reduce(or_, SPECS.values()), Field(discriminator="kind")]
    AnyShape = Annotated[reduce(or_, dict.fromkeys(_SHAPES.values())), Field(discriminator="form")]


def posted_forms() -> str:
    """Describe the JSON form of each kind of answer: "`transform`: a list of rows, …"."""
    kinds: dict[str, list[str]] = {}
    for kind, shape in _SHAPES.items():
        kinds.setdefault(shape.posted, []).append(f"`{kind}`")
    return "; ".join(f"{', '.join(names)}: {form}" for form, names in kinds.items())
