"""The bodies of previews, which show how a text is read while the student types."""

from typing import Annotated, Any, Final, Literal

from pydantic import (
    BaseModel,
    ConfigDict,
    Field,
    PlainSerializer,
    SerializationInfo,
    ValidatorFunctionWrapHandler,
    WrapValidator,
)

from service.expressions import Kind
from service.translations import Sentence, told


def _kept(text: Any, validated: ValidatorFunctionWrapHandler) -> Any:
    return text if isinstance(text, Sentence) else validated(text)


def _told(text: str, info: SerializationInfo) -> str:
    return told(text, info.context)


# A sentence that is told when its model is written: ``model_dump_json(context=translation)``.
ToldText = Annotated[str, WrapValidator(_kept), PlainSerializer(_told)]


class PreviewRequest(BaseModel):
    """A text and its place in an exercise."""

    model_config = ConfigDict(extra="forbid", frozen=True)

    text: str = Field(description="One entry as typed by the student, or a pasted table or matrix.")
    exercise: str | None = Field(
        None,
        description="The exercise whose symbols the text may use. Default: joint angles theta1 "
        "(or q1) to theta9, link twists alpha1 to alpha9, lengths a1, d1, l1 to a9, d9, l9.",
    )
    part: str | None = Field(None, description="The part that it answers; requires `exercise`.")
    angle_unit: Literal["radians", "degrees"] = Field(
        "radians", description="The unit of angles without a unit."
    )
    quantity: Kind = Field(
        "number", description="The expected quantity; it matters for numbers in degrees."
    )


class PreviewNote(BaseModel):
    """A note on how the text was read; ``span`` is the range [from, to) in the text."""

    # The fields are read from the attributes of the reader's notes and errors.
    model_config = ConfigDict(from_attributes=True)

    code: str
    message: ToldText
    span: tuple[int, int]


class PreviewError(PreviewNote):
    """The reason why the text cannot be read."""

    suggestion: str | None = Field(None, description="The whole text after a repair.")


class PreviewCell(BaseModel):
    """The reading of one cell of a pasted table or matrix; labels are those of a report."""

    model_config = ConfigDict(from_attributes=True)

    row: str
    column: str
    span: tuple[int, int] = Field(description="[from, to) in the pasted text.")
    typed: str
    entry: str = Field(
        description="The text that has the same meaning in a single cell. It differs from `typed` "
        "if a header names a unit."
    )
    text: str
    latex: str
    mathml: str
    symbols: list[str]
    notes: list[PreviewNote]
    error: PreviewError | None = Field(None, validation_alias="problem")


class PreviewAnswer(BaseModel):
    """The reading of the text, or the reason why it cannot be read.

    For one entry it has `text`, `latex`, `mathml` and `symbols`, or only `error`. For a pasted
    table or matrix it has `rows` of cells, and `ok` is true if every cell is readable.
    """

    ok: bool
    rows: list[list[PreviewCell]] | None = Field(
        None, description="The cells of a pasted table or matrix; requires `exercise` and `part`."
    )
    text: str | None = None
    latex: str | None = None
    mathml: str | None = None
    symbols: list[str] | None = Field(None, description="The symbols used, by canonical name.")
    notes: list[PreviewNote] | None = None
    error: PreviewError | None = None


class EntryToPreview(BaseModel):
    """One of several entries and its expected quantity."""

    model_config = ConfigDict(extra="forbid", frozen=True)

    text: str = Field(description="The entry as typed by the student.")
    quantity: Kind = Field("number", description="The expected quantity.")


# The number of entries in the link transforms of the longest robot in an exercise.
MAX_ENTRIES: Final = 192


class PreviewManyRequest(BaseModel):
    """The changed entries of one part."""

    model_config = ConfigDict(extra="forbid", frozen=True)

    exercise: str = Field(description="The exercise whose symbols the entries may use.")
    part: str = Field(description="The part that the entries answer.")
    angle_unit: Literal["radians", "degrees"] = Field(
        "radians", description="The unit of angles without a unit."
    )
    entries: list[EntryToPreview] = Field(max_length=MAX_ENTRIES)


class PreviewManyResponse(BaseModel):
    """The readings in the order of the entries."""

    results: list[PreviewAnswer]
