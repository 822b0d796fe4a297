"""The USD stage: what viewers and validators expect of it."""

from pathlib import Path

import numpy as np
import pytest
from pxr import Usd, UsdGeom, UsdValidation
from sample_frames import FRAME_RATE, SPACING, frame_of, particle_set, tank_scene

from warpsph.frame import Frame, SetFrame
from warpsph.output.usd import UsdStore
from warpsph.output.usd_layers import up_axis
from warpsph.scene.schema import Scene

COUNTS = [40, 37, 0, 12]


@pytest.fixture(params=["running", "finished"])
def stage(request: pytest.FixtureRequest, scene: Scene, tmp_path: Path) -> Usd.Stage:
    """A run of frames with COUNTS fluid particles, opened while it goes on or after its end."""
    store = UsdStore(tmp_path / "particles.usdc", scene)
    store.open()
    for index, count in enumerate(COUNTS):
        store.write(frame_of(scene, index, count))
    if request.param == "finished":
        store.close()
    return Usd.Stage.Open(str(tmp_path / "particles.usdc"))


def points_of(stage: Usd.Stage, name: str) -> UsdGeom.Points:
    return UsdGeom.Points(stage.GetDefaultPrim().GetChild(name))


def in_space(vectors: np.ndarray) -> np.ndarray:
    """Planar vectors with z = 0."""
    return np.pad(vectors, ((0, 0), (0, 3 - vectors.shape[1])))


def test_all_validators_pass_without_error_or_warning(stage):
    validators = UsdValidation.ValidationRegistry().GetOrLoadAllValidators()
    assert len(validators) >= 20
    errors = UsdValidation.ValidationContext(validators).Validate(stage)
    assert [error.GetErrorAsString() for error in errors] == []


def test_stage_says_unit_axis_rate_and_range(stage, scene):
    assert UsdGeom.GetStageMetersPerUnit(stage) == 1.0
    assert UsdGeom.GetStageUpAxis(stage) == ("Y" if scene.dimension == 2 else "Z")
    assert stage.GetTimeCodesPerSecond() == stage.GetFramesPerSecond() == FRAME_RATE
    assert (stage.GetStartTimeCode(), stage.GetEndTimeCode()) == (0.0, 3.0)
    assert stage.GetDefaultPrim().GetName() == scene.name


@pytest.mark.parametrize(
    ("gravity", "axis"),
    [
        ((0.0, -9.81), "Y"),
        ((0.0, -9.81, 0.0), "Y"),
        ((0.0, 0.5, -9.8), "Z"),
        ((9.81, 0.0, 0.0), "Y"),
        ((0.0, 0.0, 0.0), "Z"),
    ],
)
def test_up_is_against_gravity_where_usd_can_say_so(gravity, axis):
    assert up_axis(gravity) == axis


def test_fluid_has_its_values_in_every_frame(stage, scene):
    points = points_of(stage, "water")
    primvars = UsdGeom.PrimvarsAPI(points)
    assert points.GetPointsAttr().GetTimeSamples() == [0.0, 1.0, 2.0, 3.0]
    for index, count in enumerate(COUNTS):
        fields = frame_of(scene, index, count).set_named("water").fields
        np.testing.assert_array_equal(np.array(points.GetIdsAttr().Get(index)).reshape(-1), fields["id"])
        for attribute, field in (("points", "position"), ("velocities", "velocity")):
            values = np.array(points.GetPrim().GetAttribute(attribute).Get(index)).reshape(-1, 3)
            np.testing.assert_array_equal(values, in_space(fields[field]).astype(np.float32))
        for field in ("density", "pressure"):
            values = np.array(primvars.GetPrimvar(field).Get(index)).reshape(-1)
            np.testing.assert_array_equal(values, fields[field].astype(np.float32))


def test_extent_holds_the_spheres_of_every_sample_of_every_set(stage):
    for name in ("water", "tank", "paddle"):
        points = points_of(stage, name)
        assert points.GetExtentAttr().GetTimeSamples() == [0.0, 1.0, 2.0, 3.0]
        for index in range(4):
            expected = UsdGeom.Boundable.ComputeExtentFromPlugins(points, index)
            np.testing.assert_array_equal(points.GetExtentAttr().Get(index), expected)
    low, high = points_of(stage, "tank").GetExtentAttr().Get(0)
    centres = np.array(points_of(stage, "tank").GetPointsAttr().Get(0))
    np.testing.assert_allclose(high - low, np.ptp(centres, axis=0) + SPACING, rtol=1e-5)


def test_particles_are_one_spacing_wide(stage):
    widths = points_of(stage, "water").GetWidthsAttr().Get(1)
    np.testing.assert_allclose(widths, np.full(COUNTS[1], SPACING), rtol=1e-6)


def test_geometry_of_a_fixed_wall_is_stored_once_but_its_fields_in_every_frame(stage):
    tank, paddle = points_of(stage, "tank"), points_of(stage, "paddle")
    for name in ("points", "velocities", "widths", "ids"):
        attribute = tank.GetPrim().GetAttribute(name)
        assert len(attribute.Get()) == 25
        assert attribute.GetNumTimeSamples() == 0
        assert paddle.GetPrim().GetAttribute(name).GetNumTimeSamples() == 4
    assert UsdGeom.PrimvarsAPI(tank).GetPrimvar("pressure").GetAttr().GetNumTimeSamples() == 4


def test_prims_say_what_kind_of_set_they_are(stage):
    kinds = {p.GetName(): p.GetCustomDataByKey("kind") for p in stage.GetDefaultPrim().GetChildren()}
    assert kinds == {"water": "fluid", "tank": "boundary", "paddle": "boundary"}


def test_primvars_are_per_particle_and_state_their_unit(stage):
    for field, unit in (("density", "kg/m3"), ("pressure", "Pa")):
        primvar = UsdGeom.PrimvarsAPI(points_of(stage, "water")).GetPrimvar(field)
        assert primvar.GetInterpolation() == UsdGeom.Tokens.vertex
        assert primvar.GetAttr().GetCustomDataByKey("unit") == unit
        assert unit in primvar.GetAttr().GetDocumentation()


def test_only_the_fields_that_the_scene_names_are_stored(tmp_path):
    scene = tank_scene(2, fields=["mass"])
    store = UsdStore(tmp_path / "particles.usdc", scene)
    store.open()
    store.write(frame_of(scene, 0))
    store.close()
    stage = Usd.Stage.Open(str(tmp_path / "particles.usdc"))
    prim = points_of(stage, "water").GetPrim()
    stored = {primvar.GetPrimvarName() for primvar in UsdGeom.PrimvarsAPI(prim).GetPrimvarsWithValues()}
    assert stored == {"displayColor", "mass"}
    assert prim.GetAttribute("primvars:mass").GetCustomDataByKey("unit") == "kg/m"


@pytest.mark.parametrize("dimension", [2, 3])
def test_tensors_of_structures_are_matrices_of_three_rows(tmp_path, dimension):
    """Stress has three rows in the plane too, strain but two: the third is zero there."""
    fields = ["cauchy_stress", "green_lagrange_strain", "volume_ratio"]
    scene = tank_scene(dimension, fields=fields)
    given = particle_set("water", "structure", 5, dimension, seed=1)
    random = np.random.default_rng(0)
    stress, strain = random.normal(size=(5, 3, 3)), random.normal(size=(5, dimension, dimension))
    values = {"cauchy_stress": stress, "green_lagrange_strain": strain, "volume_ratio": np.ones(5)}
    store = UsdStore(tmp_path / "particles.usdc", scene)
    store.open()
    store.write(Frame(0, 0.0, dimension, 0.1, (SetFrame("water", "structure", {**given.fields, **values}),)))
    store.close()
    stage = Usd.Stage.Open(str(tmp_path / "particles.usdc"))
    primvars = UsdGeom.PrimvarsAPI(points_of(stage, "water"))
    np.testing.assert_array_equal(np.array(primvars.GetPrimvar("cauchy_stress").Get(0.0)), stress)
    stored = np.array(primvars.GetPrimvar("green_lagrange_strain").Get(0.0))
    np.testing.assert_array_equal(stored[:, :dimension, :dimension], strain)
    assert not stored[:, dimension:].any()
    assert str(primvars.GetPrimvar("volume_ratio").GetTypeName()) == "float[]"


def test_last_frame_between_two_frame_times_keeps_its_time(tmp_path, scene):
    store = UsdStore(tmp_path / "particles.usdc", scene)
    store.open()
    for index, time in enumerate((0.0, 1 / FRAME_RATE, 1.25 / FRAME_RATE)):
        store.write(Frame(index, time, scene.dimension, SPACING, frame_of(scene, index).sets))
    store.close()
    stage = Usd.Stage.Open(str(tmp_path / "particles.usdc"))
    assert points_of(stage, "water").GetPointsAttr().GetTimeSamples() == [0.0, 1.0, 1.25]


def resident_memory() -> int:
    """Bytes of this process in memory that are not backed by a file."""
    status = Path("/proc/self/status").read_text()
    return 1024 * int(status.split("RssAnon:")[1].split()[0])


def test_memory_does_not_grow_with_the_frames(tmp_path):
    """Eighty frames, written and packed, need no more memory than a few."""
    scene = tank_scene(3)
    water = particle_set("water", "fluid", 20_000, 3, seed=1)
    bytes_a_frame = 20_000 * 40
    store = UsdStore(tmp_path / "particles.usdc", scene)
    store.open()
    for index in range(80):
        store.write(Frame(index, index / FRAME_RATE, 3, SPACING, (water,)))
        if index == 10:
            before = resident_memory()
    store.close()
    assert resident_memory() - before < 10 * bytes_a_frame
