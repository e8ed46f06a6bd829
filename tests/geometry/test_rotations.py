import numpy as np
from hypothesis import given, settings
from hypothesis import strategies as st
from scipy.spatial.transform import Rotation

from blockshake.geometry.rotations import rotate_into, rotation_matrices, rotation_matrix_into

ROUNDING = 1e-14
components = st.floats(-3.0, 3.0)
vectors = st.tuples(components, components, components)


def _quaternion(vector):
    return Rotation.from_rotvec(vector).as_quat(scalar_first=True)


@given(vectors)
@settings(max_examples=100, deadline=None)
def test_both_matrices_are_scipys(vector):
    q, R = _quaternion(vector), np.empty((3, 3))
    rotation_matrix_into(q, R)
    np.testing.assert_allclose(R, Rotation.from_rotvec(vector).as_matrix(), atol=ROUNDING)
    np.testing.assert_allclose(rotation_matrices(q[None])[0], R, atol=ROUNDING)


@given(vectors, vectors, st.sampled_from([1.0, 1e-3, 1e-5, 1e-9, 0.0]))
@settings(max_examples=100, deadline=None)
def test_a_world_frame_turn_multiplies_from_the_left(start, turn, scale):
    """Also through the series near zero, and in place."""
    turn = scale * np.array(turn)
    q = _quaternion(start)
    rotate_into(q, turn, q)
    expected = Rotation.from_rotvec(turn) * Rotation.from_rotvec(start)
    np.testing.assert_allclose(rotation_matrices(q), expected.as_matrix(), atol=ROUNDING)
    assert abs(np.linalg.norm(q) - 1.0) < 1e-15


def test_positive_about_y_leans_the_top_to_plus_x():
    """Rotations are right-handed (docs/guide/contracts.md, frames)."""
    q = np.array([1.0, 0.0, 0.0, 0.0])
    rotate_into(q, np.array([0.0, 0.1, 0.0]), q)
    assert (rotation_matrices(q) @ [0.0, 0.0, 1.0])[0] > 0.0


def test_the_quaternion_keeps_its_sign_through_full_turns():
    q = np.array([1.0, 0.0, 0.0, 0.0])
    for _ in range(200):
        before = q.copy()
        rotate_into(q, np.array([0.0, 0.05, 0.0]), q)
        assert q @ before > 0.9


def test_a_tiny_turn_has_the_cosine_of_the_library_to_the_last_bit():
    """The first component of the unit quaternion turned: the cosine of half the angle over the norm."""
    for angle in 10.0 ** np.random.default_rng(0).uniform(-12.0, -4.0, 2000):
        q = np.array([1.0, 0.0, 0.0, 0.0])
        rotate_into(q, np.array([angle, 0.0, 0.0]), q)
        c, s = np.cos(0.5 * angle), (0.5 - angle * angle / 48.0) * angle
        assert q[0] == c / np.sqrt(c * c + s * s)
