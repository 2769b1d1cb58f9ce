"""A model solution at the terminal."""

from collections.abc import Iterator

from rich.console import Console
from rich.text import Text

from service.catalogue import Exercise
from service.solutions import ModelSolution, Shown, solve


def write_solution(exercise: Exercise, console: Console, *, latex: bool) -> None:
    """Print the answer to each part, each link transform and the pose."""
    solution = solve(exercise)
    links = not any(part.holds_links for part in exercise.parts)
    for heading, shown in _sections(solution, links=links):
        console.print(Text(heading, "bold"))
        # Unbroken, so that it can be copied and pasted.
        console.print(Text(shown.latex if latex else shown.text), soft_wrap=True)
        console.print()
    if solution.notation:
        console.print(Text("Shorthand", "bold"))
        for name, meaning in solution.notation.items():
            console.print(Text(f"{name} = {meaning}"))


def _sections(solution: ModelSolution, *, links: bool) -> Iterator[tuple[str, Shown]]:
    for part in solution.parts:
        yield f"{part.part}: {part.title} ({part.kind})", part
    if links:
        yield from ((f"Link transform A{link.label}", link) for link in solution.links)
    answered = [part.text for part in solution.parts]
    if solution.pose is not None and solution.pose.text not in answered:
        yield "Pose of the tool in the base frame", solution.pose
