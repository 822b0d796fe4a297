"""The SPH sum that one writes first: a yardstick of the machine for the benchmark, no part of any run."""

import warp as wp

MODULE = "warpsph_plain_sum"


@wp.struct
class PlainConstants:
    """Numbers of the plain sum, in SI units: support radius, h, alpha_d h^-(d+2), particle mass, rho0, c0, alpha and
    delta of viscosity and density diffusion, gravity."""

    radius: float
    smoothing_length: float
    slope_norm: float
    mass: float
    rest_density: float
    sound_speed: float
    alpha: float
    delta: float
    gravity: wp.vec3


@wp.kernel(module=MODULE, enable_backward=False)
def plain_sum(
    grid: wp.uint64,
    c: PlainConstants,
    position: wp.array(dtype=wp.vec3),
    velocity: wp.array(dtype=wp.vec3),
    density: wp.array(dtype=float),
    pressure: wp.array(dtype=float),
    acceleration: wp.array(dtype=wp.vec3),
    density_rate: wp.array(dtype=float),
    neighbours: wp.array(dtype=int),
):
    """One particle: acceleration, density rate and number of its neighbours, by a query of the hash grid.

    What the solver's two sums find with its defaults: Wendland C2, p_a + p_b (Colagrossi & Landrini 2003), artificial
    viscosity (Monaghan 1992) and the density diffusion of Fourtakas et al. (2019).
    """
    i = wp.tid()
    x_a = position[i]
    v_a = velocity[i]
    rho_a = density[i]
    force = wp.vec3()
    rate = float(0.0)
    found = int(0)
    h = c.smoothing_length
    query = wp.hash_grid_query(grid, x_a, c.radius)
    b = int(0)
    while wp.hash_grid_query_next(query, b):
        x_ab = x_a - position[b]
        r = wp.length(x_ab)
        if r < c.radius and b != i:
            found += 1
            v_ab = v_a - velocity[b]
            tail = 1.0 - 0.5 * r / h
            VF = c.mass / density[b] * (-5.0) * c.slope_norm * tail * tail * tail
            approach = wp.min(wp.dot(v_ab, x_ab), 0.0)
            viscosity = c.alpha * h * c.sound_speed * c.rest_density * approach / (r * r + 0.01 * h * h)
            force += VF * (viscosity - pressure[i] - pressure[b]) * x_ab
            hydrostatic = c.rest_density / (c.sound_speed * c.sound_speed) * wp.dot(c.gravity, x_ab)
            rate += VF * rho_a * wp.dot(v_ab, x_ab)
            rate += VF * c.delta * h * c.sound_speed * 2.0 * (rho_a - density[b] - hydrostatic)
    acceleration[i] = c.gravity + force / rho_a
    density_rate[i] = rate
    neighbours[i] = found
