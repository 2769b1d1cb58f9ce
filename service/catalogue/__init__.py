"""Exercise files, validated and compiled. This package does not handle students' answers."""

from service.catalogue.exercise import Exercise, in_language
from service.catalogue.feedback_level import FeedbackLevel, least
from service.catalogue.files.regular_file import read_regular
from service.catalogue.files.schema import CheckSpec
from service.catalogue.files.toml_file import CatalogueError, Fault
from service.catalogue.level import ExerciseLevel
from service.catalogue.live import LateCatalogue, open_catalogue
from service.catalogue.load import (
    ID_ADVICE,
    exercise_files,
    is_exercise_id,
    load_catalogue,
    load_exercise,
    read_exercise,
    shipped_folder,
)
from service.catalogue.order import by_level, exercise_after
from service.catalogue.part import PartSpec, PosePartSpec
from service.catalogue.robots.formulas import FormulaGrid, grid_values
from service.catalogue.robots.robot import Joint, ReferenceTable, Robot
from service.catalogue.robots.screw_robot import ScrewRobot
from service.catalogue.robots.variables import Variable

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
