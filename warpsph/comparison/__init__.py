"""Comparison of a run with the references of its scene: pure functions of probe histories and frames."""
