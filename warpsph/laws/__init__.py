"""Formulas of the scheme on the host, in double precision: what a scene may name, and what probes compute with."""
