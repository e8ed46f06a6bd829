"""Hooke at rest: the depth of an interface is the weight above it over ``k_n A``, whatever carries the nodes."""

import numpy as np
import pytest

G = 9.81
K_N = 2.16e10  # N/m3
FLAT = 0.76 * 2.36  # m2, a block's flat within its chamfers
# The start is relaxed until 1e-9 of the weight is out of balance
REST = 1e-7
# a slab whose top is the block's flat, so that both sides of every interface have the same area
SEAT = {"slab": {"box": [0.8, 2.4, 0.2], "chamfer": 0.02}}
TURNS = {
    "bottom": [1.0, 0.0, 0.0, 0.0],
    "top": [0.0, 1.0, 0.0, 0.0],
    "front": [np.sqrt(0.5), 0.0, np.sqrt(0.5), 0.0],
    "back": [np.sqrt(0.5), 0.0, -np.sqrt(0.5), 0.0],
    "left": [np.sqrt(0.5), np.sqrt(0.5), 0.0, 0.0],
    "right": [np.sqrt(0.5), -np.sqrt(0.5), 0.0, 0.0],
}


@pytest.mark.parametrize(
    ("spacing", "inset"), [(0.2, 0.006), (0.2, 0.026), (0.4, 0.001), (0.1, 0.006), (0.07, 0.006)]
)
def test_every_joint_of_a_stack_is_pressed_by_the_weight_above_it(spacing, inset, make_structure, run_ls_dem):
    """Three blocks; stiffness is per area, so that spacing and inset of the nodes drop out."""
    bodies = [{"name": f"b{i}", "shape": "block", "position": [0.0, 0.0, 0.8 + 1.6 * i]} for i in range(3)]
    structure = make_structure(bodies, shapes=SEAT)
    run = run_ls_dem(structure, 0.02, node_spacing=spacing, perimeter_inset=inset)
    sunk = structure.position[1:, 2] - run.position[-1, 1:, 2]
    depth = np.diff(sunk, prepend=0.0)
    above = structure.mass[1] * G * np.array([3.0, 2.0, 1.0])
    np.testing.assert_allclose(depth, above / (K_N * FLAT), rtol=REST)
    np.testing.assert_allclose(run.joint_force[-1, :, 2], above, rtol=REST)


@pytest.mark.parametrize("face", TURNS)
def test_each_of_a_blocks_six_faces_carries_it(face, make_structure, run_ls_dem):
    """A block of three unlike edges on each face in turn, over a wide sharp slab of the same flat area."""
    edges = np.array([0.8, 2.4, 1.6])
    up = {"bottom": 2, "top": 2, "front": 0, "back": 0, "left": 1, "right": 1}[face]
    # edges along world x, y, z as it lies
    lying = {2: edges, 0: edges[[2, 1, 0]], 1: edges[[0, 2, 1]]}[up]
    seat = {"slab": {"box": [lying[0], lying[1], 0.2], "chamfer": 0.02}}
    body = {
        "name": "b", "shape": "block", "position": [0.0, 0.0, lying[2] / 2.0], "orientation": TURNS[face]
    }  # fmt: skip
    structure = make_structure([body], shapes=seat)
    run = run_ls_dem(structure, 0.02)
    depth = structure.position[1, 2] - run.position[-1, 1, 2]
    area = (lying[0] - 0.04) * (lying[1] - 0.04)
    assert depth == pytest.approx(structure.mass[1] * G / (K_N * area), rel=REST)


@pytest.mark.parametrize("first", ["plate", "posts"])
def test_a_face_between_the_nodes_of_another_carries_by_its_own(first, make_structure, run_ls_dem):
    """Posts between a loose plate's nodes stand on the stiffness of their whole faces.

    At 1 m spacing the plate's nodes lie at 0 and about 1 m along x and y; four posts of 0.3 m stand at 0.5 m.
    """
    shapes = {
        "slab": {"box": [8.0, 8.0, 0.2]}, "plate": {"box": [4.0, 4.0, 0.2]}, "post": {"box": [0.3, 0.3, 0.6]},
    }  # fmt: skip
    plate = [{"name": "plate", "shape": "plate", "position": [0.0, 0.0, 0.1]}]
    posts = [
        {"name": f"post-{place}", "shape": "post", "position": [x, y, 0.5]}
        for place, (x, y) in enumerate([(-0.5, -0.5), (-0.5, 0.5), (0.5, -0.5), (0.5, 0.5)])
    ]
    # as seen from either side of a pair
    structure = make_structure(plate + posts if first == "plate" else posts + plate, shapes=shapes)
    run = run_ls_dem(structure, 0.02, node_spacing=1.0)
    sunk = dict(zip(structure.body_names, structure.position[:, 2] - run.position[-1, :, 2], strict=True))
    weight = structure.mass[structure.body_names.index("post-0")] * G
    for name in (post["name"] for post in posts):
        assert sunk[name] - sunk["plate"] == pytest.approx(weight / (K_N * 0.3**2), rel=REST)


def test_a_body_on_a_wide_slab_carries_all_by_its_own_nodes(make_structure, run_ls_dem):
    """The same post on the driven slab, between the slab's nodes: the stiffness of its whole face."""
    shapes = {"slab": {"box": [4.0, 4.0, 0.2]}, "post": {"box": [0.3, 0.3, 0.6]}}
    structure = make_structure(
        [{"name": "post", "shape": "post", "position": [0.5, 0.5, 0.3]}], shapes=shapes
    )
    run = run_ls_dem(structure, 0.02, node_spacing=1.0)
    depth = structure.position[1, 2] - run.position[-1, 1, 2]
    assert depth == pytest.approx(structure.mass[1] * G / (K_N * 0.3**2), rel=REST)
