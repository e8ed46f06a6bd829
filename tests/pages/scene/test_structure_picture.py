"""A structure as it was understood: every block has its name where the name can be read."""

from itertools import combinations

import matplotlib
import pytest

from blockshake.geometry.structure import load_structure
from blockshake.measurement.motion.joints import find_leaves
from blockshake.pages.drawing import STYLE
from blockshake.pages.scene.structure_picture import plot_understood

READABLE = 3.5  # points
BLOCKS = (
    *((f"{side}-{course}", "pier", sign * 0.95, course - 0.5)
      for side, sign in (("left", -1), ("right", 1)) for course in (1, 2)),
    ("lintel", "lintel", 0.0, 2.25), ("top-1", "top", -0.7, 2.8), ("top-2", "top", 0.7, 2.8),
)  # fmt: skip


def wall(*leaves):
    """Leaves of seven blocks around a door, 0.5 m thick and 20 mm apart."""
    stone = {"density": 2300.0, "youngs_modulus": 2.0e10, "poisson_ratio": 0.2}
    bodies = [
        {"name": "slab", "shape": "slab", "material": "stone", "position": [0.5, 0, -0.1], "driven": True}
    ]
    for place, leaf in enumerate(leaves):
        bodies += [
            {"name": f"{leaf}-{name}", "shape": shape, "material": "stone", "position": [0.52 * place, y, z]}
            for name, shape, y, z in BLOCKS
        ]
    return load_structure(
        {
            "name": "wall",
            "materials": {"stone": stone},
            "shapes": {
                "slab": {"box": [3.0, 4.0, 0.2]},
                "pier": {"box": [0.5, 0.9, 1.0]},
                "lintel": {"box": [0.5, 2.8, 0.5]},
                "top": {"box": [0.5, 1.4, 0.6]},
            },
            "bodies": bodies,
            "friction": [{"pair": ["stone", "stone"], "coefficient": 0.7}],
            "markers": [
                {"name": f"{one['name']}-m", "body": one["name"], "position": [0, 0, 0]} for one in bodies
            ],
        }
    )


@pytest.mark.parametrize("leaves", [("outer", "inner"), ("outer", "core", "inner")])
def test_every_block_of_every_leaf_has_a_name_that_can_be_read(leaves):
    structure = wall(*leaves)
    with matplotlib.rc_context(STYLE):
        figure = plot_understood(structure, 0.17)
        figure.draw_without_rendering()
    panels = {axes.get_title(): axes for axes in figure.findobj(matplotlib.axes.Axes)}
    for leaf in leaves:
        shown = {text.get_text().replace("\n", "") for text in panels[f"{leaf}, from +x"].texts}
        assert shown == {"slab", *(f"{leaf}-{name}" for name, *_ in BLOCKS)}
        markers = next(line for line in panels[f"{leaf}, from +x"].lines if line.get_label() == "markers")
        assert len(markers.get_xdata()) == 1 + len(BLOCKS)
    for axes in panels.values():
        assert all(text.get_fontsize() >= READABLE for text in axes.texts)
        boxes = [text.get_window_extent() for text in axes.texts]
        assert not any(one.overlaps(other) for one, other in combinations(boxes, 2))


def test_leaves_are_named_by_what_their_blocks_share():
    assert {name: len(leaf) for name, leaf in find_leaves(wall("outer", "inner")).items()} == {
        "outer": 7,
        "inner": 7,
    }
    assert list(find_leaves(wall("a-1", "a-2"))) == ["a-1", "a-2"]
    assert list(find_leaves(load_structure("configuration-1"))) == ["block"]
