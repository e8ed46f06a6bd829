import numpy as np

from blockshake.geometry.structure import load_structure
from blockshake.simulation.placement import placed


def test_blocks_stand_where_they_are_put_and_the_slab_stays():
    plain = load_structure("configuration-1")
    places = np.zeros((4, 3))
    places[:] = [0.01, -0.02, 0.03]
    moved = load_structure("configuration-1", placed(plain, places))
    np.testing.assert_allclose(moved.position[1:] - plain.position[1:], [[0.01, -0.02, 0.0]] * 3, atol=1e-15)
    np.testing.assert_array_equal(moved.position[0], plain.position[0])
    # a rotation about z by an angle: Diebel (2006), quaternion (cos(a/2), 0, 0, sin(a/2))
    np.testing.assert_allclose(
        moved.orientation[1:], [[np.cos(0.015), 0.0, 0.0, np.sin(0.015)]] * 3, atol=1e-15
    )


def test_no_displacement_gives_the_structure_itself():
    plain = load_structure("configuration-2")
    same = load_structure("configuration-2", placed(plain, np.zeros((5, 3))))
    np.testing.assert_array_equal(same.position, plain.position)
    np.testing.assert_array_equal(same.orientation, plain.orientation)
