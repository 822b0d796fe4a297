"""From a scene and its structures to the rigid bodies among them."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from warpsph.particles.launch import Launcher
from warpsph.physics.rigid import RigidModel
from warpsph.physics.structure import StructureModel
from warpsph.sampling import SampledSet
from warpsph.sampling.kinematics import rigid_motion
from warpsph.scene.errors import Problem, SceneError
from warpsph.scene.rigid import inertia_tensor
from warpsph.scene.schema import Scene
from warpsph.solver.rigid_motion import RigidBody, RigidState, in_space, pose_of, prescribed

LEAST_INERTIA = 1e-9
"""Moment of inertia over mass times squared spacing below which a body has none."""
RIGID = 1e-6
"""Part of the largest initial speed by which particles may move otherwise than the body does."""


@dataclass(frozen=True)
class RigidParts:
    """Rigid bodies, assembled, with their state at time zero."""

    bodies: tuple[RigidBody, ...]
    initial: tuple[RigidState, ...]
    model: RigidModel


def density_of(scene: Scene, sampled: SampledSet) -> float:
    """Density of the particles of a structure [kg/m3]: of its material, or what gives a rigid body its mass."""
    structure = scene.structures[sampled.name]
    if structure.rigid is None or structure.rigid.mass is None:
        return structure.material.density
    return structure.rigid.mass / (len(sampled.position) * sampled.volume)


def assemble_rigid(
    scene: Scene, sets: Sequence[tuple[int, SampledSet]], structures: StructureModel, launcher: Launcher
) -> RigidParts | None:
    """The rigid bodies among structures, which are given with their first particles. Raises SceneError."""
    found = [(first, sampled) for first, sampled in sets if scene.structures[sampled.name].rigid is not None]
    if not found:
        return None
    bodies = tuple(_body(scene, first, sampled) for first, sampled in found)
    initial = tuple(_initial(scene, body, sampled) for body, (_, sampled) in zip(bodies, found, strict=True))
    ranges = [(body.first, body.first + body.count) for body in bodies]
    origins = [body.origin[: scene.dimension] for body in bodies]
    return RigidParts(bodies, initial, RigidModel(launcher, structures, ranges, origins))


def _body(scene: Scene, first: int, sampled: SampledSet) -> RigidBody:
    rigid = scene.structures[sampled.name].rigid
    assert rigid is not None
    key, dim = f"structures.{sampled.name}.rigid", scene.dimension
    position, count = _wide(sampled.position), len(sampled.position)
    mass = density_of(scene, sampled) * sampled.volume * count
    centre = position.mean(axis=0) if rigid.center_of_mass is None else _wide(np.array(rigid.center_of_mass))
    origin = centre if rigid.pivot is None else _wide(np.array(rigid.pivot))
    offset = centre - origin
    inertia = _own_inertia(position, mass) if rigid.inertia is None else inertia_tensor(rigid.inertia)
    inertia = inertia + mass * (offset @ offset * np.eye(3) - np.outer(offset, offset))
    free = rigid.free_axes(dim)
    turns = np.array([f"r{axis}" in free for axis in "xyz"])
    _refuse_weightless(inertia, turns, mass * scene.spacing**2, key)
    return RigidBody(
        name=sampled.name,
        first=first,
        count=count,
        mass=mass,
        origin=origin,
        offset=offset,
        inertia=inertia,
        moves=np.array([axis in free for axis in "xyz"]),
        turns=turns,
        motion=rigid_motion(scene, rigid.motion, f"{key}.motion") if rigid.motion else None,
    )


def _own_inertia(position: np.ndarray, mass: float) -> np.ndarray:
    """Tensor (3, 3) [kg m2] of particles that share a mass [kg], each a point, about their centre."""
    arm = position - position.mean(axis=0)
    second = mass * arm.T @ arm / len(arm)
    return np.trace(second) * np.eye(3) - second


def _refuse_weightless(inertia: np.ndarray, turns: np.ndarray, scale: float, key: str) -> None:
    free = np.flatnonzero(turns)
    if len(free) and np.linalg.eigvalsh(inertia[np.ix_(free, free)])[0] <= LEAST_INERTIA * scale:
        message = "the particles lie on an axis about which the body is free to turn: they do not resist that"
        raise SceneError([Problem.at(f"{key}.inertia", message, "an inertia, or fewer free rotations")])


def _initial(scene: Scene, body: RigidBody, sampled: SampledSet) -> RigidState:
    """The body at time zero: the free velocities are the least-squares fit to those of the particles."""
    position, velocity = _wide(sampled.position), _wide(sampled.velocity)
    state = _fitted(body, position, velocity)
    state = prescribed(body, state, 0.0)
    given = scene.structures[body.name].velocity
    if given is not None:
        pose = in_space(pose_of(body, state, scene.dimension))
        off = float(np.abs(pose.velocity_of(position) - velocity).max())
        if off > RIGID * np.abs(velocity).max():
            message = (
                f"the body cannot begin like this: particles would move otherwise by up to {off:.3g} m/s"
            )
            allowed = "a rigid motion along and about the free axes, with what rigid.motion prescribes"
            raise SceneError([Problem.at(f"structures.{body.name}.velocity", message, allowed, list(given))])
    return state


def _fitted(body: RigidBody, position: np.ndarray, velocity: np.ndarray) -> RigidState:
    """V and omega of the free axes for which sum |V + omega x r_a - v_a|^2 is least."""
    arm = position - body.origin
    fields = [
        *(np.tile(axis, (len(arm), 1)) for axis in np.eye(3)),
        *(np.cross(axis, arm) for axis in np.eye(3)),
    ]
    free = np.concatenate([body.moves, body.turns])
    fit = np.zeros(6)
    if free.any():
        columns = np.stack([field.ravel() for field in fields], axis=1)[:, free]
        fit[free] = np.linalg.lstsq(columns, velocity.ravel(), rcond=None)[0]
    nothing = np.zeros(3)
    momentum = body.turns * (body.inertia @ fit[3:])
    return RigidState(body.origin, fit[:3], np.array([1.0, 0.0, 0.0, 0.0]), momentum, nothing, nothing)


def _wide(vectors: np.ndarray) -> np.ndarray:
    """Vectors (..., dim) with three components."""
    return np.pad(vectors, [(0, 0)] * (vectors.ndim - 1) + [(0, 3 - vectors.shape[-1])])
