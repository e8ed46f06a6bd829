import numpy as np
import pytest

from blockshake.dynamics.motion import ground_motion
from blockshake.geometry.structure import load_structure

G = 9.81


@pytest.fixture(scope="module")
def rocked(run_ls_dem):
    time = np.arange(0.0, 0.8001, 0.002)
    motion = ground_motion("sine", time, {"x": 0.5 * G * np.sin(2 * np.pi * 2.0 * time)}, "acceleration")
    structure = load_structure("configuration-1")
    return {skin: run_ls_dem(structure, 0.8, motion=motion, skin=skin) for skin in (0.005, 0.05, 20.0)}


@pytest.mark.parametrize("skin", [0.05, 20.0])
def test_the_skin_changes_speed_and_never_results(rocked, skin):
    """At 20 m every node is always listed: no contact is missed at 5 mm.

    The nodes' order is the same but they are summed in groups of eight, so that sums differ in their
    last bits; 1e-16 of rounding grows by rocking in 0.8 s to no more than this.
    """
    rounding = 1e-9
    short, long = rocked[0.005], rocked[skin]
    assert 2.0 * np.abs(short.orientation[:, 1:, 2]).max() > 0.005
    assert short.numerics["list_searches"] > 10
    assert rocked[20.0].numerics["list_searches"] == 1
    np.testing.assert_allclose(short.position, long.position, atol=rounding)
    np.testing.assert_allclose(short.orientation, long.orientation, atol=rounding)


def test_a_pair_that_sleeps_wakes_before_it_touches(make_structure, run_ls_dem):
    """Blocks 2 mm apart sleep for the first millimetre; with a skin of 20 m such a gap is too small for sleep."""
    bodies = [
        {"name": "still", "shape": "block", "position": [0.0, 0.0, 0.8]},
        {"name": "coming", "shape": "block", "position": [-0.802, 0.0, 0.8], "velocity": [0.4, 0.0, 0.0]},
    ]
    asleep, awake = (run_ls_dem(make_structure(bodies), 0.05, rate=1000, skin=skin) for skin in (0.005, 20.0))
    still = asleep.position[:, 1, 0]
    assert abs(still[4]) < 1e-6 < 1e-4 < abs(still[-1])  # at 0.4 m/s the gap lasts 5 ms and more
    np.testing.assert_allclose(
        asleep.position, awake.position, atol=1e-9
    )  # sums in other groups of eight, as above


@pytest.mark.parametrize("order", [(0, 1), (1, 0)])
def test_a_narrow_body_between_the_nodes_of_a_wide_one_is_found(order, make_structure, run_ls_dem):
    """Only the narrow body's nodes see the contact, whichever comes first in the file."""
    shapes = {"plate": {"box": [4.0, 4.0, 0.5]}, "post": {"box": [0.3, 0.3, 1.0]}}
    bodies = [
        {"name": "plate", "shape": "plate", "position": [0.0, 0.0, 5.0]},
        {"name": "post", "shape": "post", "position": [0.5, 0.5, 4.2499], "velocity": [0.0, 0.0, 1.0]},
    ]
    structure = make_structure([bodies[i] for i in order], slab=False, shapes=shapes, gravity=[0.0, 0.0, 0.0])
    run = run_ls_dem(structure, 0.05, node_spacing=1.0, rate=1000)
    post = order.index(1)
    assert run.velocity[-1, post, 2] < 0.0
    assert run.velocity[-1, 1 - post, 2] > 0.0
    overlap = run.position[:, post, 2] + 0.5 - (run.position[:, 1 - post, 2] - 0.25)
    assert overlap.max() < 1e-3
    # the upper body is pushed up
    assert run.joint_force[:, 0, 2].max() > 0.0
    np.testing.assert_array_equal(run.joints, [[post, 1 - post]])


def test_an_overhanging_block_stands(make_structure, run_ls_dem):
    """Mass centre 23 cm inside the edge of the block below, in the middle third of what carries it."""
    structure = make_structure(
        [
            {"name": "lower", "shape": "block", "position": [0.0, 0.0, 0.8]},
            {"name": "upper", "shape": "block", "position": [0.15, 0.0, 2.4]},
        ]
    )
    run = run_ls_dem(structure, 0.5)
    assert run.status == "completed"
    assert np.abs(run.position[:, 2] - structure.position[2]).max() < 1e-4
    weight = structure.mass[2] * G
    joint = [list(pair) for pair in run.joints].index([1, 2])
    assert run.joint_force[-1, joint, 2] == pytest.approx(weight, rel=1e-6)


def test_a_corner_is_held_by_a_face(make_structure, run_ls_dem):
    """A cube falling corner first: its nodes near the corner are the contact.

    They lie 3 mm inside the edges, so that the corner goes in 3.5 mm before they touch.
    """
    axis = np.cross([1.0, 1.0, 1.0], [0.0, 0.0, 1.0]) / np.sqrt(2.0)
    angle = np.arccos(np.sqrt(1.0 / 3.0))
    orientation = [np.cos(angle / 2), *(np.sin(angle / 2) * axis)]
    centre = np.sqrt(3.0) / 2.0 + 0.01
    structure = make_structure(
        [{"name": "b", "shape": "cube", "position": [0.1, 0.05, centre], "orientation": orientation}]
    )
    run = run_ls_dem(structure, 0.15, rate=1000)
    lowest = run.position[:, 1, 2].min()
    blunt = 2.0 * 0.003 / np.sqrt(3.0)
    fall = 2.0 * G * (0.01 + blunt)
    # three nodes of about 0.01 m2, half the stiffness: x = v sqrt(m / k)
    spring = np.sqrt(fall * structure.mass[1] / (3 * 0.5 * 2.16e10 * 0.005))
    assert np.sqrt(3.0) / 2.0 - blunt - 2.0 * spring < lowest < np.sqrt(3.0) / 2.0 - blunt
    assert run.velocity[:, 1, 2].max() > 0.0
