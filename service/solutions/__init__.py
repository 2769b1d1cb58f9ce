"""Model solutions: the right answer to each part, as a textbook prints it.

Built on SymPy, which takes longer to import than a class takes to be graded: it is imported when
the first exercise is solved.
"""

from service.catalogue import Exercise
from service.solutions.model_solution import LinkSolution, ModelSolution, PartAnswer, Shown

__all__ = ["LinkSolution", "ModelSolution", "PartAnswer", "Shown", "solve"]


def solve(exercise: Exercise) -> ModelSolution:
    """The model solution. Takes a few hundredths of a second; the same exercise, the same text."""
    from service.solutions.solution import solved

    return solved(exercise)
