"""The variants of a bundle: which seed (and so which numbers) a student gets."""

import json
from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field
from pathlib import Path
from typing import Any, Final

from service.bundles.archive import BundledFile
from service.catalogue import Exercise
from service.variants.seeds import seed_of

# The number of variants on PrairieLearn if no seeds are deployed.
DRAWN: Final = 40


class UnknownStudentError(ValueError):
    """The platform's data do not identify the student; the message says why."""


@dataclass(frozen=True, slots=True)
class BundleVariants:
    """The secret of a bundle, and the allowed seeds (short texts) of each exercise."""

    secret: str = field(repr=False)
    deployed: Mapping[str, Sequence[str]]

    def seeds_of(self, learner: str) -> Mapping[str, str]:
        """Return the seed of a learner's variant of each exercise."""
        return {
            exercise: seed_of(self.secret, learner, exercise, 0, deployed)
            for exercise, deployed in self.deployed.items()
        }

    def some(self, exercise: str) -> Sequence[str]:
        """Return the possible seeds for an exercise: the deployed ones, or random ones."""
        drawn = (seed_of(self.secret, f"variant {i}", exercise, 0) for i in range(DRAWN))
        return self.deployed[exercise] or tuple(drawn)

    def file(self) -> BundledFile:
        """Return the file with the secret and the seeds, for the script on the platform."""
        content = {"secret": self.secret, "deployed": dict(self.deployed)}
        return BundledFile("variants.json", (json.dumps(content, indent=2) + "\n").encode())


def variants_of(exercises: Sequence[Exercise], secret: str) -> BundleVariants:
    """Return the variants for a bundle with these exercises."""
    return BundleVariants(
        secret, {each.id: each.vary.deployed for each in exercises if each.vary is not None}
    )


def platform_seeds(submission: Path, variants: Path | None) -> Mapping[str, str]:
    """Return the seed of a student's variant of each exercise. Raises UnknownStudentError.

    ``submission`` is the file in which a platform describes the submission. ``variants`` is the
    file of the bundle with the secret and the seeds.
    """
    told = _read(submission)
    match told:
        case {"params": {"seeds": dict(seeds)}}:
            return {str(exercise): str(seed) for exercise, seed in seeds.items()}
        case {"users": [_, *_] as users} if variants is not None:
            numbers = [each["id"] for each in users if isinstance(each, dict) and "id" in each]
            if len(numbers) == len(users) and all(type(each) is int for each in numbers):
                own = _read(variants)
                found = BundleVariants(own["secret"], own["deployed"])
                # All members of a group have the variants of one of them.
                return found.seeds_of(str(min(numbers)))
    raise UnknownStudentError(f"{submission} does not say whose submission it is")


def _read(file: Path) -> Any:
    try:
        return json.loads(file.read_bytes())
    except (OSError, ValueError) as error:
        raise UnknownStudentError(f"{file} cannot be read: {error}") from error
