"""Model solutions: the right answer to each part, in the form of a textbook.

SymPy is imported only when the first exercise is solved, because its import is slow.
"""

from service.catalogue import Exercise
from service.solutions.model_solution import LinkSolution, ModelSolution, PartAnswer, Shown

__all__ = ["LinkSolution", "ModelSolution", "PartAnswer", "Shown", "solve"]


def solve(exercise: Exercise) -> ModelSolution:
    """Return the model solution of an exercise. Equal exercises get equal solutions."""
    # Solving takes about 50 ms.
    from service.solutions.solution import solved

    return solved(exercise)
