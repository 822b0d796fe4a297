"""Which watches a scene needs."""

from __future__ import annotations

from warpsph.scene.schema import Scene
from warpsph.solver.energy_watch import EnergyWatch, why_not_closed
from warpsph.solver.leak_watch import LeakWatch
from warpsph.solver.step_watch import StepWatch
from warpsph.solver.structure_assembly import is_static
from warpsph.solver.watch import Watch, Watches


def watches_of(scene: Scene) -> Watches:
    """The watches of a run: what does not exist in a scene is not looked at."""
    watches: list[Watch] = []
    if not is_static(scene):
        watches.append(StepWatch())
    if why_not_closed(scene) is None:
        watches.append(EnergyWatch(scene))
    if scene.fluids and (scene.boundaries or scene.structures):
        watches.append(LeakWatch(scene))
    return Watches(watches)
