"""A structure of any size as it was understood: its blocks by name, and the joints that were found."""

import numpy as np
from matplotlib.collections import PolyCollection
from matplotlib.path import Path

from blockshake.measurement.motion.joints import find_joints
from blockshake.pages.drawing import DARK_GREY, RED, new_figure
from blockshake.pages.scene.colors import body_colors
from blockshake.pages.scene.projection import Scene

_VIEWS = {"front": ("front view", "x [m]"), "side": ("side view", "y [m]"), "3d": ("", "")}
_WIDTH, _HEIGHT = 0.25, 0.2  # m of paper at most
_BESIDE, _ABOVE = 0.06, 0.03  # m of paper for titles and axes
_POINT = 0.0254 / 72.0  # m, of type
_LETTER = 0.62  # of a type's size, the width of a letter
_LARGEST_TYPE, _SMALLEST_TYPE = 7.0, 2.5  # points


def plot_understood(structure):
    """Figure of a structure at its start from the front, from the side and in parallel projection, to one scale.

    Blocks have the colour of their material, driven bodies are grey; a name stands on every block that is seen where
    the block is large enough; diamonds are the joints: pairs nearer than 0.1 mm.
    """
    scenes = {view: Scene(structure, view) for view in _VIEWS}
    ends = [scene.extent(structure.position[None], structure.orientation[None]) for scene in scenes.values()]
    sizes = np.array([up - low for low, up in ends])
    wide, high = sizes[:, 0].sum(), sizes[:, 1].max()
    scale = min((_WIDTH - _BESIDE) / wide, (_HEIGHT - _ABOVE) / high)  # m of paper, a metre
    figure = new_figure(scale * high + _ABOVE, max(scale * wide + _BESIDE, 0.5 * _WIDTH))
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
            axes.text(*middles[body], name, ha="center", va="center", fontsize=size)
