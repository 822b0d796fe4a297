"""From the shapes of a scene to particles, and from its prescribed motions to functions of time."""

from warpsph.sampling.distance import signed_distance
from warpsph.sampling.sampler import sample
from warpsph.sampling.sets import SampledSet
from warpsph.scene.bounds import bounding_box

__all__ = ["SampledSet", "bounding_box", "sample", "signed_distance"]
