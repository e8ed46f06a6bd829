"""A soft layer in a joint (`compliance`), in both solvers: statics, bouncing, rocking on it, and the rigid limit."""

import numpy as np
import pytest
from both_solvers import both, leans, solve
from scipy.linalg import eigh
from scipy.optimize import curve_fit

from blockshake.dynamics.motion import ground_motion

G = 9.81
K_N, K_S = 2.16e10, 9.0e9  # N/m3, ls_dem.normal_stiffness and shear_stiffness by default
B, H, DEPTH = 0.4, 0.8, 2.4  # m, half width, half height and depth of the sharp block
AREA, SECOND_MOMENT = 2.0 * B * DEPTH, DEPTH * (2.0 * B) ** 3 / 12.0
MASS = AREA * 2.0 * H * 2400.0
CENTRAL = MASS * ((2.0 * B) ** 2 + (2.0 * H) ** 2) / 12.0
# a slab as wide as the block: LS-DEM's nodes on both sides then have the block's area and second moment
SEAT = {"slab": {"box": [2.0 * B, DEPTH, 0.2]}}
# what a joint gives next to its layer [m3/N], normal and shear
OWN = {"ls-dem": (1.0 / K_N, 1.0 / K_S), "nscd": (0.0, 0.0)}
STEP = {"ls-dem": 2e-5, "nscd": 2.5e-5}


def _run(solver, structure, times, motion=None, time_step=None, **keys):
    return solve(solver, structure, times, motion, time_step or STEP[solver], **keys)


def _block(compliance, **keys):
    body = {"name": "b", "shape": "sharp", "position": [0.0, 0.0, H], **keys}
    return [body], [{"bodies": ["b", "slab"], "compliance": compliance}]


@both
def test_a_stack_starts_compressed_and_stays_so(solver, make_structure):
    """Hooke: each joint closes by ``c N / A``, in series with LS-DEM's own; nothing thumps, and the energy is there."""
    compliance = np.array([3e-10, 0.0, 5e-10])
    names = ["slab", "b0", "b1", "b2"]
    bodies = [{"name": f"b{i}", "shape": "sharp", "position": [0.0, 0.0, H + 2.0 * H * i]} for i in range(3)]
    joints = [{"bodies": names[i : i + 2], "compliance": float(compliance[i])} for i in range(3)]
    structure = make_structure(bodies, shapes=SEAT, joints=joints)
    run = _run(solver, structure, np.linspace(0.0, 0.05, 11), time_step=1e-4 if solver == "nscd" else None)
    pressure = MASS * G * np.array([3.0, 2.0, 1.0]) / AREA
    depth = (compliance + OWN[solver][0]) * pressure
    sunk = structure.position[1:, 2] - run.position[:, 1:, 2]
    # both start from an equilibrium with 1e-9 of the weight out of balance; NSCD's steps are solved to 1e-8
    np.testing.assert_allclose(np.diff(sunk, prepend=0.0, axis=1), depth + 0.0 * sunk, rtol=1e-6, atol=1e-13)
    np.testing.assert_allclose(run.energy[:, 2], 0.5 * AREA * depth @ pressure, rtol=1e-6)
    # none of it moves: what falls by a thousandth of the depth has a thousandth of the elastic energy
    assert run.energy[:, 0].max() < 1e-9 * run.energy[0, 2]
    np.testing.assert_allclose(run.joint_force[-1, :, 2], AREA * pressure, rtol=1e-6)


@both
def test_an_equilibrium_beyond_a_tenth_of_a_millimetre_is_not_the_start(solver, make_structure):
    """Design, 9. The weight closes the layer by 0.19 mm: the block starts as given and falls on it, to twice that."""
    compliance = 5e-9
    bodies, joints = _block(compliance)
    structure = make_structure(bodies, shapes=SEAT, joints=joints, restitution=1.0)
    run = _run(solver, structure, np.linspace(0.0, 0.05, 501))
    np.testing.assert_array_equal(run.position[0], structure.position)
    depth = (compliance + OWN[solver][0]) * MASS * G / AREA
    # NSCD damps by omega dt / 4 = 1.4e-3 of critical, pi times that in half a swing
    assert H - run.position[:, 1, 2].min() == pytest.approx(2.0 * depth, rel=5e-3)
    balance = run.energy[:, :6].sum(axis=1) - run.energy[:, 6]
    assert np.ptp(balance) < 1e-3 * MASS * G * depth


def _frequency(time, values, guess):
    """Angular frequency and decay rate of a damped sine that was fitted to a history about its mean."""

    def swing(t, frequency, decay, sine, cosine, mean):
        return np.exp(-decay * t) * (sine * np.sin(frequency * t) + cosine * np.cos(frequency * t)) + mean

    scaled = (values - values.mean()) / np.ptp(values)
    return guess * curve_fit(swing, guess * time, scaled, p0=[1.0, 0.0, 0.5, 0.0, 0.0])[0][:2]


@both
def test_bouncing_on_the_layer(solver, make_structure):
    """``omega^2 = k A / m``; NSCD's implicit rule damps by ``omega dt / 4`` of critical, LS-DEM not at all."""
    compliance = 5e-10
    stiffness = 1.0 / (compliance + OWN[solver][0])
    frequency, depth = np.sqrt(stiffness * AREA / MASS), MASS * G / (stiffness * AREA)
    bodies, joints = _block(compliance, velocity=[0.0, 0.0, 0.3 * depth * frequency])
    structure = make_structure(bodies, shapes=SEAT, joints=joints, restitution=1.0)
    times = np.linspace(0.0, 20.0 * np.pi / frequency, 401)
    run = _run(solver, structure, times)
    found, decay = _frequency(times, run.position[:, 1, 2], frequency)
    # of second order in omega dt = 0.018: 1e-4; NSCD's records are chords of its steps
    assert found == pytest.approx(frequency, rel=5e-4)
    damping = frequency * STEP["nscd"] / 4.0 * frequency if solver == "nscd" else 0.0
    assert decay == pytest.approx(damping, rel=0.02, abs=1e-5 * frequency)
    balance = run.energy[:, :6].sum(axis=1) - run.energy[:, 6]
    assert np.ptp(balance) < 1e-3 * np.ptp(run.energy[:, 0])
    assert np.diff(run.energy[:, 4]).min() >= 0.0


@both
def test_rocking_on_the_layer(solver, make_structure):
    """The lower mode of a block on Winkler's base: ``k I - m g h`` against rotation, in NSCD about the foot.

    LS-DEM's shear springs let the foot sway: two degrees of freedom, x and rotation.
    """
    compliance = 5e-10
    own_normal, own_shear = OWN[solver]
    stiffness = 1.0 / (compliance + own_normal)
    shear = AREA / max(own_shear, 1e-16)
    turning = stiffness * SECOND_MOMENT - MASS * G * H
    K = np.array([[shear, -shear * H], [-shear * H, turning + shear * H * H]])
    values, modes = eigh(K, np.diag([MASS, CENTRAL]))
    frequency, mode = np.sqrt(values[0]), modes[:, 0] / modes[1, 0]
    # the edges stay pressed: they move by 0.4 of what the weight closes
    spin = 0.4 * MASS * G / (stiffness * AREA) / B * frequency
    bodies, joints = _block(
        compliance, angular_velocity=[0.0, spin, 0.0], velocity=[spin * mode[0], 0.0, 0.0]
    )  # fmt: skip
    structure = make_structure(bodies, shapes=SEAT, joints=joints, friction=0.9, restitution=1.0)
    times = np.linspace(0.0, 20.0 * np.pi / frequency, 401)
    run = _run(solver, structure, times, time_step=4.0 * STEP[solver])
    lean = leans(run)
    found, _ = _frequency(times, lean, frequency)
    # of second order in omega dt = 0.018, and in the lean, 1e-5
    assert found == pytest.approx(frequency, rel=1e-3)
    assert np.ptp(lean) == pytest.approx(2.0 * spin / frequency, rel=0.05)


def test_the_solvers_agree_on_a_soft_stack(make_structure):
    """Two blocks on a soft joint under a sine: with LS-DEM's own springs 200 times stiffer than the layer."""
    bodies = [{"name": f"b{i}", "shape": "sharp", "position": [0.0, 0.0, H + 2.0 * H * i]} for i in range(2)]
    joints = [{"bodies": ["slab", "b0"], "compliance": 1e-9}]
    structure = make_structure(bodies, shapes=SEAT, joints=joints, friction=0.9, restitution=1.0)
    time = np.linspace(0.0, 0.5, 101)
    motion = ground_motion("sine", time, {"x": 0.2 * np.sin(25.0 * time)}, "acceleration")
    stiff = {"normal_stiffness": 2e11, "shear_stiffness": 2e11}
    runs = [
        _run("ls-dem", structure, time, motion, 1e-5, **stiff),
        _run("nscd", structure, time, motion, 1e-4),
    ]
    top = [run.position[:, 2, 0] - run.position[:, 0, 0] for run in runs]
    static = 0.2 * MASS * (H + 3.0 * H) * 4.0 * H / (SECOND_MOMENT / 1e-9)
    assert np.ptp(top[0]) > static
    # LS-DEM's own springs soften the stack by 2/200 and its frequency, 45 rad/s, by 1/200: 0.1 rad in 0.5 s of a free
    # swing that is half of the motion
    np.testing.assert_allclose(top[0], top[1], atol=0.03 * np.ptp(top[0]))


def test_nscd_rocks_on_a_stiff_layer_as_on_none(make_structure):
    """Let go at 0.05 rad, the pivot gives way by ``6 c N / A``, 0.02 mm: the quarter period stays Housner's."""
    c, s = np.cos(0.05), np.sin(0.05)
    body = {
        "name": "b", "shape": "sharp", "position": [B - B * c + H * s, 0.0, B * s + H * c],
        "orientation": [np.cos(0.025), 0.0, np.sin(0.025), 0.0],
    }  # fmt: skip
    upright = []
    for compliance in (0.0, 1e-10):
        joints = [{"bodies": ["slab", "b"], "compliance": compliance}]
        run = _run(
            "nscd",
            make_structure([body], friction=0.9, joints=joints),
            np.linspace(0.0, 0.5, 1001),
            None,
            1e-4,
        )
        lean = leans(run)
        after = np.flatnonzero(lean < 0.0)[0]
        upright.append(np.interp(0.0, [lean[after], lean[after - 1]], run.time[[after, after - 1]]))
        assert run.numerics["energy_residual"] < 1e-4
    # 0.02 mm over the edge's speed of 0.3 m/s, and the bounce of the start about it
    assert upright[1] == pytest.approx(upright[0], abs=3e-4)
