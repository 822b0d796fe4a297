"""Signed distance of points from a closed surface of triangles.

`wp.Mesh` works in single precision. Its tree finds the nearest triangle; the distance from that is computed in double
precision. Inside and outside are told by the winding number (Jacobson, Kavan & Sorkine-Hornung 2013), which counts
overlapping shells as one solid.
"""

import warp as wp


@wp.func
def closest_on_triangle(p: wp.vec3d, a: wp.vec3d, b: wp.vec3d, c: wp.vec3d):
    """The point of a triangle nearest to p (Ericson 2005, section 5.1.5)."""
    zero, one = wp.float64(0.0), wp.float64(1.0)
    ab, ac, ap, bp, cp = b - a, c - a, p - a, p - b, p - c
    d1, d2, d3 = wp.dot(ab, ap), wp.dot(ac, ap), wp.dot(ab, bp)
    d4, d5, d6 = wp.dot(ac, bp), wp.dot(ab, cp), wp.dot(ac, cp)
    va, vb, vc = d3 * d6 - d5 * d4, d5 * d2 - d1 * d6, d1 * d4 - d3 * d2
    result = a
    if d1 <= zero and d2 <= zero:
        result = a
    elif d3 >= zero and d4 <= d3:
        result = b
    elif d6 >= zero and d5 <= d6:
        result = c
    elif vc <= zero and d1 >= zero and d3 <= zero:
        result = a + ab * (d1 / (d1 - d3))
    elif vb <= zero and d2 >= zero and d6 <= zero:
        result = a + ac * (d2 / (d2 - d6))
    elif va <= zero and d4 - d3 >= zero and d5 - d6 >= zero:
        result = b + (c - b) * ((d4 - d3) / ((d4 - d3) + (d5 - d6)))
    else:
        scale = one / (va + vb + vc)
        result = a + ab * (vb * scale) + ac * (vc * scale)
    return result


@wp.kernel(module="warpsph_mesh_distance", enable_backward=False)
def measure_mesh(
    offset: int,
    mesh: wp.uint64,
    vertex: wp.array(dtype=wp.vec3d),
    face: wp.array2d(dtype=wp.int32),
    blur: wp.float64,
    point: wp.array(dtype=wp.vec3d),
    distance: wp.array(dtype=wp.float64),
):
    """One point [1]: its distance from the surface [1], negative inside.

    The mesh lies about the origin and is of the size one. Nearer to the surface than `blur` single precision may take
    the winding number of the other side; there it is that of the place where the line from the nearest point through
    this one leaves that layer.
    """
    i = offset + wp.tid()
    p = point[i]
    far = float(1.0e6)
    nearest = wp.mesh_query_point_sign_winding_number(mesh, wp.vec3(p), far)
    k = nearest.face
    q = closest_on_triangle(p, vertex[face[k, 0]], vertex[face[k, 1]], vertex[face[k, 2]])
    d = wp.length(p - q)
    sign = wp.float64(nearest.sign)
    if d < blur and d > wp.float64(0.0):
        pushed = q + (p - q) * (blur / d)
        sign = wp.float64(wp.mesh_query_point_sign_winding_number(mesh, wp.vec3(pushed), far).sign)
    distance[i] = sign * d
