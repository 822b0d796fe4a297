"""Pictures of particle surfaces: spheres splatted into a depth buffer, smoothed, lit and painted.

Every quantity of the visible surface is the weighted mean over the splats within a thin layer behind the
nearest one (surface splatting: Zwicker, Pfister, van Baar & Gross 2001). Depth is measured along the
viewing direction; pixels that show nothing have infinite depth. Row 0 is the top of the picture.
"""

import warp as wp

wp.set_module_options({"enable_backward": False})

SMALLEST_REACH = wp.constant(0.71)
"""Pixels: half a diagonal, so that a distant particle still meets one pixel centre."""


@wp.struct
class View:
    """A perspective camera: eye [m], unit axes, focal length and size of the picture in pixels."""

    eye: wp.vec3
    right: wp.vec3
    up: wp.vec3
    forward: wp.vec3
    focal: float
    width: int
    height: int


@wp.struct
class Paint:
    """Colours by value from `low` to `high`, and how strongly the surface reflects (0: matt, 1: water)."""

    palette: wp.array(dtype=wp.vec3)
    low: float
    high: float
    gloss: float


@wp.struct
class Lights:
    """Unit vector towards the key light and colour of the sky, both in the camera's axes."""

    key: wp.vec3
    sky: wp.vec3


@wp.func
def project(view: View, x: wp.vec3) -> wp.vec3:
    """Column and row [pixels] and depth [m] of a point."""
    d = x - view.eye
    depth = wp.dot(d, view.forward)
    scale = view.focal / depth
    column = 0.5 * float(view.width) + scale * wp.dot(d, view.right)
    row = 0.5 * float(view.height) - scale * wp.dot(d, view.up)
    return wp.vec3(column, row, depth)


@wp.func
def ray(view: View, row: int, column: int) -> wp.vec3:
    """Direction through a pixel centre in camera axes, of depth one."""
    x = (float(column) + 0.5 - 0.5 * float(view.width)) / view.focal
    y = (0.5 * float(view.height) - float(row) - 0.5) / view.focal
    return wp.vec3(x, y, 1.0)


@wp.func
def reach_of(view: View, depth: float, radius: float) -> float:
    """Radius of a sphere in the picture [pixels]."""
    return wp.max(view.focal * radius / depth, SMALLEST_REACH)


@wp.func
def cover(centre: wp.vec3, reach: float, row: int, column: int) -> float:
    """1 - (r/R)^2 at a pixel: 1 in the middle of a sphere's disc, 0 at its rim, negative outside."""
    dx = (float(column) + 0.5 - centre[0]) / reach
    dy = (float(row) + 0.5 - centre[1]) / reach
    return 1.0 - dx * dx - dy * dy


@wp.func
def footprint(view: View, centre: wp.vec3, reach: float) -> wp.vec4i:
    """Rows from .. to, columns from .. to (exclusive) that a disc may cover within the picture."""
    return wp.vec4i(
        wp.max(0, int(centre[1] - reach)),
        wp.min(view.height, int(centre[1] + reach) + 1),
        wp.max(0, int(centre[0] - reach)),
        wp.min(view.width, int(centre[0] + reach) + 1),
    )


@wp.kernel
def splat_depth(
    points: wp.array(dtype=wp.vec3),
    radii: wp.array(dtype=float),
    side: float,
    view: View,
    depth: wp.array2d(dtype=float),
):
    """One thread a particle: lower `side` * depth under its sphere; side 1 keeps the nearest, -1 the farthest."""
    tid = wp.tid()
    centre, radius = project(view, points[tid]), radii[tid]
    if centre[2] < 2.0 * radius:
        return
    reach = reach_of(view, centre[2], radius)
    box = footprint(view, centre, reach)
    for row in range(box[0], box[1]):
        for column in range(box[2], box[3]):
            inside = cover(centre, reach, row, column)
            if inside > 0.0:
                front = centre[2] - side * radius * wp.sqrt(inside)
                wp.atomic_min(depth, row, column, side * front)


@wp.kernel
def splat_layer(
    points: wp.array(dtype=wp.vec3),
    radii: wp.array(dtype=float),
    values: wp.array(dtype=float),
    thickness: float,
    view: View,
    nearest: wp.array2d(dtype=float),
    sums: wp.array2d(dtype=wp.vec3),
):
    """One thread a particle: add (w, w depth, w value) under its sphere, down to `thickness` [m] behind the nearest."""
    tid = wp.tid()
    centre, radius = project(view, points[tid]), radii[tid]
    if centre[2] < 2.0 * radius:
        return
    reach = reach_of(view, centre[2], radius)
    box = footprint(view, centre, reach)
    for row in range(box[0], box[1]):
        for column in range(box[2], box[3]):
            inside = cover(centre, reach, row, column)
            if inside > 0.0:
                front = centre[2] - radius * wp.sqrt(inside)
                if front <= nearest[row, column] + thickness:
                    w = inside * inside
                    wp.atomic_add(sums, row, column, wp.vec3(w, w * front, w * values[tid]))


@wp.kernel
def resolve(sums: wp.array2d(dtype=wp.vec3), depth: wp.array2d(dtype=float), value: wp.array2d(dtype=float)):
    """One thread a pixel: weighted means of depth and value."""
    row, column = wp.tid()
    s = sums[row, column]
    depth[row, column] = wp.where(s[0] > 0.0, s[1] / s[0], wp.inf)
    value[row, column] = wp.where(s[0] > 0.0, s[2] / s[0], 0.0)


@wp.kernel
def smooth(
    depth: wp.array2d(dtype=float),
    along_rows: int,
    reach: int,
    threshold: float,
    smoothed: wp.array2d(dtype=float),
):
    """One thread a pixel: flatten bends of the surface along one axis of the picture (one launch for each
    axis).

    The mean over pairs of opposite neighbours leaves a plane as it is, however steeply it is seen; pairs
    that bend by more than `threshold` [m] belong to another surface (after curvature flow: van der Laan,
    Green & Sainz 2009, and the narrow range of Truong & Yuksel 2018).
    """
    row, column = wp.tid()
    centre = depth[row, column]
    if not wp.isfinite(centre):
        smoothed[row, column] = centre
        return
    di, dj = 1 - along_rows, along_rows
    room = wp.min(
        wp.min(row, depth.shape[0] - 1 - row) * di + wp.min(column, depth.shape[1] - 1 - column) * dj, reach
    )
    bend_sum = float(0.0)
    weight_sum = float(0.5)
    for shift in range(1, room + 1):
        i, j = shift * di, shift * dj
        bend = 0.5 * (depth[row - i, column - j] + depth[row + i, column + j]) - centre
        if wp.abs(bend) < threshold:
            q = float(shift) / float(reach)
            w = wp.exp(-2.0 * q * q)
            bend_sum += w * bend
            weight_sum += w
    smoothed[row, column] = centre + bend_sum / weight_sum


@wp.func
def surface_point(depth: wp.array2d(dtype=float), view: View, row: int, column: int) -> wp.vec3:
    """The surface at a pixel in camera axes [m]; pixels beyond the picture repeat its rim."""
    i = wp.clamp(row, 0, view.height - 1)
    j = wp.clamp(column, 0, view.width - 1)
    return ray(view, i, j) * depth[i, j]


@wp.func
def nearer_difference(before: wp.vec3, here: wp.vec3, after: wp.vec3) -> wp.vec3:
    """Difference on the side where depth changes less: silhouettes keep their own surface."""
    ahead = after - here
    behind = here - before
    use_ahead = wp.abs(ahead[2]) < wp.abs(behind[2]) or not wp.isfinite(behind[2])
    return wp.where(use_ahead and wp.length_sq(ahead) > 0.0, ahead, behind)


@wp.func
def surface_normal(depth: wp.array2d(dtype=float), view: View, row: int, column: int) -> wp.vec3:
    """Unit normal towards the eye in camera axes."""
    here = surface_point(depth, view, row, column)
    left = surface_point(depth, view, row, column - 1)
    right = surface_point(depth, view, row, column + 1)
    above = surface_point(depth, view, row - 1, column)
    below = surface_point(depth, view, row + 1, column)
    return wp.normalize(wp.cross(nearer_difference(left, here, right), nearer_difference(above, here, below)))


@wp.func
def lit(colour: wp.vec3, gloss: float, normal: wp.vec3, to_eye: wp.vec3, lights: Lights) -> wp.vec3:
    """Colour under a wrapped key light, with a highlight (Blinn 1977) and sky by Fresnel (Schlick 1994)."""
    diffuse = 0.5 + 0.5 * wp.dot(normal, lights.key)
    halfway = wp.normalize(to_eye + lights.key)
    highlight = wp.pow(wp.max(wp.dot(normal, halfway), 0.0), 60.0)
    facing = wp.clamp(wp.dot(normal, to_eye), 0.0, 1.0)
    fresnel = gloss * (0.02 + 0.98 * wp.pow(1.0 - facing, 5.0))
    shaded = colour * (0.42 + 0.68 * diffuse)
    white = wp.vec3(1.0, 1.0, 1.0)
    return shaded + (lights.sky - shaded) * fresnel + white * (0.55 * gloss * highlight)


@wp.kernel
def paint_surface(
    depth: wp.array2d(dtype=float),
    value: wp.array2d(dtype=float),
    paint: Paint,
    lights: Lights,
    view: View,
    picture_depth: wp.array2d(dtype=float),
    picture: wp.array2d(dtype=wp.vec3),
):
    """One thread a pixel: paint the surface where it is nearer than what the picture shows."""
    row, column = wp.tid()
    if not depth[row, column] < picture_depth[row, column]:
        return
    last = paint.palette.shape[0] - 1
    fraction = (value[row, column] - paint.low) / (paint.high - paint.low)
    colour = paint.palette[wp.clamp(int(fraction * float(last) + 0.5), 0, last)]
    normal = surface_normal(depth, view, row, column)
    to_eye = -wp.normalize(ray(view, row, column))
    picture_depth[row, column] = depth[row, column]
    picture[row, column] = lit(colour, paint.gloss, normal, to_eye, lights)
