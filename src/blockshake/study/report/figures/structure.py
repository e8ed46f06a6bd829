"""A structure seen from the front and from the side, to scale, with its sizes and sensors."""

from itertools import pairwise
from os.path import commonprefix

import numpy as np
from matplotlib.patches import Polygon
from scipy.spatial import ConvexHull

from blockshake.geometry.rotations import rotation_matrices
from blockshake.measurement.sensors.markers import point_position
from blockshake.pages.drawing import BLUE, DARK_GREY, GREEN, ORANGE, new_figure

_METRE = 0.0115  # m of paper
_ASIDE, _BELOW, _ABOVE = 0.95, 1.05, 0.6  # m of space for sizes around the drawing
_BETWEEN = 0.006  # m of paper between the views
_TITLES = 0.016  # m of paper above the drawing
_FILL = ("#eceff1", "#f7dfc0", "#cfd8dc", "#d9e8d0")


def plot_structure(structure):
    """Figure of a structure at its start: front view (x, z) and side view (y, z) at the same scale.

    Sizes in m; circles are markers, triangles accelerometers, lines displacement transducers. Nearer parts hide those
    behind; sensors are drawn where they face the eye or not.
    """
    corners = _corners(structure)
    together = np.vstack(corners)
    low, high = together.min(axis=0), together.max(axis=0)
    height = high[2] - low[2] + _BELOW + _ABOVE
    widths = high[:2] - low[:2] + 2.0 * _ASIDE
    figure = new_figure(_METRE * height + _TITLES, structure_width(structure))
    views = figure.subplots(1, 2, sharey=True, width_ratios=widths)
    for axes, across, title in zip(views, (0, 1), ("front view, shaking along x", "side view"), strict=True):
        _draw_bodies(axes, structure, corners, across, names=across == 0)
        _draw_sensors(axes, structure, across)
        _draw_sizes(axes, structure, corners, across)
        _draw_directions(axes, low[across] - 0.8 * _ASIDE, low[2] - 0.9 * _BELOW, "xy"[across])
        axes.set(
            xlim=(low[across] - _ASIDE, high[across] + _ASIDE),
            ylim=(low[2] - _BELOW, high[2] + _ABOVE),
            aspect="equal",
            title=title,
        )
        axes.set_axis_off()
    handles, labels = views[0].get_legend_handles_labels()
    if handles:
        figure.legend(handles, labels, loc="outside upper center", ncols=len(handles))
    return figure


def structure_width(structure):
    """Width of the figure [m of paper]."""
    together = np.vstack(_corners(structure))
    widths = np.ptp(together[:, :2], axis=0) + 2.0 * _ASIDE
    return float(_METRE * widths.sum() + _BETWEEN)


def _draw_directions(axes, left, bottom, across):
    """The two axes of the view, half a metre long."""
    for end, name in (((left + 0.5, bottom), across), ((left, bottom + 0.5), "z")):
        axes.annotate(
            name,
            xy=(left, bottom),
            xytext=end,
            fontsize=6,
            ha="center",
            va="center",
            arrowprops={"arrowstyle": "<-", "linewidth": 0.6, "shrinkA": 2, "shrinkB": 0},
        )


def _corners(structure):
    """Vertices of every body at the start, world frame [m]."""
    turns = rotation_matrices(structure.orientation)
    return [
        structure.solid(body).vertices @ turns[body].T + structure.position[body]
        for body in range(len(structure.body_names))
    ]


def _draw_bodies(axes, structure, corners, across, names):
    materials = list(structure.file.materials)
    behind_first = sorted(range(len(corners)), key=lambda body: _distance(corners[body], across))
    for body in behind_first:
        flat = corners[body][:, [across, 2]]
        material = structure.file.bodies[body].material
        axes.add_patch(
            Polygon(
                flat[ConvexHull(flat).vertices],
                facecolor=_FILL[materials.index(material) % len(_FILL)],
                edgecolor=DARK_GREY,
                linewidth=0.6,
            )
        )
    if names:
        _write_names(axes, structure, corners, across)


def _distance(corners, across):
    """How near the eye: the front view looks along +y, the side view along -x."""
    return -corners[:, 1].min() if across == 0 else corners[:, 0].max()


def _write_names(axes, structure, corners, across):
    """One name a visible outline; bodies one behind the other share it."""
    groups = {}
    for name, points in zip(structure.body_names, corners, strict=True):
        flat = points[:, [across, 2]]
        key = tuple(np.round([*flat.min(axis=0), *flat.max(axis=0)], 3))
        groups.setdefault(key, []).append(name)
    for (left, bottom, right, top), members in groups.items():
        label = members[0] if len(members) == 1 else _joint_name(members)
        thin = top - bottom < 0.5
        height = 0.5 * (bottom + top) if thin else bottom + 0.67 * (top - bottom)
        share = 0.7 if thin else 0.5  # in a thin one beside the marker in its middle
        place = left + share * (right - left)
        axes.text(place, height, label, ha="center", va="center", fontsize=5.5, color="#1a1a1a")


def _joint_name(names):
    start = commonprefix(names)  # noqa: RUF071 - names, not paths
    ends = [name.removeprefix(start) for name in names]
    return f"{start}{ends[0]} to {ends[-1]}"


def _draw_sensors(axes, structure, across):
    kinds = (
        (structure.file.markers, "marker", {"marker": "o", "color": BLUE, "markersize": 2.2}),
        (
            structure.file.accelerometers,
            "accelerometer",
            {"marker": "^", "color": ORANGE, "markersize": 3.6, "markeredgecolor": "black"},
        ),
    )
    for sensors, label, style in kinds:
        points = point_position(structure, sensors, structure.position, structure.orientation)
        if len(points):
            axes.plot(
                points[:, across], points[:, 2], linestyle="none", markeredgewidth=0.3, label=label, **style
            )
    items = structure.file.displacement_transducers
    ends, anchors = (
        point_position(structure, points, structure.position, structure.orientation)[:, [across, 2]]
        for points in (items, [item.anchor for item in items])
    )
    for place, (end, anchor) in enumerate(zip(ends, anchors, strict=True)):
        label = None if place else "displacement transducer"
        axes.plot(*np.transpose([anchor, end]), color=GREEN, linewidth=1.0, label=label)


def _draw_sizes(axes, structure, corners, across):
    """Total height, heights of the courses, widths of the lowest and highest bodies and of the driven one."""
    boxes = [(points.min(axis=0), points.max(axis=0)) for points in corners]
    free = [box for box, driven in zip(boxes, structure.driven, strict=True) if not driven]
    driven = [box for box, driven in zip(boxes, structure.driven, strict=True) if driven]
    left = min(low[across] for low, _ in boxes)
    right = max(high[across] for _, high in boxes)
    bottom = min(low[2] for low, _ in boxes)
    top = max(high[2] for _, high in boxes)
    floor = min(low[2] for low, _ in free)
    lowest = [box for box in free if box[0][2] - floor < 1e-3]
    highest = [box for box in free if top - box[1][2] < 1e-3]
    if across == 0:
        _vertical(axes, left - 0.45, [floor, top])
    else:
        _vertical(axes, right + 0.35, _edges(free, 2))
    _horizontal(axes, bottom - 0.3, _edges(lowest, across))
    _horizontal(axes, top + 0.25, _edges(highest, across))
    if driven:
        _horizontal(axes, bottom - 0.75, _edges(driven, across))


def _edges(boxes, axis):
    edges = sorted(float(end[axis]) for box in boxes for end in box)
    return [edge for place, edge in enumerate(edges) if place == 0 or edge - edges[place - 1] > 1e-3]


def _horizontal(axes, height, edges):
    for start, end in pairwise(edges):
        _arrow(axes, (start, height), (end, height))
        axes.text(
            0.5 * (start + end), height + 0.05, f"{end - start:.3g}", ha="center", va="bottom", fontsize=6
        )


def _vertical(axes, place, edges):
    for start, end in pairwise(edges):
        _arrow(axes, (place, start), (place, end))
        axes.text(place + 0.08, 0.5 * (start + end), f"{end - start:.3g}", ha="left", va="center", fontsize=6)


def _arrow(axes, start, end):
    axes.annotate(
        "",
        xy=end,
        xytext=start,
        arrowprops={
            "arrowstyle": "|-|,widthA=0.15,widthB=0.15",
            "linewidth": 0.5,
            "shrinkA": 0,
            "shrinkB": 0,
        },
    )
