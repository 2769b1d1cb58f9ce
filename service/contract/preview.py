"""The reading of a text while the student still types."""

from typing import Final, Literal

from pydantic import BaseModel, ConfigDict, Field

from service.expressions import Kind


class PreviewRequest(BaseModel):
    """A text, and the place that it is for."""

    model_config = ConfigDict(extra="forbid", frozen=True)

    text: str = Field(
        description="One entry as the student writes it, or a pasted table or matrix."
    )
    exercise: str | None = Field(
        None,
        description="The exercise whose symbols the text may use. Without it: joint angles theta1 "
        "(or q1) to theta9, link twists alpha1 to alpha9, lengths a1, d1, l1 to a9, d9, l9.",
    )
    part: str | None = Field(None, description="The part that the text is for; needs `exercise`.")
    angle_unit: Literal["radians", "degrees"] = Field(
        "radians", description="What a bare number means where an angle is asked for."
    )
    quantity: Kind = Field(
        "number", description="What is asked for there; matters for a bare number in degrees."
    )


class PreviewNote(BaseModel):
    """Something worth knowing about how the text was read; ``span`` is [from, to) in it."""

    # Its fields are picked from the reader's notes and errors.
    model_config = ConfigDict(from_attributes=True)

    code: str
    message: str
    span: tuple[int, int]


class PreviewError(PreviewNote):
    """The reason why the text cannot be read."""

    suggestion: str | None = Field(None, description="The whole text, repaired.")


class PreviewCell(BaseModel):
    """The reading of one cell of a pasted table or matrix; labels are those of a report."""

    model_config = ConfigDict(from_attributes=True)

    row: str
    column: str
    span: tuple[int, int] = Field(description="[from, to) in the pasted text.")
    typed: str
    entry: str = Field(
        description="What to write in the cell alone for the same reading. It is another text than "
        "`typed` where a header names a unit."
    )
    text: str
    latex: str
    mathml: str
    symbols: list[str]
    notes: list[PreviewNote]
    error: PreviewError | None = Field(None, validation_alias="problem")


class PreviewAnswer(BaseModel):
    """The reading of the text, or the reason why it cannot be read.

    Of one entry there is `text`, `latex`, `mathml` and `symbols`, or only `error`. Of a pasted
    table or matrix there are `rows` of cells; `ok` then says that every cell was read.
    """

    ok: bool
    rows: list[list[PreviewCell]] | None = Field(
        None, description="The cells of a pasted table or matrix; needs `exercise` and `part`."
    )
    text: str | None = None
    latex: str | None = None
    mathml: str | None = None
    symbols: list[str] | None = Field(None, description="The symbols used, by canonical name.")
    notes: list[PreviewNote] | None = None
    error: PreviewError | None = None


class EntryToPreview(BaseModel):
    """One of several entries, and what is asked for in its place."""

    model_config = ConfigDict(extra="forbid", frozen=True)

    text: str = Field(description="The entry as the student writes it.")
    quantity: Kind = Field("number", description="What is asked for there.")


# All entries of the link transforms of the longest robot that an exercise may have.
MAX_ENTRIES: Final = 192


class PreviewManyRequest(BaseModel):
    """The entries of one part that have changed."""

    model_config = ConfigDict(extra="forbid", frozen=True)

    exercise: str = Field(description="The exercise whose symbols the entries may use.")
    part: str = Field(description="The part that the entries are for.")
    angle_unit: Literal["radians", "degrees"] = Field(
        "radians", description="What a bare number means where an angle is asked for."
    )
    entries: list[EntryToPreview] = Field(max_length=MAX_ENTRIES)


class PreviewManyResponse(BaseModel):
    """The reading of each entry, in their order."""

    results: list[PreviewAnswer]
