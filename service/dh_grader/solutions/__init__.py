"""Model solutions: the right answer to each part, in the form of a textbook."""

from dh_grader.catalogue import Exercise
from dh_grader.solutions.solution import LinkSolution, ModelSolution, PartAnswer, Shown

__all__ = ["LinkSolution", "ModelSolution", "PartAnswer", "Shown", "solve"]


def solve(exercise: Exercise) -> ModelSolution:
    """Return the model solution of an exercise. Equal exercises get equal solutions."""
    # SymPy is imported only when the first exercise is solved, because its import is slow.
    from dh_grader.solutions.answers import solved

    return solved(exercise)
