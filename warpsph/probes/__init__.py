"""Quantities of the state sampled over time: one module a kind of probe."""

from warpsph.probes.factory import make_probe
from warpsph.probes.probe import Probe

__all__ = ["Probe", "make_probe"]
