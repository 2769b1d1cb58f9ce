"""Model solutions: the right answer to each part, in the form of a textbook.

They need SymPy, whose import is slow, so it is imported when the first exercise is solved.
"""

from service.catalogue import Exercise
from service.solutions.model_solution import LinkSolution, ModelSolution, PartAnswer, Shown

__all__ = ["LinkSolution", "ModelSolution", "PartAnswer", "Shown", "solve"]


def solve(exercise: Exercise) -> ModelSolution:
    """Return the model solution, always the same for an exercise. Solving takes about 50 ms."""
    from service.solutions.solution import solved

    return solved(exercise)
