"""Read the Kubernetes manifests of deploy/kubernetes."""

from collections.abc import Iterator
from pathlib import Path
from typing import Any

import yaml

ROOT = Path(__file__).parents[2]
FOLDER = ROOT / "deploy" / "kubernetes"
FILES = sorted(FOLDER.rglob("*.yaml"))
OVERLAYS = sorted(file.parent for file in FILES if file.name == "kustomization.yaml")


def documents(file: Path) -> list[dict[str, Any]]:
    """Return the documents of a YAML file."""
    return list(yaml.safe_load_all(file.read_text(encoding="utf-8")))


def objects(kind: str) -> list[dict[str, Any]]:
    """Return all objects of a kind, from all files."""
    return [each for file in FILES for each in documents(file) if each["kind"] == kind]


def the(kind: str, name: str = "grader") -> dict[str, Any]:
    """Return the only object with this kind and name."""
    [found] = [each for each in objects(kind) if each["metadata"]["name"] == name]
    return found


def pods() -> Iterator[tuple[str, dict[str, Any]]]:
    for kind in ("Deployment", "Job"):
        for each in objects(kind):
            yield each["metadata"]["name"], each["spec"]["template"]
