import numpy as np
import pytest
from scipy.spatial.transform import Rotation

from blockshake.dynamics.motion import ground_motion
from blockshake.geometry.structure import load_structure

G = 9.81
KINETIC, POTENTIAL, ELASTIC, FRICTION, CONTACT, VISCOUS, INPUT = range(7)
# Of the energy in play, at a step of 5e-5 s. Impacts are kinks: each misses about (omega dt)^2 / 8 = 2e-3 of
# the elastic energy it stores (omega = 2,300 rad/s), which is some percent of the rocking energy; some ten
# impacts add up.
AUDIT = 5e-4
UNDAMPED = 1e-3  # ten impacts of 2e-3 of a twentieth; nodes 0.3 % and 0.66 % inside have medians of 4.9e-4 and 7.6e-4


def _residual(run):
    """Residual of the energy balance of docs/guide/contracts.md: held - initial - input + dissipated."""
    e = run.energy
    held = e[:, :3].sum(axis=1)
    return held - held[0] - e[:, INPUT] + e[:, 3:6].sum(axis=1) - e[0, 3:6].sum()


def _sine(frequency, amplitude, duration, cycles):
    time = np.arange(0.0, duration + 1e-9, 0.002)
    x = np.where(time < cycles / frequency, amplitude * np.sin(2 * np.pi * frequency * time), 0.0)
    return ground_motion("sine", time, {"x": x}, "acceleration")


@pytest.fixture(scope="module")
def rocking(run_ls_dem):
    """Configuration 1 rocked by two cycles of about 0.35 g at 1.5 Hz, five times; the middle one is of 0.35 g."""
    runs = {}
    for restitution in (0.5, 1.0):
        structure = load_structure("configuration-1", {"restitution": restitution})
        runs[restitution] = [
            run_ls_dem(structure, 2.5, motion=_sine(1.5, part * G, 2.5, 2))
            for part in (0.345, 0.347, 0.35, 0.353, 0.355)
        ]
    return runs


@pytest.mark.parametrize("restitution", [0.5, 1.0])
def test_the_audit_closes_in_a_rocking_stack(restitution, rocking):
    """By the median of five runs nearly alike: undamped impacts go on and on, and one run misses 1e-4 to 2e-3."""
    missed = []
    for run in rocking[restitution]:
        assert run.status == "completed"
        lean = 2.0 * np.abs(run.orientation[:, 3, 2]).max()
        assert lean > 0.005  # it did rock
        missed.append(np.abs(_residual(run)).max() / np.abs(run.energy[:, INPUT]).max())
    assert np.median(missed) < (AUDIT if restitution < 1.0 else UNDAMPED)


@pytest.mark.parametrize("restitution", [0.5, 1.0])
def test_dissipated_terms_are_positive_and_grow(restitution, rocking):
    e = rocking[restitution][2].energy
    for term in (FRICTION, CONTACT, VISCOUS):
        assert e[0, term] == 0.0
        assert e[-1, term] >= 0.0
        # a node that lets go while it swings back counts a step's elastic unloading the other way
        assert np.diff(e[:, term]).min() >= -1e-6 * max(e[-1, FRICTION:INPUT].sum(), 1.0)
    assert e[-1, FRICTION] > 0.0
    # without a dashpot the contact term is what shear springs held along a normal that turned: little
    share = e[-1, CONTACT] / e[-1, FRICTION]
    assert share > 0.1 if restitution == 0.5 else share < 0.02
    assert (e[:, VISCOUS] == 0.0).all()
    assert (e[:, ELASTIC] >= 0.0).all()


def _orders(runs):
    errors = [np.abs(_residual(run)).max() for run in runs]
    return errors, np.log2(np.divide(errors[:-1], errors[1:]))


def _pitched(make_structure, run_ls_dem, dt):
    time = np.arange(0.0, 1.50001, 0.005)
    pitch = 0.05 * np.sin(2 * np.pi * time) * np.clip(time / 0.5, 0.0, 1.0) ** 2
    motion = ground_motion("pitch", time, {"pitch_y": pitch}, "displacement")
    structure = make_structure([{"name": "b", "shape": "block", "position": [1.0, 0.0, 0.8]}], friction=0.8)
    return run_ls_dem(structure, 1.4, motion=motion, time_step=dt)


def test_a_pitched_slab_carries_its_block_to_second_order(make_structure, run_ls_dem):
    """Friction and damping at work, no slip: the audit's order, and no creep in the slab's frame.

    Shear springs that follow velocities with the lever arms of a step's end creep outwards by
    half a step times the centripetal acceleration: 2 and 0.25 micrometres here.
    """
    # over factors of eight: the largest of the recorded residuals scatters with the places of the steps
    runs = [_pitched(make_structure, run_ls_dem, dt) for dt in (1e-4, 1.25e-5)]
    errors, orders = _orders(runs)
    in_play = runs[0].energy[:, INPUT].max()
    assert errors[0] < 1e-7 * in_play
    assert orders[0] / 3.0 == pytest.approx(2.0, abs=0.15)
    # at 1 s the slab is level again
    seen = []
    for run in runs:
        slab = Rotation.from_quat(run.orientation[:, 0], scalar_first=True)
        offset = slab.inv().apply(run.position[:, 1] - run.position[:, 0])
        seen.append(offset[200] - offset[0])
    assert 2.0 * np.arcsin(runs[0].orientation[:, 0, 2].max()) > 0.045
    np.testing.assert_allclose(seen[0], seen[1], atol=5e-8)


def test_lifting_the_slab_takes_the_weight_times_the_height(make_structure, run_ls_dem):
    """Work of the driven body against its contact forces."""
    time = np.linspace(0.0, 1.0, 101)
    motion = ground_motion("lift", time, {"z": 0.05 * np.sin(0.5 * np.pi * time) ** 4}, "displacement")
    structure = make_structure([{"name": "b", "shape": "block", "position": [0.0, 0.0, 0.8]}])
    run = run_ls_dem(structure, 1.0, motion=motion)
    lifted = run.position[:, 0, 2] - run.position[0, 0, 2]
    work = structure.mass[1] * (G * lifted + 0.5 * run.velocity[:, 0, 2] ** 2)
    # the springs store and the block lags by a micrometre: mg 2 um = 0.1 J of 3,600 J
    np.testing.assert_allclose(run.energy[:, INPUT], work, atol=1e-4 * work.max())
