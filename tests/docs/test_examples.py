"""The code on the pages runs as it stands, and does what the text around it says."""

from __future__ import annotations

import re
import runpy
from collections.abc import Iterator
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from registries import restored_registries
from warpsph_kernels.materials import LAWS
from warpsph_kernels.smoothing import SMOOTHING_KERNELS

from warpsph import Simulation, register_material
from warpsph.laws.materials import MATERIAL_LAWS
from warpsph.scene import scene_from_yaml

ROOT = Path(__file__).parents[2]


def blocks(page: str, language: str) -> list[str]:
    return re.findall(rf"^```{language}\n(.*?)^```$", (ROOT / page).read_text(), re.DOTALL | re.MULTILINE)


def execute(page: str) -> dict[str, Any]:
    """Names after all Python blocks of a page, run in order like one program."""
    names: dict[str, Any] = {}
    for number, block in enumerate(blocks(page, "python"), start=1):
        exec(compile(block, f"{page}, block {number}", "exec"), names)
    return names


@pytest.fixture(scope="module")
def names(tmp_path_factory: pytest.TempPathFactory) -> dict[str, Any]:
    with pytest.MonkeyPatch.context() as patch:
        patch.chdir(tmp_path_factory.mktemp("python_page"))
        return execute("docs/python.md")


def test_a_scene_survives_its_own_text(names: dict[str, Any]) -> None:
    assert names["same"] == names["scene"]
    assert names["finer"].spacing == 0.025
    assert names["shipped"].name == "dam_break_2d"


def test_a_single_step_advances(names: dict[str, Any]) -> None:
    assert names["report"].dt > 0.0
    assert names["displacement"] > 0.0


def test_a_shared_array_is_no_copy(names: dict[str, Any]) -> None:
    fresh = names["Simulation"](names["scene"], device="cpu")
    array = fresh.array("position")
    assert np.shares_memory(np.from_dlpack(array), array.numpy())


def test_frame_callbacks_hear_every_frame_time(names: dict[str, Any]) -> None:
    assert names["times"] == [k / 20.0 for k in range(9)]


def test_steps_add_up_to_the_simulated_time(names: dict[str, Any]) -> None:
    assert sum(names["steps"]) == pytest.approx(names["scene"].time.end, rel=1e-12)


def test_probes_in_memory_and_on_disk_agree(names: dict[str, Any]) -> None:
    """The front probe adds half a spacing to the foremost particle; here no spray runs ahead of the body."""
    half_spacing = 0.5 * names["scene"].spacing
    assert names["front_over_time"] == pytest.approx(np.array(names["fronts"]) + half_spacing, rel=1e-12)


def imported(page: str, directory: Path) -> dict[str, Any]:
    """As `execute`, from a file: Warp compiles device code from its source."""
    (directory / "blocks.py").write_text("\n".join(blocks(page, "python")))
    return runpy.run_path(str(directory / "blocks.py"))


def test_the_law_of_the_materials_page_conserves_energy(tmp_path: Path) -> None:
    """Its stress is the derivative of its energy: at cfl 0.4 the balance holds to a per cent."""
    try:
        names = imported("docs/materials.md", tmp_path)
    finally:
        for registry in (LAWS, MATERIAL_LAWS):
            registry.pop("penalised_volume", None)
    assert names["stored"] > 0.1 * names["start"].kinetic_energy
    assert abs(names["drift"]) < 0.01


def test_a_law_is_registered_once() -> None:
    with pytest.raises(ValueError, match="there is a 'neo_hookean' already"):
        register_material("neo_hookean", LAWS["neo_hookean"])


def test_the_output_page_lists_every_entry_of_the_summary(names: dict[str, Any]) -> None:
    page = (ROOT / "docs/output.md").read_text()
    assert [key for key in names["summary"] if f"`{key}`" not in page] == []


def test_the_readme_python_example_runs(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.chdir(tmp_path)
    assert execute("README.md")["sim"].time == 0.5


def test_the_readme_scene_loads() -> None:
    text, _ = blocks("README.md", "yaml")
    assert scene_from_yaml(text).references


def test_the_pillar_of_the_readme_scene_may_be_a_structure() -> None:
    text, pillar = blocks("README.md", "yaml")
    wall = re.search(r"^  pillar:\n.*?\n(?=probes:)", text, re.DOTALL | re.MULTILINE)
    assert wall
    text = text.replace(wall[0], "").replace("boundary: pillar", "structure: pillar") + pillar
    sim = Simulation(scene_from_yaml(text, overrides=["spacing=0.05"]), device="cpu")
    sim.advance(0.02)
    assert {kind for _, kind, _ in sim.sets} == {"fluid", "boundary", "structure"}


@pytest.fixture(scope="module")
def own_formulas(tmp_path_factory: pytest.TempPathFactory) -> Iterator[dict[str, Any]]:
    """Names after the blocks of the page on formulas, run as one file: Warp reads their source."""
    file = tmp_path_factory.mktemp("formulas") / "own_formulas.py"
    file.write_text("\n\n".join(blocks("docs/extending.md", "python")))
    with restored_registries():
        yield runpy.run_path(str(file))


def test_own_formulas_run(own_formulas: dict[str, Any]) -> None:
    sim = own_formulas["sim"]
    water = sim.frame(["density", "pressure", "velocity"]).sets[0].fields
    strain = water["density"] / 1000.0 - 1.0
    expected = 1000.0 * sim.sound_speed**2 * strain * (1.0 + 2.0 * strain)
    assert sim.time == 0.2
    assert np.abs(water["velocity"]).max() > 0.5
    # The deviation is stored in single precision beside a density of 1000.
    assert water["pressure"] == pytest.approx(expected, rel=1e-4, abs=1e-6 * expected.max())


def test_an_own_kernel_is_normalised(own_formulas: dict[str, Any]) -> None:
    """Norm of Wendland's C6: 39 / 14 pi in 2D and 1365 / 512 pi in 3D for a support of 2 h (Dehnen & Aly 2012)."""
    kernel = SMOOTHING_KERNELS["wendland_c6"]
    assert kernel.alpha[2] == pytest.approx(78.0 / (28.0 * np.pi), rel=1e-9)
    assert kernel.alpha[3] == pytest.approx(1365.0 / (512.0 * np.pi), rel=1e-9)


def test_a_scene_with_own_formulas_survives_its_text(own_formulas: dict[str, Any]) -> None:
    scene = own_formulas["scene"]
    assert scene_from_yaml(scene.to_yaml()) == scene
