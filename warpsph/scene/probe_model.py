"""What all probes of a scene have in common."""

from __future__ import annotations

from warpsph.scene.types import AXES, SceneModel


class ProbeModel(SceneModel):
    """A probe: what it writes."""

    def quantities(self, dimension: int) -> tuple[str, ...]:
        """Column names without the probe's own, in a scene of that dimension."""
        raise NotImplementedError

    def columns(self, name: str, dimension: int) -> tuple[str, ...]:
        """Columns that a probe of that name writes, such as front.position[m]."""
        return tuple(f"{name}.{quantity}" for quantity in self.quantities(dimension))


def force_columns(dimension: int) -> tuple[str, ...]:
    """Columns of a force and its torque."""
    if dimension == 2:
        return ("force_x[N/m]", "force_y[N/m]", "torque_z[N m/m]")
    return tuple(f"force_{axis}[N]" for axis in AXES) + tuple(f"torque_{axis}[N m]" for axis in AXES)
