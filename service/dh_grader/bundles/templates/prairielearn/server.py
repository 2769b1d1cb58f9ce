"""Choose a variant of each exercise by the variant seed of PrairieLearn."""

import hashlib
import json
from pathlib import Path
from typing import Any


def generate(data: dict[str, Any]) -> None:
    """Set the seeds for the grader, and the texts of these variants for the page."""
    file = Path(data["options"]["question_path"]) / "variants.json"
    pages = json.loads(file.read_text(encoding="utf-8"))
    params = data["params"]
    params["seeds"] = {}
    for i, (exercise, variants) in enumerate(pages.items(), 1):
        digest = hashlib.sha256(f"{data['variant_seed']} {exercise}".encode()).digest()
        seed = sorted(variants)[int.from_bytes(digest[:8], "big") % len(variants)]
        params["seeds"][exercise] = seed
        params[f"page_{i}"] = variants[seed]
