"""A structure of any size as it was understood: its blocks by name, its sensors, and the joints that were found."""

import numpy as np
from matplotlib.collections import PolyCollection
from matplotlib.path import Path

from blockshake.measurement.motion.joints import find_joints
from blockshake.measurement.sensors.markers import point_position
from blockshake.pages.drawing import BLUE, DARK_GREY, GREEN, ORANGE, RED, new_figure
from blockshake.pages.scene.bodies import body_colors
from blockshake.pages.scene.projection import Scene

_VIEWS = {"front": ("front view", "x [m]"), "side": ("side view", "y [m]"), "3d": ("", "")}
_WIDTH, _HEIGHT = 0.25, 0.2  # m of paper, the height at most
_BESIDE, _ABOVE = 0.06, 0.03  # m of paper for titles and axes
_POINT = 0.0254 / 72.0  # m, of type
_LETTER = 0.62  # of a type's size, the width of a letter
_LARGEST_TYPE, _SMALLEST_TYPE = 7.0, 2.5  # points


def plot_understood(structure, width=_WIDTH):
    """Figure of a structure at its start from the front, from the side and in parallel projection, to one scale.

    Blocks have the colour of their material, driven bodies are grey; a name stands on every block that is seen where
    the block is large enough; diamonds are the joints: pairs nearer than 0.1 mm. In the views from the front and from
    the side, sensors on hidden faces are drawn too. ``width``: of the figure [m of paper].
    """
    scenes = {view: Scene(structure, view) for view in _VIEWS}
    ends = [scene.extent(structure.position[None], structure.orientation[None]) for scene in scenes.values()]
    sizes = np.array([up - low for low, up in ends])
    wide, high = sizes[:, 0].sum(), sizes[:, 1].max()
    scale = min((width - _BESIDE) / wide, (_HEIGHT - _ABOVE) / high)  # m of paper, a metre
    figure = new_figure(scale * high + _ABOVE, width)
    panels = figure.subplots(1, len(_VIEWS), width_ratios=sizes[:, 0])
    pairs, middles = find_joints(structure)
    for axes, (view, scene), (low, up) in zip(panels, scenes.items(), ends, strict=True):
        _draw_blocks(axes, scene, structure, scale if _VIEWS[view][0] else None)
        room = 0.03 * (up - low).max()
        (left, bottom), (right, top) = low - room, up + room
        axes.set(xlim=(left, right), ylim=(bottom, top), aspect="equal", anchor="S")
        axes.set(title=_VIEWS[view][0], xlabel=_VIEWS[view][1])
        axes.grid(visible=False)
        axes.spines[["top", "right"]].set_visible(False)
    for axes, scene in list(zip(panels, scenes.values(), strict=True))[:2]:
        at = scene.seen(middles)
        axes.plot(at[:, 0], at[:, 1], "D", color=RED, markersize=2.5, label=f"{len(pairs)} joints found")
        _draw_sensors(axes, scene, structure)
    panels[0].set_ylabel("z [m]")
    panels[-1].set_axis_off()
    figure.legend(*panels[0].get_legend_handles_labels(), loc="outside lower right")
    blocks = int((~structure.driven).sum())
    figure.suptitle(f"{structure.file.name}: {blocks} blocks", fontsize=8.0)
    return figure


def _draw_blocks(axes, scene, structure, scale):
    """Blocks of a view, and their names where ``scale``, m of paper a metre, is given."""
    outlines, bodies, light = scene.faces(structure.position, structure.orientation)
    colors = body_colors(structure)[bodies] * np.array(light)[:, None]
    axes.add_collection(PolyCollection(outlines, facecolors=colors, edgecolors=DARK_GREY, linewidths=0.5))
    if scale is None:
        return
    middles = scene.seen(structure.position)[:, :2]
    sizes = [np.prod(np.ptp(outline, axis=0)) for outline in outlines]
    largest = {}
    for face, body in enumerate(bodies):
        if sizes[face] > sizes[largest.get(body, face)] - 1e-9:
            largest[body] = face
    for body, face in largest.items():
        hidden = any(Path(nearer).contains_point(middles[body]) for nearer in outlines[face + 1 :])
        width, height = scale * np.ptp(outlines[face], axis=0) / _POINT
        name = structure.body_names[body]
        size = min(_LARGEST_TYPE, 0.95 * width / (_LETTER * len(name)), 0.8 * height)
        if not hidden and size >= _SMALLEST_TYPE:
            above = "bottom" if height > 3.0 * size else "center"  # of a sensor in the middle of a large face
            axes.text(*middles[body], name, ha="center", va=above, fontsize=size)


def _draw_sensors(axes, scene, structure):
    """Circles for markers, triangles for accelerometers, lines for displacement transducers."""
    pose = structure.position, structure.orientation
    for sensors, label, style in (
        (structure.file.markers, "markers", {"marker": "o", "color": BLUE, "markersize": 2.0}),
        (
            structure.file.accelerometers,
            "accelerometers",
            {"marker": "^", "color": ORANGE, "markersize": 3.2},
        ),
    ):
        if sensors:
            at = scene.seen(point_position(structure, sensors, *pose))
            axes.plot(at[:, 0], at[:, 1], linestyle="none", markeredgewidth=0.0, label=label, **style)
    transducers = structure.file.displacement_transducers
    if transducers:
        ends, anchors = (
            scene.seen(point_position(structure, points, *pose))
            for points in (transducers, [one.anchor for one in transducers])
        )
        across, up = np.stack([anchors, ends])[..., :2].transpose(2, 0, 1)
        labels = ["displacement transducers", *["_"] * (len(transducers) - 1)]
        axes.plot(across, up, color=GREEN, linewidth=1.0, label=labels)
