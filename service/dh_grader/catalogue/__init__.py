"""Exercise files, validated and compiled. This package does not handle students' answers."""

from dh_grader.catalogue.exercise import Exercise, in_language
from dh_grader.catalogue.files import CatalogueError, Fault, read_regular
from dh_grader.catalogue.load import (
    ID_ADVICE,
    LateCatalogue,
    by_level,
    exercise_after,
    exercise_files,
    is_exercise_id,
    load_catalogue,
    load_exercise,
    open_catalogue,
    read_exercise,
    shipped_folder,
)
from dh_grader.catalogue.part import PartSpec, PosePartSpec
from dh_grader.catalogue.robot import (
    FormulaGrid,
    Joint,
    ReferenceTable,
    Robot,
    ScrewRobot,
    Variable,
    grid_values,
)
from dh_grader.catalogue.schema import CheckSpec
from dh_grader.catalogue.schema_fields import ExerciseLevel, FeedbackLevel, least

__all__ = [
    "ID_ADVICE",
    "CatalogueError",
    "CheckSpec",
    "Exercise",
    "ExerciseLevel",
    "Fault",
    "FeedbackLevel",
    "FormulaGrid",
    "Joint",
    "LateCatalogue",
    "PartSpec",
    "PosePartSpec",
    "ReferenceTable",
    "Robot",
    "ScrewRobot",
    "Variable",
    "by_level",
    "exercise_after",
    "exercise_files",
    "grid_values",
    "in_language",
    "is_exercise_id",
    "least",
    "load_catalogue",
    "load_exercise",
    "open_catalogue",
    "read_exercise",
    "read_regular",
    "shipped_folder",
]
