"""Numbers, vectors and names from which every part of a scene is built."""

from __future__ import annotations

from typing import Annotated, Any, Literal

from pydantic import (
    AfterValidator,
    AllowInfNan,
    BaseModel,
    ConfigDict,
    Field,
    GetJsonSchemaHandler,
    Strict,
)
from pydantic.json_schema import JsonSchemaValue
from pydantic_core import PydanticCustomError
from pydantic_core.core_schema import CoreSchema

from warpsph.laws.smoothing import SMOOTHING_LAWS


def _require_type(schema: dict[str, Any]) -> None:
    """A file must say the type of a tagged object, though Python's constructors know it."""
    required = schema.get("required", [])
    if "type" in schema.get("properties", {}) and "type" not in required:
        schema["required"] = ["type", *required]


class SceneModel(BaseModel):
    """Base of every object of a scene: immutable, and every key must be known.

    The string below an attribute is its description in the JSON schema.
    """

    model_config = ConfigDict(
        frozen=True, extra="forbid", use_attribute_docstrings=True, json_schema_extra=_require_type
    )


class Components(tuple[float, ...]):
    """Value of a `Vector`: the scene refuses it unless it has one component a dimension."""

    __slots__ = ()


Real = Annotated[float, Strict(), AllowInfNan(False)]
"""A finite number."""

PositiveReal = Annotated[Real, Field(gt=0.0)]
"""A finite number greater than zero."""

NonNegativeReal = Annotated[Real, Field(ge=0.0)]
"""A finite number, zero or greater."""

NonPositiveReal = Annotated[Real, Field(le=0.0)]
"""A finite number, zero or less."""

Integer = Annotated[int, Strict()]
"""A whole number (true and false are not)."""

PositiveInteger = Annotated[Integer, Field(ge=1)]
"""A whole number, one or greater."""

Flag = Annotated[bool, Strict()]
"""true or false."""

Vector = Annotated[tuple[Real, ...], Field(min_length=2, max_length=3), AfterValidator(Components)]
"""As many components as the scene has dimensions."""

Vector2 = tuple[Real, Real]
"""Two components in scenes of either dimension."""

Vector3 = tuple[Real, Real, Real]
"""Three components in scenes of either dimension."""

Axis = Literal["x", "y", "z"]
"""A coordinate axis; z exists in three dimensions only."""

AXES: tuple[Axis, ...] = ("x", "y", "z")

Name = Annotated[str, Field(pattern=r"^[A-Za-z][A-Za-z0-9_]*$")]
"""Name of an object of the scene: safe in columns of CSV files and as a USD prim."""

NAME_RULE = "a letter, then letters, digits and underscores"


Placement = Literal["lattice", "relaxed"]
"""How particles stand at the start."""


class _KnownKernel:
    """Accepts the smoothing kernels that are registered when a scene is made."""

    @staticmethod
    def check(name: str) -> str:
        if name not in SMOOTHING_LAWS:
            raise PydanticCustomError("literal_error", "there is no such kernel")
        return name

    @classmethod
    def __get_pydantic_json_schema__(
        cls, core_schema: CoreSchema, handler: GetJsonSchemaHandler
    ) -> JsonSchemaValue:
        return {"type": "string", "enum": list(SMOOTHING_LAWS)}


KernelName = Annotated[str, Strict(), AfterValidator(_KnownKernel.check), _KnownKernel]
"""A smoothing kernel by its name."""

FileName = Annotated[str, Field(min_length=1)]
"""A file, relative to the directory of the scene file."""
