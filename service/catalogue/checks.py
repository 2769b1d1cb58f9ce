"""The checks of an exercise file, held against its parts."""

from collections.abc import Sequence

from service.catalogue.formulas import FieldError
from service.catalogue.part import PartSpec
from service.catalogue.schema import CheckSpec


def check_parts(checks: Sequence[CheckSpec], parts: Sequence[PartSpec]) -> None:
    """Check that every check names parts of the exercise. Raises FieldError."""
    most = {part.id: part.points for part in parts}
    for i, check in enumerate(checks):
        for field, named in (("answers", check.answers), ("expect", check.expect)):
            for name in named:
                if name not in most:
                    known = ", ".join(most)
                    raise FieldError(
                        f"checks[{i}].{field}.{name}",
                        f"there is no such part; write one of {known}",
                    )
        for name, expected in check.expect.items():
            if expected.points is not None and expected.points > most[name]:
                raise FieldError(
                    f"checks[{i}].expect.{name}.points",
                    f"is more than the part's {most[name]:g} points; write {most[name]:g} or less",
                )
