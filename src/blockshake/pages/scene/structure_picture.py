"""A structure of any size as it was understood: its blocks by name, its sensors, and the joints that were found."""

import numpy as np
from matplotlib.collections import PolyCollection
from matplotlib.path import Path

from blockshake.measurement.motion.joints import find_joints, find_leaves
from blockshake.measurement.sensors.markers import point_position
from blockshake.pages.drawing import BLUE, DARK_GREY, GREEN, ORANGE, RED, new_figure
from blockshake.pages.scene.bodies import body_colors
from blockshake.pages.scene.projection import Scene
from blockshake.pages.wording import count_words

_WIDTH, _HEIGHT = 0.25, 0.2  # m of paper, the height at most
_SIDEWAYS, _ABOVE = 0.06, 0.03  # m of paper for titles and axes
_POINT = 0.0254 / 72.0  # m, of type
_LETTER = 0.62  # of a type's size, the width of a letter
_LARGEST_TYPE, _SMALLEST_TYPE = 7.0, 3.5  # points
_OVER_SENSOR = 2.0  # points, from the middle of a face
_IN_A_ROW = 3  # views; more may stand in two


def plot_understood(structure, width=_WIDTH):
    """Figure of a structure at its start from the front, from the side and in parallel projection, to one scale.

    Where a block is hidden from the front and from the side, every leaf of a wall is drawn alone from the side, and a
    structure whose joints hold all its blocks together from the other side too. Blocks have the colour of their
    material, driven bodies are grey; a name stands on every block that is seen where the block is large enough;
    diamonds are the joints: pairs nearer than 0.1 mm, crosses the mass centres. In all views but that in space, sensors
    on hidden faces are drawn too. ``width``: of the figure [m of paper].
    """
    views = _views(structure)
    ends = [scene.extent(structure.position[None], structure.orientation[None]) for *_, scene in views]
    sizes = np.array([up - low for low, up in ends])
    splits = ((), (2,)) if len(views) > _IN_A_ROW else ((),)
    scale, split = max((_scale(np.split(sizes, split), width), split) for split in splits)
    rows = np.split(np.arange(len(views)), split)
    heights = [scale * sizes[row, 1].max() + _ABOVE for row in rows]
    figure = new_figure(sum(heights), width)
    parts = figure.subfigures(len(rows), 1, height_ratios=heights, squeeze=False)[:, 0]
    panels = []
    for part, row in zip(parts, rows, strict=True):
        panels += [*part.subplots(1, len(row), width_ratios=sizes[row, 0], squeeze=False)[0]]
        panels[row[0]].set_ylabel("z [m]")
    pairs, middles = find_joints(structure)
    for axes, (title, label, scene), (low, up) in zip(panels, views, ends, strict=True):
        draw_blocks(axes, scene, structure, structure.position, structure.orientation)
        room = 0.03 * (up - low).max()
        (left, bottom), (right, top) = low - room, up + room
        axes.set(xlim=(left, right), ylim=(bottom, top), aspect="equal", anchor="S")
        axes.set(title=title, xlabel=label)
        axes.grid(visible=False)
        axes.spines[["top", "right"]].set_visible(False)
        if not label:
            axes.set_axis_off()
            continue
        _draw_names(axes, scene, structure, scale)
        at = scene.seen(middles[[scene.shown.issuperset(pair) for pair in pairs.tolist()]])
        label = f"{count_words(len(pairs), 'joint')} found"
        axes.plot(at[:, 0], at[:, 1], "D", color=RED, markersize=2.5, label=label)
        free = [body for body in sorted(scene.shown) if not structure.driven[body]]
        at = scene.seen(structure.position[free])
        axes.plot(at[:, 0], at[:, 1], "+", color=DARK_GREY, markersize=4.0, label="mass centres")
        _draw_sensors(axes, scene, structure)
    figure.legend(*panels[0].get_legend_handles_labels(), loc="outside lower right")
    blocks = int((~structure.driven).sum())
    figure.suptitle(f"{structure.file.name}: {count_words(blocks, 'block')}", fontsize=8.0)
    return figure


def _views(structure):
    """Title, label of the axis across and `Scene` of every view; of many the one in space is the second."""
    front, side = (Scene(structure, view) for view in ("front", "side"))
    sides = [("side view, from +x", side)]
    if not set(np.flatnonzero(~structure.driven)) <= {*_bared(front, structure), *_bared(side, structure)}:
        base, leaves = np.flatnonzero(structure.driven), find_leaves(structure)
        if len(leaves) == 1:
            sides.append(("side view, from -x", Scene(structure, "far side")))
        else:
            sides = [
                (f"{name}, from +x", Scene(structure, "side", [*base, *leaf]))
                for name, leaf in leaves.items()
            ]
    views = [("front view", "x [m]", front), *((title, "y [m]", scene) for title, scene in sides)]
    views.insert(1 if len(views) >= _IN_A_ROW else len(views), ("", "", Scene(structure, "3d")))
    return views


def _scale(rows, width):
    """Metres of paper a metre of views, whose sizes [m] are given row by row."""
    wide = max(row[:, 0].sum() for row in rows)
    high = sum(row[:, 1].max() for row in rows)
    return min((width - _SIDEWAYS) / wide, (_HEIGHT - len(rows) * _ABOVE) / high)


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
    """Names on blocks that are seen, next to a sensor in the middle; ``scale``: m of paper, a metre."""
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
    seen = {structure.body_names[body] for body in scene.shown}
    for sensors, label, style in (
        (structure.file.markers, "markers", {"marker": "o", "color": BLUE, "markersize": 2.0}),
        (
            structure.file.accelerometers,
            "accelerometers",
            {"marker": "^", "color": ORANGE, "markersize": 3.2},
        ),
    ):
        if sensors := [one for one in sensors if one.body in seen]:
            at = scene.seen(point_position(structure, sensors, *pose))
            axes.plot(at[:, 0], at[:, 1], linestyle="none", markeredgewidth=0.0, label=label, **style)
    transducers = structure.file.displacement_transducers
    if transducers := [one for one in transducers if {one.body, one.reference} <= seen]:
        ends, anchors = (
            scene.seen(point_position(structure, points, *pose))
            for points in (transducers, [one.anchor for one in transducers])
        )
        across, up = np.stack([anchors, ends])[..., :2].transpose(2, 0, 1)
        labels = ["displacement transducers", *["_"] * (len(transducers) - 1)]
        axes.plot(across, up, color=GREEN, linewidth=1.0, label=labels)
