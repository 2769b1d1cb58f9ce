"""Exercise files, validated and compiled. Knows nothing of answers."""

from service.catalogue.exercise import Exercise, Variable
from service.catalogue.live import open_catalogue
from service.catalogue.load import (
    CatalogueError,
    Fault,
    exercise_files,
    load_catalogue,
    load_exercise,
    shipped_folder,
)
from service.catalogue.robot import Joint, ReferenceTable, Robot
from service.catalogue.schema import (
    CheckSpec,
    DhRowSpec,
    DhTableSpec,
    EulerAnglesSpec,
    LinkTransformsSpec,
    MatrixSpec,
    PartSpec,
    PositionSpec,
    RotationSpec,
    ScrewAxesSpec,
    TransformSpec,
    VectorSpec,
)
from service.catalogue.screw_robot import FormulaGrid, ScrewRobot, grid_values

__all__ = [
    "CatalogueError",
    "CheckSpec",
    "DhRowSpec",
    "DhTableSpec",
    "EulerAnglesSpec",
    "Exercise",
    "Fault",
    "FormulaGrid",
    "Joint",
    "LinkTransformsSpec",
    "MatrixSpec",
    "PartSpec",
    "PositionSpec",
    "ReferenceTable",
    "Robot",
    "RotationSpec",
    "ScrewAxesSpec",
    "ScrewRobot",
    "TransformSpec",
    "Variable",
    "VectorSpec",
    "exercise_files",
    "grid_values",
    "load_catalogue",
    "load_exercise",
    "open_catalogue",
    "shipped_folder",
]
