"""The model answer of kind ``dh_row``: the DH row of a transform, or "no row"."""

import numpy as np
import sympy

from service.catalogue import Exercise, grid_values
from service.catalogue.parts.dh_row import DhRowSpec
from service.catalogue.robots.formulas import EXACT
from service.catalogue.robots.variables import TRIALS, trial_values
from service.kinematics.chain import COLUMNS
from service.kinematics.dh import Convention
from service.kinematics.dh_row import dh1_residual, dh2_residual
from service.solutions import layout
from service.solutions.model_solution import PrintedAnswer
from service.solutions.orientation import as_angle
from service.solutions.work import Work

_MOST_STEPS = 60


def answer_dh_row(part: DhRowSpec, work: Work) -> PrintedAnswer:
    """Return the DH row of the part's transform, or the answer that the transform has none."""
    # The row follows from the entries of a link transform (Spong, Hutchinson, Vidyasagar, *Robot
    # Modeling and Control*, eq. 3.10; Craig, *Introduction to Robotics*, eq. 3.6).
    grid = work.exercise.formulas[part.id]
    numbers = np.moveaxis(grid_values(grid, trial_values(work.exercise.variables), TRIALS), -1, 0)
    broken = [dh1_residual(numbers, part.convention), dh2_residual(numbers, part.convention)]
    if np.abs(broken).max() > EXACT:
        return layout.no_row()
    T = work.algebra.matrix(grid)
    x, y, z = T[:3, 3]
    if part.convention is Convention.STANDARD:
        a, d = x * T[0, 0] + y * T[1, 0], z
        alpha, theta = as_angle(T[2, 1], T[2, 2]), as_angle(T[1, 0], T[0, 0])
    else:
        a, d = x, y * T[1, 2] + z * T[2, 2]
        alpha, theta = as_angle(-T[1, 2], T[2, 2]), as_angle(-T[0, 1], T[0, 0])
    length, angle = work.writer.number, work.writer.angle
    nodes = [length(_simplified(a)), angle(alpha), length(_simplified(d)), angle(theta)]
    return layout.row(nodes, part.convention)


def _simplified(length: sympy.Expr) -> sympy.Expr:
    # l cos² φ + l sin² φ becomes l. Long formulas stay as they are, to save time.
    return sympy.trigsimp(sympy.expand(length)) if length.count_ops() < _MOST_STEPS else length


def lazy_dh_row(_part: DhRowSpec, _exercise: Exercise) -> list[object]:
    """Return a row of zeros, which needs no knowledge."""
    # "No row" is not included, because this guess may be right.
    return [dict.fromkeys(COLUMNS, "0")]
