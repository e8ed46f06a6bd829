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


@pytest.mark.parametrize("time_step", [1e-3, 2e-4])
def test_housner_ratio_of_angular_velocities(scene, simulate, time_step):
    lean = 0.5 * ALPHA
    run = simulate(leaning(scene, lean), 1.2, time_step=time_step, output_step=time_step)
    spin, impact = run.angular_velocity[:, 1, 1], exact_time_to_impact(lean)
    before = (run.time > impact - 0.05) & (run.time < impact - 3 * time_step)
    after = (run.time > impact + 3 * time_step) & (run.time < impact + 0.05)
    at_impact = [
        np.polyval(np.polyfit(run.time[part] - impact, spin[part], 2), 0.0) for part in (before, after)
    ]
    # Housner (1963), Eq. (9): within 1 % at 2e-4 s, and the same at 1e-3 s
    assert at_impact[1] / at_impact[0] == pytest.approx(1.0 - 1.5 * np.sin(ALPHA) ** 2, rel=0.01)


def test_quarter_period_of_free_rocking(scene, simulate):
    lean = 0.5 * ALPHA
    run = simulate(leaning(scene, lean), 1.0, output_step=1e-3)
    landed = run.time[np.argmax(tilt(run) <= 1e-4)]
    # the time is read to a step
    assert landed == pytest.approx(exact_time_to_impact(lean), abs=2e-3)


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
