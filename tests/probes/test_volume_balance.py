"""What has entered is what the fluid has gained, and what flexible walls have given to it."""

from dataclasses import replace

import numpy as np
import pytest
from particles import DENSITY, SPACING, fluid, frame_of, lattice, probe_of, scene_with
from test_structure_probes import SPACING as BEAM_SPACING
from test_structure_probes import beam_scene, body

from warpsph.frame import Inflow
from warpsph.scene.errors import SceneError

MASS = DENSITY * SPACING**2
PATCH = {
    "type": "pressure",
    "shape": {"center": [2.0, 1.0], "normal": [1.0, 0.0], "width": 1.0},
    "pressure": 0.0,
}


def passed(mass: float, counted: float) -> Inflow:
    return Inflow(0.0, mass, counted, 0, 0, 0)


def tank(**probe: object):
    return scene_with({"type": "volume_balance", **probe}, 2, open_boundaries={"inlet": PATCH})


def vessel(line: dict[str, object]):
    """A beam beside water."""
    shape = {"type": "box", "min": [0.0, 0.4], "max": [1.0, 1.0]}
    return beam_scene(
        {"type": "volume_balance", "walls": [line]},
        fluids={"water": {"shape": shape, "density": DENSITY}},
        open_boundaries={"inlet": PATCH},
    )


def water(count: int, in_buffers: int = 0, **fields: np.ndarray):
    patch = np.full(count, -1)
    patch[count - in_buffers :] = 0
    return fluid(lattice([0.0, 0.0], [1.0, 1.0])[:count], patch=patch, **fields)


def test_fluid_between_the_patches_gains_what_enters():
    """Of 60 particles 5 are in a buffer; then there are 70, of which 8 are. The domain has gained 7."""
    probe = probe_of(tank())
    assert [column.partition(".")[2] for column in probe.columns] == [
        *("flux[kg/m]", "counted[kg/m]", "gained[kg/m]", "flux_error[kg/m]", "counted_error[kg/m]")
    ]
    probe.start(frame_of(water(60, 5)))
    after = replace(
        frame_of(water(70, 8)), inflows={"inlet": passed(80.0, 75.0), "outlet": passed(-10.0, -5.0)}
    )
    assert probe.evaluate(after) == pytest.approx((70.0, 70.0, 7 * MASS, 0.0, 0.0))


def test_between_exchanges_a_layer_counts_in_part():
    """A column of particles moves by half a spacing into the domain, and none changes its tag: by the flux the domain
    gains half a particle, and in whole ones nothing."""
    probe = probe_of(tank())
    x = 2.0 + SPACING * (np.arange(16) - 7.5)

    def column(shift: float):
        position = np.column_stack([x + shift, np.full(16, 1.05)])
        return frame_of(fluid(position, patch=np.where(x < 2.0, 0, -1)))

    probe.start(column(0.0))
    moved = replace(column(0.5 * SPACING), inflows={"inlet": passed(0.5 * MASS, 0.0)})
    _, _, gained, flux_error, counted_error = probe.evaluate(moved)
    assert gained == pytest.approx(0.5 * MASS, rel=1e-6)
    assert flux_error == pytest.approx(0.0, abs=1e-6 * MASS)
    assert counted_error == 0.0


def test_what_has_left_the_region_is_missing():
    region = {"min": [0.0, 0.0], "max": [1.0, 0.5]}
    probe = probe_of(tank(region=region))
    position = lattice([0.0, 0.0], [1.0, 0.5])
    inside = fluid(position, patch=np.full(len(position), -1))
    probe.start(frame_of(inside))
    fallen = position - np.array([0.0, 0.15]) * (position[:, :1] < 0.1)
    leaking = replace(
        frame_of(fluid(fallen, patch=inside.fields["patch"])), inflows={"inlet": passed(0.0, 0.0)}
    )
    assert probe.evaluate(leaking)[2:] == pytest.approx((-MASS, -MASS, -MASS))


@pytest.mark.parametrize(
    ("start", "end", "sign"), [((0.2, 0.4), (1.0, 0.4), -1.0), ((1.0, 0.4), (0.2, 0.4), 1.0)]
)
def test_room_that_a_wall_gives_is_the_area_between_its_line_at_rest_and_now(start, end, sign):
    """The top of a beam rises by 0.05 (x - 0.2): a triangle of 0.8 m by 0.04 m, to the left of a line along x. The beam
    becomes no longer in x, so that its line is straight and the area exact to rounding in single precision."""
    line = {"structure": "beam", "start": start, "end": end}
    probe = probe_of(vessel(line))
    assert [c.partition(".")[2] for c in probe.columns[5:]] == [
        "volume[m2]",
        "enclosed[m2]",
        "walls_error[m2]",
    ]
    rest = lattice([0.0, 0.0], [1.0, 0.4], BEAM_SPACING)
    shift = np.column_stack([np.zeros(len(rest)), 0.05 * np.clip(rest[:, 0] - 0.2, 0.0, None)])
    probe.start(frame_of(water(50), body(rest)))
    bent = frame_of(water(50, density=np.full(50, 0.5 * DENSITY)), body(rest, shift))
    volume, enclosed, error = probe.evaluate(bent)[5:]
    assert volume == pytest.approx(50 * SPACING**2)
    # Within 1.5 spacings of the kink the fit mixes both sides: a point there is off by less than 0.05 spacings / 2.
    assert enclosed == pytest.approx(sign * 0.5 * 0.8 * 0.04, abs=2 * BEAM_SPACING * 0.0025)
    assert error == pytest.approx(volume - enclosed)


def test_a_line_beside_the_structure_is_refused():
    line = {"structure": "beam", "start": [0.2, 0.6], "end": [1.0, 0.6]}
    with pytest.raises(SceneError, match=r"probes\.probe\.walls\.0"):
        probe_of(vessel(line)).start(frame_of(water(50), body(lattice([0.0, 0.0], [1.0, 0.4], BEAM_SPACING))))
