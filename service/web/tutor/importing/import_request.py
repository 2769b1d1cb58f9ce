"""Make the text of an exercise file from a URDF file or a pasted DH table, for the editor."""

from dataclasses import replace
from http import HTTPStatus
from typing import Annotated, Final, Literal

from pydantic import BaseModel, ConfigDict, Field, TypeAdapter

from service.api.http.problems import ProblemError, message_of
from service.catalogue import ID_ADVICE, is_exercise_id
from service.expressions import AngleUnit
from service.importing.robot_import import (
    ImportedRobot,
    ImportOptions,
    RefusedRobotError,
    imported_table,
    imported_urdf,
)
from service.kinematics.dh import Convention
from service.submissions.strict_json import MAX_BODY_SIZE
from service.translations import ENGLISH, Language, say, told

_Name = Annotated[str, Field(max_length=200)]
_ROBOT: Final = TypeAdapter(ImportedRobot)


class ImportRequest(BaseModel):
    """A robot as text (URDF or a DH table), and the author's choices."""

    model_config = ConfigDict(extra="forbid")

    kind: Literal["urdf", "table"]
    text: Annotated[str, Field(max_length=MAX_BODY_SIZE)]
    id: _Name
    title: _Name = ""
    base: _Name = ""
    tip: _Name = ""
    letters: bool = False
    convention: Convention | None = None
    order: _Name = ""
    unit: _Name = ""
    angles: Literal["", AngleUnit] = ""


def imported(body: ImportRequest, language: Language = ENGLISH) -> bytes:
    """Return the exercise file for a robot, or questions about it, as JSON. Raises ProblemError."""
    if not is_exercise_id(body.id):
        raise _refused(say("This cannot be the id of an exercise: {advice}.", advice=ID_ADVICE))
    options = ImportOptions(
        title=body.title or body.id,
        source="Imported from a URDF file" if body.kind == "urdf" else "Imported from a DH table",
        convention=body.convention,
        base=body.base,
        tip=body.tip,
        letters=body.letters,
        order=body.order,
        unit=body.unit,
        angles=body.angles,
    )
    try:
        if body.kind == "urdf":
            found = imported_urdf(body.text.encode(), options)
        else:
            found = imported_table(body.text, options)
    except RefusedRobotError as error:
        reason = told(message_of(error), language.translation).rstrip(".。")
        raise _refused(say("{reason}.", reason=f"{reason[:1].upper()}{reason[1:]}")) from error
    remarks = [told(each, language.translation) for each in found.remarks]
    questions = [
        replace(each, text=told(each.text, language.translation)) for each in found.questions
    ]
    return _ROBOT.dump_json(replace(found, remarks=remarks, questions=questions))


def _refused(detail: str) -> ProblemError:
    return ProblemError(
        HTTPStatus.UNPROCESSABLE_ENTITY,
        detail,
        "unusable-robot",
        say("The robot cannot become an exercise"),
    )
