"""Checks of everything that is neither a set of particles nor compared: time, domain, numerics, output."""

from __future__ import annotations

from collections.abc import Collection, Iterator, Mapping
from typing import TYPE_CHECKING

from warpsph.laws.states import BUILT_IN_STATES, STATE_LAWS
from warpsph.laws.viscosities import VISCOSITY_LAWS
from warpsph.scene.checks.common import expression_problems, no_such_axis, repeated_problems
from warpsph.scene.errors import Problem
from warpsph.scene.types import AXES

if TYPE_CHECKING:
    from warpsph.laws.states import StateLaw
    from warpsph.laws.viscosities import ViscosityLaw
    from warpsph.scene.fluid_models import CustomState, CustomViscosity, NewtonianLaw
    from warpsph.scene.schema import Scene

MAX_FRAMES = 100_000
MAX_PROBE_SAMPLES = 10_000_000
CELLS_A_PERIOD = 3
"""The search looks into a cell and the next on either side, which have to be three different ones."""


def settings_problems(scene: Scene) -> Iterator[Problem]:
    """What is wrong with time, numerics and output."""
    yield from _time_problems(scene)
    yield from _numerics_problems(scene)
    yield from repeated_problems("output.fields", scene.output.fields)
    yield from _shear_problems(scene)
    yield from _recording_problems(scene)
    if "age" in scene.output.fields and not scene.open_boundaries:
        message = "all fluid has the age of the run: the scene has no open boundaries"
        yield Problem.at("output.fields", message, "fields without age")


def _recording_problems(scene: Scene) -> Iterator[Problem]:
    """Recordings of a flow that is not there, or that begin after the end."""
    statistics, paths = scene.output.statistics, scene.output.paths
    starts = {f"output.paths.{name}.at": path.at for name, path in paths.items()}
    if statistics:
        starts["output.statistics.start"] = statistics.start
        if any(low > high for low, high in zip(statistics.min, statistics.max, strict=False)):
            message = f"a corner of the grid is not below {list(statistics.max)}"
            yield Problem.at("output.statistics.min", message, "at most max", list(statistics.min))
    for key, start in starts.items():
        if start > scene.time.end:
            yield Problem.at(key, f"the run ends at {scene.time.end:g} s", "a time of the run [s]", start)
    if starts and not scene.fluids:
        message = "it records fluids, of which the scene has none"
        yield Problem.at(next(iter(starts)).rpartition(".")[0], message, "a scene with a fluid")


def _shear_problems(scene: Scene) -> Iterator[Problem]:
    """A wall shear stress where no wall has one."""
    if "wall_shear_stress" not in scene.output.fields:
        return
    key, viscosity = "output.fields", scene.numerics.viscosity.type
    if viscosity not in _NEED_VISCOSITY:
        message = f"wall_shear_stress needs the viscosity of the fluid, which {viscosity} does not know"
        yield Problem.at(key, message, "numerics.viscosity.type: " + " or ".join(_NEED_VISCOSITY))
        return
    slips = [wall.slip for wall in scene.boundaries.values()] + [s.slip for s in scene.structures.values()]
    if "no_slip" not in slips:
        message = "nothing is sheared: no wall and no structure has slip: no_slip"
        yield Problem.at(key, message, "fields without wall_shear_stress")


def _time_problems(scene: Scene) -> Iterator[Problem]:
    end = scene.time.end
    frames = end * scene.time.frame_rate
    if frames > MAX_FRAMES:
        message = f"{end:g} s at this rate need {frames:.3g} frames; a run writes at most {MAX_FRAMES}"
        yield Problem.at(
            "time.frame_rate", message, f"at most {MAX_FRAMES / end:g} 1/s", scene.time.frame_rate
        )
    samples = end * (scene.output.probe_rate or 0.0)
    if samples > MAX_PROBE_SAMPLES:
        message = f"{end:g} s at this rate need {samples:.3g} probe samples"
        yield Problem.at(
            "output.probe_rate", message, f"at most {MAX_PROBE_SAMPLES / end:g} 1/s", scene.output.probe_rate
        )


def domain_problems(scene: Scene) -> Iterator[Problem]:
    """What is wrong with the domain, wherever the particles are."""
    for axis, (low, high) in scene.domain.periodic.items():
        key = f"domain.periodic.{axis}"
        if axis not in AXES[: scene.dimension]:
            yield no_such_axis(key, axis, scene.dimension)
        elif low >= high:
            yield Problem.at(
                key, f"low {low:g} is not below high {high:g}", "[low, high] with low < high", [low, high]
            )
        elif high - low < (shortest := CELLS_A_PERIOD * scene.search_radius):
            message = f"the period {high - low:g} m is too short for the neighbour search"
            allowed = f"at least {CELLS_A_PERIOD} times the support radius with its skin, {shortest:g} m"
            yield Problem.at(key, message, allowed)


_MIRRORED: Mapping[str, frozenset[str]] = {
    "density": frozenset({"continuity"}),
    "density_diffusion": frozenset({"none", "molteni_colagrossi", "fourtakas"}),
    "viscosity": frozenset({"none", "artificial", "laminar"}),
    "kernel_gradient": frozenset({"plain"}),
    "particle_order": frozenset({"none"}),
    "wall": frozenset({"dynamic", "extrapolated", "repulsive"}),
}
"""Models that read of a neighbour only what its image carries: position, velocity, volume, pressure, density."""


def _unmirrored_problems(scene: Scene) -> Iterator[Problem]:
    for key, mirrored in _MIRRORED.items():
        model = getattr(scene.numerics, key, None)
        name = getattr(model, "type", model)
        if name is not None and name not in mirrored and (key != "wall" or scene.boundaries):
            message = "at planes of symmetry it would need more of the images than they carry"
            yield Problem.at(f"numerics.{key}", message, ", ".join(sorted(mirrored)), name)


def symmetry_problems(scene: Scene) -> Iterator[Problem]:
    """Planes of symmetry along axes that do not exist or wrap round, or too close to each other."""
    planes = scene.domain.symmetry
    if planes:
        yield from _unmirrored_problems(scene)
    for face, coordinate in planes.items():
        key, axis = f"domain.symmetry.{face}", face[0]
        if axis not in AXES[: scene.dimension]:
            yield no_such_axis(key, face, scene.dimension)
        elif axis in scene.domain.periodic:
            yield Problem.at(key, f"{axis} is a periodic axis", "planes across axes that do not wrap round")
        elif face.endswith("max") and f"{axis}_min" in planes:
            nearest = 2.0 * scene.search_radius
            if coordinate - planes[f"{axis}_min"] < nearest:  # type: ignore[index]
                message = f"it is too close to {axis}_min for the neighbour search"
                allowed = f"at least twice the support radius with its skin, {nearest:g} m, from it"
                yield Problem.at(key, message, allowed, coordinate)


def _numerics_problems(scene: Scene) -> Iterator[Problem]:
    numerics = scene.numerics
    if numerics.sound_speed != "auto" and numerics.expected_speed is not None:
        yield Problem.at(
            "numerics.expected_speed",
            f"it has no effect beside a given sound_speed of {numerics.sound_speed:g} m/s",
            "expected_speed with sound_speed: auto, or sound_speed alone",
            numerics.expected_speed,
        )
    if numerics.pressure_form == "riemann" and numerics.viscosity.type == "artificial":
        message = "the Riemann solver of pressure_form: riemann takes the place of an artificial viscosity"
        yield Problem.at("numerics.viscosity.type", message, "any other viscosity, or none", "artificial")
    if numerics.density == "summation" and getattr(numerics.particle_order, "density_follows", False):
        message = "a summed density follows every particle"
        yield Problem.at("numerics.particle_order.density_follows", message, "false", True)
    if numerics.density == "summation" and numerics.density_diffusion.type != "none":
        message = "a density that is summed obeys no equation that could be diffused"
        yield Problem.at("numerics.density_diffusion.type", message, "none", numerics.density_diffusion.type)
    if numerics.pressure_form == "riemann" and numerics.kernel_gradient == "finite_particle":
        message = "the finite-particle form takes the place of the pressure force, which riemann is a form of"
        yield Problem.at(
            "numerics.kernel_gradient", message, "plain or renormalised", numerics.kernel_gradient
        )
    if numerics.state.type == "custom":
        yield from _custom_problems("numerics.state", numerics.state, STATE_LAWS, BUILT_IN_STATES)
    if numerics.viscosity.type == "custom":
        yield from _custom_problems("numerics.viscosity", numerics.viscosity, VISCOSITY_LAWS, ())
    yield from _viscosity_problems(scene)


def _custom_problems(
    key: str,
    model: CustomState | CustomViscosity,
    laws: Mapping[str, StateLaw] | Mapping[str, ViscosityLaw],
    built_in: Collection[str],
) -> Iterator[Problem]:
    added = [name for name in laws if name not in built_in]
    if model.law not in added:
        allowed = ", ".join(added) or "none is registered"
        yield Problem.at(f"{key}.law", "no such law has been registered", allowed, model.law)
    elif set(model.parameters) != set(laws[model.law].parameters):
        allowed = ", ".join(laws[model.law].parameters) or "no parameters"
        message = f"these are not the parameters of {model.law}"
        yield Problem.at(f"{key}.parameters", message, allowed, dict(model.parameters))


_NEED_VISCOSITY = ("laminar", "sub_particle_scale")


def _viscosity_problems(scene: Scene) -> Iterator[Problem]:
    viscosity = scene.numerics.viscosity
    if viscosity.type == "viscous_stress" and viscosity.law.type == "newtonian":
        yield from _newtonian_problems(scene, viscosity.law)
    elif viscosity.type in _NEED_VISCOSITY:
        yield from _missing_viscosity(scene, f"{viscosity.type} viscosity")


def _newtonian_problems(scene: Scene, law: NewtonianLaw) -> Iterator[Problem]:
    key = "numerics.viscosity.law"
    if law.viscosity is not None:
        yield from expression_problems(f"{key}.viscosity", law.viscosity, AXES[: scene.dimension])
        if law.largest is None:
            message = "a viscosity that varies needs a cap, which limits the step"
            yield Problem.at(f"{key}.largest", message, "a number greater than 0, Pa s")
    elif law.largest is not None:
        message = "it has no effect without a viscosity that varies"
        yield Problem.at(f"{key}.largest", message, "null", law.largest)
    else:
        yield from _missing_viscosity(scene, "a newtonian viscous_stress")


def _missing_viscosity(scene: Scene, what: str) -> Iterator[Problem]:
    for name, fluid in scene.fluids.items():
        if fluid.kinematic_viscosity == 0.0:
            key = f"fluids.{name}.kinematic_viscosity"
            yield Problem.at(key, f"{what} needs it", "a number greater than 0, m2/s")
