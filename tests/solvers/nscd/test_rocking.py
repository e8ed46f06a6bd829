import numpy as np
import pytest
from scipy.integrate import solve_ivp

G = 9.81
B, H = 0.4, 1.6  # full width and height of a sharp block, m
SHAPES = {"tall": {"box": [B, 1.0, H]}}
ALPHA = np.arctan(B / H)
R = 0.5 * np.hypot(B, H)


def leaning(scene, lean):
    """Block tilted by ``lean`` about its lower +x edge."""
    x = 0.5 * B - R * np.sin(ALPHA - lean)
    body = {
        "name": "b", "shape": "tall", "position": [x, 0, R * np.cos(ALPHA - lean)],
        "orientation": [np.cos(0.5 * lean), 0, np.sin(0.5 * lean), 0],
    }  # fmt: skip
    return scene(SHAPES, [body], friction=2.0)


def tilt(run):
    return 2.0 * np.arctan2(run.orientation[:, 1, 2], run.orientation[:, 1, 0])


def exact_time_to_impact(lean):
    """Housner (1963), Eq. (1) without his small-angle step: 4/3 R theta'' = -g sin(alpha - theta)."""
    landed = lambda t, y: y[0]  # noqa: E731
    landed.terminal = True
    answer = solve_ivp(
        lambda t, y: [y[1], -0.75 * G / R * np.sin(ALPHA - y[0])],
        (0, 5),
        [lean, 0.0],
        events=landed,
        rtol=1e-10,
        atol=1e-12,
    )
    return answer.t[-1]


def test_falling_edge_follows_the_equation_of_motion(scene, simulate):
    lean = 0.5 * ALPHA
    end = 0.8 * exact_time_to_impact(lean)
    exact = solve_ivp(
        lambda t, y: [y[1], -0.75 * G / R * np.sin(ALPHA - y[0])],
        (0, end),
        [lean, 0.0],
        rtol=1e-10,
        atol=1e-12,
    ).y[0, -1]
    errors = []
    for time_step in (2e-3, 1e-3):
        run = simulate(leaning(scene, lean), end, time_step=time_step, output_step=end)
        errors.append(abs(tilt(run)[-1] - exact))
    # the pivot stays and the angle converges
    assert errors[1] < 1e-3 * lean
    assert errors[1] < 0.6 * errors[0]


@pytest.mark.parametrize(("share", "lifts"), [(0.98, False), (1.02, True)])
def test_uplift_begins_at_the_static_threshold(scene, simulate, push, share, lifts):
    # a rigid block lifts off when the floor accelerates faster than g b / h
    structure = scene(SHAPES, [{"name": "b", "shape": "tall", "position": [0, 0, 0.5 * H]}], friction=2.0)
    run = simulate(structure, 0.4, motion=push(share * G * B / H, 0.5, 1.0))
    assert (np.abs(tilt(run)).max() > 1e-4) == lifts
    if not lifts:
        assert np.abs(tilt(run)).max() < 1e-7


def test_block_beyond_its_tipping_point_collapses(scene, simulate):
    run = simulate(leaning(scene, 1.05 * ALPHA), 4.0)
    assert run.status == "collapsed"
    assert "b " in run.reason
    assert 0.5 < run.end_time < 4.0
    assert np.isnan(run.position[-1]).all()
    kept = run.time <= run.end_time
    assert np.isfinite(run.position[kept]).all()
