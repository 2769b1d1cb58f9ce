"""The rules for recorded attempts in an exercise file: how many, when, and the marks if late."""

from typing import Annotated, Literal

from pydantic import AwareDatetime, Field, model_validator

from service.catalogue.files.fields import StrictModel
from service.translations import say

Worth = Annotated[float, Field(ge=0, le=1)]
# The price of each step of a hint, as a share of the points of the exercise.
HintPrices = Annotated[list[Worth], Field(min_length=3, max_length=3)]


class AttemptsSpec(StrictModel):
    """The rules for recorded attempts: their limit, times and late marks."""

    limit: Annotated[int, Field(ge=1, strict=True)] | None = None
    """The most attempts of each learner. Default: no limit. An attempt in which nothing could be
    read does not count."""
    opens: AwareDatetime | None = None
    """The time from which attempts are accepted, with a time zone: 2026-10-01T08:00:00+02:00."""
    due: AwareDatetime | None = None
    """The time until which an attempt earns all its points."""
    closes: AwareDatetime | None = None
    """The time until which late attempts are accepted. Default: none is accepted after ``due``."""
    late_worth: Worth = 0.5
    """The share of its points that a late attempt earns."""
    counts: Literal["best", "last"] = "best"
    """The attempt of a learner that counts: the one with the most points, or the last one."""

    hint_prices: HintPrices | None = None
    """The price of the three steps of a hint, as shares of the points of the exercise:
    [0, 0.05, 0.1]. The hints that a learner takes reduce the points of the later attempts. Default:
    recorded attempts have no hints."""

    @model_validator(mode="after")
    def _in_order(self) -> "AttemptsSpec":
        if self.closes is not None and self.due is None:
            raise ValueError(say("closes says how long late attempts are taken, so it needs due"))
        moments = [moment for moment in (self.opens, self.due, self.closes) if moment is not None]
        if moments != sorted(moments):
            raise ValueError(say("opens, due and closes must follow each other in this order"))
        return self
