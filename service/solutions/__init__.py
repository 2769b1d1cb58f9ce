"""Model solutions: what is right in each part, as a textbook prints it.

Built on SymPy, which takes longer to import than a class takes to be graded: nothing that grades
imports this package.
"""

from service.solutions.layout import Shown
from service.solutions.solution import PartSolution, Solution, solve

__all__ = ["PartSolution", "Shown", "Solution", "solve"]
