"""The same solid from every kind of file; stages with their units, axes and transforms."""

from __future__ import annotations

from collections.abc import Callable
from pathlib import Path

import mesh_builders as build
import numpy as np
import pytest
import trimesh
from pxr import Gf, Usd, UsdGeom

from warpsph.geometry.errors import GeometryError
from warpsph.geometry.mesh import TriangleMesh
from warpsph.geometry.mesh_files import read_mesh

LOW, HIGH = (0.0, 0.0, 0.0), (1.0, 2.0, 3.0)


def extent(mesh: TriangleMesh) -> np.ndarray:
    return np.stack([mesh.vertices.min(axis=0), mesh.vertices.max(axis=0)])


def add_box(stage: Usd.Stage, path: str) -> UsdGeom.Mesh:
    """A box of six quadrilaterals."""
    mesh = UsdGeom.Mesh.Define(stage, path)
    corners = [(x, y, z) for x in (0.0, 1.0) for y in (0.0, 2.0) for z in (0.0, 3.0)]
    quads = [0, 1, 3, 2, 4, 6, 7, 5, 0, 4, 5, 1, 2, 3, 7, 6, 0, 2, 6, 4, 1, 5, 7, 3]
    mesh.CreatePointsAttr(corners)
    mesh.CreateFaceVertexCountsAttr([4] * 6)
    mesh.CreateFaceVertexIndicesAttr(quads)
    return mesh


@pytest.fixture
def saved(tmp_path: Path) -> Callable[..., Path]:
    """Saves a stage that a function fills."""

    def save(fill: Callable[[Usd.Stage], object], up: str = "Z", unit: float = 1.0) -> Path:
        path = tmp_path / "stage.usda"
        stage = Usd.Stage.CreateNew(str(path))
        UsdGeom.SetStageUpAxis(stage, up)
        UsdGeom.SetStageMetersPerUnit(stage, unit)
        fill(stage)
        stage.Save()
        return path

    return save


@pytest.mark.parametrize("suffix", ["stl", "obj", "ply"])
@pytest.mark.parametrize("text", [False, True])
def test_box_from_a_file(tmp_path: Path, suffix: str, text: bool) -> None:
    vertices, faces = build.box(LOW, HIGH)
    kinds = {"stl": "stl_ascii" if text else "stl", "obj": "obj", "ply": "ply"}
    path = tmp_path / f"box.{suffix}"
    options = {"encoding": "ascii"} if text and suffix == "ply" else {}
    trimesh.Trimesh(vertices, faces).export(path, file_type=kinds[suffix], **options)
    mesh, unit = read_mesh(path, None, None)
    assert (mesh.volume, unit) == (pytest.approx(6.0, rel=1e-6), 1.0)
    assert extent(mesh) == pytest.approx(np.array([LOW, HIGH]), abs=1e-6)


def test_faces_of_four_corners_in_an_obj_file(tmp_path: Path) -> None:
    path = tmp_path / "box.obj"
    corners = [(x, y, z) for x in (0, 1) for y in (0, 2) for z in (0, 3)]
    quads = [(1, 2, 4, 3), (5, 7, 8, 6), (1, 5, 6, 2), (3, 4, 8, 7), (1, 3, 7, 5), (2, 6, 8, 4)]
    lines = [f"v {x} {y} {z}" for x, y, z in corners] + ["f " + " ".join(map(str, quad)) for quad in quads]
    path.write_text("mtllib missing.mtl\n" + "\n".join(lines))
    assert read_mesh(path, None, None)[0].volume == pytest.approx(6.0)


def test_stage_with_z_up_stays_as_it_is(saved: Callable[..., Path]) -> None:
    mesh, unit = read_mesh(saved(lambda stage: add_box(stage, "/Box"), unit=0.01), None, None)
    assert (mesh.volume, unit) == (pytest.approx(6.0), 0.01)
    assert extent(mesh) == pytest.approx(np.array([LOW, HIGH]))


@pytest.mark.parametrize(
    ("own", "up", "expected"),
    [
        ("Y", "z", [[0.0, -3.0, 0.0], [1.0, 0.0, 2.0]]),
        ("Y", "y", [LOW, HIGH]),
        ("Z", "y", [[0.0, 0.0, -2.0], [1.0, 3.0, 0.0]]),
    ],
)
def test_up_axis_of_a_stage_becomes_that_of_the_scene(
    saved: Callable[..., Path], own: str, up: str, expected: list[list[float]]
) -> None:
    mesh, _ = read_mesh(saved(lambda stage: add_box(stage, "/Box"), up=own), None, up)
    assert extent(mesh) == pytest.approx(np.array(expected), abs=1e-12)
    assert mesh.volume == pytest.approx(6.0)


def test_transforms_above_a_mesh_count(saved: Callable[..., Path]) -> None:
    def fill(stage: Usd.Stage) -> None:
        above = UsdGeom.Xform.Define(stage, "/World")
        above.AddTranslateOp().Set(Gf.Vec3d(10.0, 0.0, 0.0))
        above.AddRotateZOp().Set(90.0)
        add_box(stage, "/World/Box").AddScaleOp().Set(Gf.Vec3f(2.0, 1.0, 1.0))

    mesh, _ = read_mesh(saved(fill), None, None)
    assert extent(mesh) == pytest.approx(np.array([[8.0, 0.0, 0.0], [10.0, 2.0, 3.0]]), abs=1e-6)


def test_cavities_survive_mirrors_and_left_handed_meshes(saved: Callable[..., Path]) -> None:
    """A mirror turns the winding over, and so does a left-handed mesh; with both of them it is as before."""

    def fill(stage: Usd.Stage) -> None:
        add_box(stage, "/Outer").AddScaleOp().Set(Gf.Vec3f(-4.0, 4.0, 4.0))
        add_box(stage, "/Other").AddTranslateOp().Set(Gf.Vec3d(20.0, 0.0, 0.0))
        inner = add_box(stage, "/Inner")
        inner.AddTranslateOp().Set(Gf.Vec3d(-2.0, 2.0, 2.0))
        inner.CreateOrientationAttr(UsdGeom.Tokens.leftHanded)

    assert read_mesh(saved(fill), None, None)[0].volume == pytest.approx(6.0 * (64.0 + 1.0 - 1.0))


def test_only_what_is_shown_below_the_prim_counts(saved: Callable[..., Path]) -> None:
    def fill(stage: Usd.Stage) -> None:
        for name in ("Here", "There"):
            add_box(stage, f"/World/{name}/Box")
        UsdGeom.Imageable(add_box(stage, "/World/Here/Hidden")).MakeInvisible()
        add_box(stage, "/World/Here/Proxy").CreatePurposeAttr(UsdGeom.Tokens.proxy)

    path = saved(fill)
    assert read_mesh(path, "/World/Here", None)[0].volume == pytest.approx(6.0)
    with pytest.raises(GeometryError, match="no prim /World/Nowhere"):
        read_mesh(path, "/World/Nowhere", None)


def test_instances_count_where_they_stand(saved: Callable[..., Path]) -> None:
    def fill(stage: Usd.Stage) -> None:
        add_box(stage, "/Prototypes/Part/Box")
        for k in range(2):
            instance = UsdGeom.Xform.Define(stage, f"/World/Copy{k}")
            instance.GetPrim().GetReferences().AddInternalReference("/Prototypes/Part")
            instance.GetPrim().SetInstanceable(True)
            instance.AddTranslateOp().Set(Gf.Vec3d(5.0 * k, 0.0, 0.0))

    assert read_mesh(saved(fill), "/World", None)[0].volume == pytest.approx(12.0)


def test_stage_without_a_mesh_is_refused(saved: Callable[..., Path]) -> None:
    with pytest.raises(GeometryError, match="no visible mesh"):
        read_mesh(saved(lambda stage: UsdGeom.Sphere.Define(stage, "/Ball")), None, None)


@pytest.mark.parametrize("suffix", ["stl", "obj", "ply", "usda", "usdc"])
def test_damaged_file_is_refused(tmp_path: Path, suffix: str) -> None:
    path = tmp_path / f"damaged.{suffix}"
    path.write_bytes(b"\x00\x93 nonsense \xff\n" * 20)
    with pytest.raises(GeometryError, match=f"damaged.{suffix}"):
        read_mesh(path, None, None)


def test_keys_of_stages_are_refused_for_other_files(tmp_path: Path) -> None:
    path = tmp_path / "box.stl"
    trimesh.Trimesh(*build.box()).export(path)
    with pytest.raises(GeometryError, match="for USD stages only"):
        read_mesh(path, None, "y")
