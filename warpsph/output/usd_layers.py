"""The USD description of particle sets: prims, attributes and their values, as layers."""

from collections.abc import Mapping, Sequence

import numpy as np
from pxr import Sdf, Usd, UsdGeom, Vt

from warpsph.frame import SetFrame, field_unit
from warpsph.scene.schema import Scene

GEOMETRY_TYPES: dict[str, Sdf.ValueTypeName] = {
    "points": Sdf.ValueTypeNames.Point3fArray,
    "velocities": Sdf.ValueTypeNames.Vector3fArray,
    "widths": Sdf.ValueTypeNames.FloatArray,
    "ids": Sdf.ValueTypeNames.Int64Array,
    "extent": Sdf.ValueTypeNames.Float3Array,
}
PRIMVAR_TYPES: dict[type, Sdf.ValueTypeName] = {
    Vt.FloatArray: Sdf.ValueTypeNames.FloatArray,
    Vt.Vec3fArray: Sdf.ValueTypeNames.Vector3fArray,
    Vt.Matrix3dArray: Sdf.ValueTypeNames.Matrix3dArray,
}
GEOMETRY_UNITS = {"points": "m", "velocities": "m/s", "widths": "m", "ids": "1", "extent": "m"}
NOT_PRIMVARS = {"position", "velocity", "id"}
COLOURS = {"fluid": (0.15, 0.4, 0.75), "boundary": (0.55, 0.55, 0.55), "structure": (0.85, 0.5, 0.2)}


def set_path(scene: Scene, particle_set: SetFrame) -> Sdf.Path:
    """Prim of a particle set, below the default prim that carries the scene's name."""
    return Sdf.Path.absoluteRootPath.AppendChild(scene.name).AppendChild(particle_set.name)


def is_fixed(scene: Scene, particle_set: SetFrame) -> bool:
    """Whether the set's particles never move, so that their geometry is written only once."""
    boundary = scene.boundaries.get(particle_set.name)
    return particle_set.kind == "boundary" and boundary is not None and not boundary.motion


def primvars_of(particle_set: SetFrame, scene: Scene) -> list[str]:
    """Fields of the set that the scene asks for beside position, velocity and id, in the scene's order."""
    return [f for f in scene.output.fields if f in particle_set.fields and f not in NOT_PRIMVARS]


def geometry_values(particle_set: SetFrame, spacing: float) -> dict[str, object]:
    """points, velocities, widths, ids and extent of a set as USD arrays; a plane lies at z = 0."""
    return {
        "velocities": field_value(particle_set.fields["velocity"]),
        "ids": Vt.Int64Array.FromNumpy(np.ascontiguousarray(particle_set.fields["id"], dtype=np.int64)),
        **_bounded_points(particle_set, spacing),
    }


def sample_values(particle_set: SetFrame, spacing: float, scene: Scene) -> dict[str, object]:
    """Values by attribute name that a frame adds: all of a moving set, fields and extent of a fixed one."""
    samples = {f"primvars:{f}": field_value(particle_set.fields[f]) for f in primvars_of(particle_set, scene)}
    if is_fixed(scene, particle_set):
        return {"extent": _bounded_points(particle_set, spacing)["extent"], **samples}
    return geometry_values(particle_set, spacing) | samples


def field_value(values: np.ndarray) -> object:
    """A scalar (n,), vector (n, dimension) or tensor (n, dimension, dimension) field as a USD array.

    Tensors are matrices of three rows in double precision: USD has no other, and Houdini takes them as they are.
    """
    if values.ndim == 1:
        return Vt.FloatArray.FromNumpy(np.ascontiguousarray(values, dtype=np.float32))
    if values.ndim == 3:
        return Vt.Matrix3dArray.FromNumpy(_three_by_three(values))
    return Vt.Vec3fArray.FromNumpy(_three_components(values))


def new_layer() -> Sdf.Layer:
    """An empty layer in memory that will be saved as a crate file."""
    return Sdf.Layer.CreateAnonymous(".usdc")


def prims_layer(sets: Sequence[SetFrame], spacing: float, scene: Scene) -> Sdf.Layer:
    """Layer that defines every set with all its attributes, and holds the geometry of the fixed ones."""
    layer = new_layer()
    stage = Usd.Stage.Open(layer)
    UsdGeom.Xform.Define(stage, f"/{scene.name}")
    for particle_set in sets:
        points = UsdGeom.Points.Define(stage, set_path(scene, particle_set))
        points.GetPrim().SetCustomDataByKey("kind", particle_set.kind)
        fixed_values = geometry_values(particle_set, spacing) if is_fixed(scene, particle_set) else {}
        _define_geometry(points.GetPrim(), fixed_values)
        _define_primvars(points, particle_set, scene)
    set_stage_metadata(layer, scene)
    return layer


def set_stage_metadata(layer: Sdf.Layer, scene: Scene) -> None:
    """Units, up axis, rate and default prim: what a root layer must say."""
    layer.defaultPrim = scene.name
    layer.documentation = scene.description
    layer.timeCodesPerSecond = layer.framesPerSecond = scene.time.frame_rate
    stage = Usd.Stage.Open(layer)
    UsdGeom.SetStageMetersPerUnit(stage, UsdGeom.LinearUnits.meters)
    UsdGeom.SetStageUpAxis(stage, up_axis(scene.gravity))


def up_axis(gravity: Sequence[float]) -> str:
    """Z where gravity acts mostly along z or space has no gravity, otherwise Y; USD knows no other."""
    strongest = int(np.argmax(np.abs(gravity))) if np.any(gravity) else len(gravity) - 1
    return UsdGeom.Tokens.z if strongest == 2 else UsdGeom.Tokens.y


def add_samples(layer: Sdf.Layer, path: Sdf.Path, values: Mapping[str, object], time_code: float) -> None:
    """Author values by attribute name at one time, below a prim that the layer need not define."""
    for name, value in values.items():
        attribute = declare_attribute(layer, path, name, value)
        layer.SetTimeSample(attribute, time_code, value)


def declare_attribute(layer: Sdf.Layer, path: Sdf.Path, name: str, value: object) -> Sdf.Path:
    """Make sure that the layer has an attribute that can hold `value`; returns its path."""
    attribute = path.AppendProperty(name)
    if not layer.GetAttributeAtPath(attribute):
        type_name = GEOMETRY_TYPES.get(name) or _primvar_type(value)
        Sdf.JustCreatePrimAttributeInLayer(layer, attribute, type_name)
    return attribute


def _bounded_points(particle_set: SetFrame, spacing: float) -> dict[str, object]:
    points = field_value(particle_set.fields["position"])
    widths = Vt.FloatArray.FromNumpy(np.full(particle_set.count, spacing, dtype=np.float32))
    return {"points": points, "widths": widths, "extent": UsdGeom.Points.ComputeExtent(points, widths)}


def _define_geometry(prim: Usd.Prim, values: Mapping[str, object]) -> None:
    for name, type_name in GEOMETRY_TYPES.items():
        attribute = prim.CreateAttribute(name, type_name, custom=False)
        _state_unit(attribute, name, GEOMETRY_UNITS[name])
        if name in values:
            attribute.Set(values[name])


def _define_primvars(points: UsdGeom.Points, particle_set: SetFrame, scene: Scene) -> None:
    primvars = UsdGeom.PrimvarsAPI(points)
    for name in primvars_of(particle_set, scene):
        type_name = _primvar_type(field_value(particle_set.fields[name][:0]))
        primvar = primvars.CreatePrimvar(name, type_name, UsdGeom.Tokens.vertex)
        _state_unit(primvar.GetAttr(), name, field_unit(name, scene.dimension))
    points.CreateDisplayColorAttr([COLOURS[particle_set.kind]])


def _state_unit(attribute: Usd.Attribute, name: str, unit: str) -> None:
    attribute.SetDocumentation(f"{name} [{unit}]")
    attribute.SetCustomDataByKey("unit", unit)


def _primvar_type(value: object) -> Sdf.ValueTypeName:
    return next(name for array, name in PRIMVAR_TYPES.items() if isinstance(value, array))


def _three_components(vectors: np.ndarray) -> np.ndarray:
    padded = np.zeros((len(vectors), 3), dtype=np.float32)
    padded[:, : vectors.shape[1]] = vectors
    return padded


def _three_by_three(tensors: np.ndarray) -> np.ndarray:
    padded = np.zeros((len(tensors), 3, 3))
    padded[:, : tensors.shape[1], : tensors.shape[2]] = tensors
    return padded
