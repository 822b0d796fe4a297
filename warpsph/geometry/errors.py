"""What is wrong with a geometry."""

from __future__ import annotations


class GeometryError(ValueError):
    """A file or a set of numbers that bounds no solid; the text says what is wrong and what would help."""
