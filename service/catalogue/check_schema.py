"""The checks that an exercise file carries: an answer, and what must become of it."""

from typing import Annotated, Literal

from pydantic import (
    BaseModel,
    ConfigDict,
    Field,
    JsonValue,
    StrictBool,
    StringConstraints,
    model_validator,
)

Text = Annotated[str, StringConstraints(strip_whitespace=True, min_length=1)]


class ExpectSpec(BaseModel):
    """What must become of one part; what is left out may be anything.

    All of ``codes`` must be told, and others may be.
    """

    model_config = ConfigDict(extra="forbid", frozen=True)

    points: Annotated[float, Field(ge=0, strict=True)] | None = None
    verdict: Literal["correct", "partial", "incorrect", "unreadable", "missing"] | None = None
    codes: list[Text] | None = None
    follow_through: StrictBool | None = None

    @model_validator(mode="after")
    def _expects_something(self) -> "ExpectSpec":
        if not self.model_fields_set:
            raise ValueError("expects nothing; write points, verdict, codes or follow_through")
        return self


class CheckSpec(BaseModel):
    """One answer to the exercise, graded whenever the file is checked.

    A part that is answered right, or equivalently, must get full marks unless ``expect`` says
    otherwise; a wrong answer must lose some, in the way that ``expect`` says.
    """

    model_config = ConfigDict(extra="forbid", frozen=True)

    title: Text
    kind: Literal["right", "equivalent", "wrong"]
    answers: Annotated[dict[str, JsonValue], Field(min_length=1)]
    angle_unit: Literal["radians", "degrees"] = "radians"
    expect: dict[str, ExpectSpec] = {}

    @model_validator(mode="after")
    def _says_what_is_wrong(self) -> "CheckSpec":
        if self.kind == "wrong" and not self.expect:
            raise ValueError(
                "a wrong answer needs an expectation, or it may be wrong for another reason than "
                'you think; write expect.PART = { points = …, verdict = "…", codes = ["…"] }'
            )
        return self
