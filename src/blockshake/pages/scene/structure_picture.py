"""A structure of any size as it was understood: its blocks by name, its sensors, and the joints that were found."""

import numpy as np
from matplotlib.collections import PolyCollection
from matplotlib.path import Path

from blockshake.measurement.motion.joints import find_joints
from blockshake.measurement.sensors.markers import point_position
from blockshake.pages.drawing import BLUE, DARK_GREY, GREEN, ORANGE, RED, new_figure
from blockshake.pages.scene.bodies import body_colors
from blockshake.pages.scene.projection import Scene

_VIEWS = {
    "front": ("front view", "x [m]"),
    "side": ("side view, from +x", "y [m]"),
    "far side": ("side view, from -x", "y [m]"),
    "3d": ("", ""),
}
_WIDTH, _HEIGHT = 0.25, 0.2  # m of paper, the height at most
_BESIDE, _ABOVE = 0.06, 0.03  # m of paper for titles and axes
_POINT = 0.0254 / 72.0  # m, of type
_LETTER = 0.62  # of a type's size, the width of a letter
_LARGEST_TYPE, _SMALLEST_TYPE = 7.0, 2.5  # points
_OVER_SENSOR = 2.0  # points, from the middle of a face


def plot_understood(structure, width=_WIDTH):
    """Figure of a structure at its start from the front, from the side and in parallel projection, to one scale.

    Where a block is hidden from the front and from the side, as in a wall of two leaves, the structure is drawn from
    the other side too. Blocks have the colour of their material, driven bodies are grey; a name stands on every block
    that is seen where the block is large enough; diamonds are the joints: pairs nearer than 0.1 mm. In all views but
    the last, sensors on hidden faces are drawn too. ``width``: of the figure [m of paper].
    """
    scenes = {view: Scene(structure, view) for view in _VIEWS}
    named = {body for view in ("front", "side") for body in _bared(scenes[view], structure)}
    if named >= set(np.flatnonzero(~structure.driven)):
        del scenes["far side"]
    ends = [scene.extent(structure.position[None], structure.orientation[None]) for scene in scenes.values()]
    sizes = np.array([up - low for low, up in ends])
    wide, high = sizes[:, 0].sum(), sizes[:, 1].max()
    scale = min((width - _BESIDE) / wide, (_HEIGHT - _ABOVE) / high)  # m of paper, a metre
    figure = new_figure(scale * high + _ABOVE, width)
    panels = figure.subplots(1, len(scenes), width_ratios=sizes[:, 0])
    pairs, middles = find_joints(structure)
    for axes, (view, scene), (low, up) in zip(panels, scenes.items(), ends, strict=True):
        draw_blocks(axes, scene, structure, structure.position, structure.orientation)
        if _VIEWS[view][0]:
            _draw_names(axes, scene, structure, scale)
        room = 0.03 * (up - low).max()
        (left, bottom), (right, top) = low - room, up + room
        axes.set(xlim=(left, right), ylim=(bottom, top), aspect="equal", anchor="S")
        axes.set(title=_VIEWS[view][0], xlabel=_VIEWS[view][1])
        axes.grid(visible=False)
        axes.spines[["top", "right"]].set_visible(False)
    for axes, scene in list(zip(panels, scenes.values(), strict=True))[:-1]:
        at = scene.seen(middles)
        axes.plot(at[:, 0], at[:, 1], "D", color=RED, markersize=2.5, label=f"{len(pairs)} joints found")
        _draw_sensors(axes, scene, structure)
    panels[0].set_ylabel("z [m]")
    panels[-1].set_axis_off()
    figure.legend(*panels[0].get_legend_handles_labels(), loc="outside lower right")
    blocks = int((~structure.driven).sum())
    figure.suptitle(f"{structure.file.name}: {blocks} blocks", fontsize=8.0)
    return figure


def draw_blocks(axes, scene, structure, position, orientation):
    """Draw the blocks of a structure at these poses as a `Scene` sees them."""
    outlines, bodies, light = scene.faces(position, orientation)
    colors = body_colors(structure)[bodies] * np.array(light)[:, None]
    axes.add_collection(PolyCollection(outlines, facecolors=colors, edgecolors=DARK_GREY, linewidths=0.5))


def _bared(scene, structure):
    """Size of the largest face of every body whose middle no nearer body hides, by index [m]."""
    outlines, bodies, _ = scene.faces(structure.position, structure.orientation)
    middles = scene.seen(structure.position)[:, :2]
    sizes = [np.ptp(outline, axis=0) for outline in outlines]
    largest = {}
    for face, body in enumerate(bodies):
        if np.prod(sizes[face]) > np.prod(sizes[largest.get(body, face)]) - 1e-9:
            largest[body] = face
    return {
        body: sizes[face]
        for body, face in largest.items()
        if not any(Path(nearer).contains_point(middles[body]) for nearer in outlines[face + 1 :])
    }


def _draw_names(axes, scene, structure, scale):
    """Names on blocks that are seen, beside a sensor in the middle; ``scale``: m of paper, a metre."""
    middles = scene.seen(structure.position)[:, :2]
    for body, extent in _bared(scene, structure).items():
        width, height = scale * extent / _POINT
        name = structure.body_names[body]
        over, left = (0.0, _OVER_SENSOR), (-0.25 * width, 0.0)
        ways = [
            (text, room, high / (1.2 * (1 + text.count("\n"))), offset, upright)
            for text in dict.fromkeys((name, _halved(name)))
            for room, high, offset, upright in (
                (width, 0.5 * height - _OVER_SENSOR, over, "bottom"),
                (0.45 * width, height, left, "center"),
            )
        ]
        sizes = [
            min(_LARGEST_TYPE, 0.95 * room / (_LETTER * max(map(len, text.split("\n")))), high)
            for text, room, high, *_ in ways
        ]
        text, _, _, offset, upright = ways[int(np.argmax(sizes))]
        if max(sizes) >= _SMALLEST_TYPE:
            axes.annotate(
                text, middles[body], offset, textcoords="offset points", ha="center", va=upright,
                fontsize=max(sizes), linespacing=1.0,
            )  # fmt: skip


def _halved(name):
    """A name on two lines, parted after the hyphen nearest to its middle."""
    ends = [place + 1 for place, letter in enumerate(name[:-1]) if letter in "-_ "]
    end = min(ends, key=lambda place: abs(2 * place - len(name)), default=len(name))
    return f"{name[:end]}\n{name[end:]}".strip()


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
