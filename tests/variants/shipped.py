"""The shipped exercises that have variants."""

from dh_grader.catalogue import Exercise, load_exercise, shipped_folder

VARIED = ("planar-rr-numbers", "elbow-directions", "vertical-axes")


def shipped(name: str) -> Exercise:
    """Return a shipped exercise."""
    return load_exercise(shipped_folder() / f"{name}.toml")
