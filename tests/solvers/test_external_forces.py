"""Forces from outside, by every model of contact, against their motions in closed form."""

import numpy as np
import pytest

from blockshake.dynamics.motion import ground_motion
from blockshake.errors import InputError
from blockshake.simulation.models import MODELS
from blockshake.simulation.simulate import simulate

G = 9.81
MASS = 2400.0  # of the cube
TIME_STEP = {"ls-dem": 5e-5, "nscd-rigid": 1e-3, "nscd-elastic": 1e-3, "nscd-viscoelastic": 1e-3}
STONE = {"density": MASS, "youngs_modulus": 3.45e10, "poisson_ratio": 0.2, "viscous_modulus": 1.5e8}
AUDITED = ["ls-dem", "nscd-rigid"]

REST = ground_motion("rest", np.array([0.0, 1.0]), {"x": np.zeros(2)}, "displacement", {"source": "test"})

by_model = pytest.mark.parametrize("model", sorted(MODELS))


@pytest.fixture(scope="module")
def run(make_structure):
    """Run of a cube with an external force on it, on rough ground or in free fall."""

    def run(model, duration, friction=0.5, floating=False, **force):
        cube = {"name": "cube", "shape": "cube", "position": [0.0, 0.0, 5.0 if floating else 0.5]}
        structure = make_structure(
            [cube],
            friction=friction,
            slab=not floating,
            external_forces=[{"body": "cube", **force}],
            materials={"stone": STONE},
            **({"gravity": [0.0, 0.0, 0.0]} if floating else {}),
        )
        return simulate(
            structure, REST, model, duration=duration, output_rate=100.0, time_step=TIME_STEP[model]
        )

    return run


def centre(run):
    return run["position"].sel(body="cube").to_numpy()


@by_model
def test_a_pulse_leaves_its_impulse_over_the_mass(run, model):
    """Newton's second law: v = F (t2 - t1) / m, and the spin J / I about the mass centre by the lever of 0.5 m."""
    found = run(model, 0.4, floating=True, amplitude=4800.0, start=0.1, end=0.2, position=[0.0, 0.0, 0.5])
    velocity = found["velocity"].sel(body="cube").to_numpy()
    assert np.abs(velocity[:10]).max() == 0.0
    assert velocity[-1, 0] == pytest.approx(4800.0 * 0.1 / MASS, rel=2e-3)
    spin = found["angular_velocity"].sel(body="cube").to_numpy()[-1]
    inertia = MASS / 6.0
    # the arm turns with the cube, by 0.03 rad over the pulse
    assert spin[1] == pytest.approx(4800.0 * 0.1 * 0.5 / inertia, rel=2e-3)


@by_model
def test_a_spring_to_the_table_swings_with_its_period(run, model):
    """x = x0 cos(omega t) with omega^2 = k / m, here about the place to which a constant force holds the spring."""
    stiffness = MASS * (2.0 * np.pi) ** 2
    found = run(model, 1.0, floating=True, amplitude=0.01 * stiffness, stiffness=stiffness)
    time = found["time"].to_numpy()
    expected = 0.01 * (1.0 - np.cos(2.0 * np.pi * time))
    assert centre(found)[:, 0] == pytest.approx(expected, abs=2e-5)


@by_model
def test_a_damper_slows_by_its_rate(run, model):
    """Terminal velocity F / c, reached as 1 - exp(-c t / m)."""
    damping = 10.0 * MASS
    found = run(model, 0.5, floating=True, amplitude=0.1 * damping, damping=damping)
    velocity = found["velocity"].sel(body="cube", axis="x").to_numpy()
    expected = 0.1 * (1.0 - np.exp(-10.0 * found["time"].to_numpy()))
    assert velocity == pytest.approx(expected, abs=1e-3)


@by_model
def test_a_push_beyond_friction_slides_the_block(run, model):
    """Coulomb: a = F / m - mu g once the push exceeds mu m g; below it nothing moves."""
    weight = MASS * G
    found = run(model, 0.6, friction=0.3, amplitude=0.5 * weight, start=0.1)
    time = found["time"].to_numpy()
    expected = 0.5 * 0.2 * G * np.maximum(time - 0.1, 0.0) ** 2
    assert centre(found)[:, 0] == pytest.approx(expected, abs=2e-3)
    held = run(model, 0.4, friction=0.3, amplitude=0.25 * weight, start=0.1)
    assert np.abs(centre(held)[:, 0]).max() < 1e-4


@pytest.mark.parametrize("model", AUDITED)
def test_the_work_of_an_external_force_is_input(run, model):
    """Input is force times displacement of its point, and the audit closes."""
    weight = MASS * G
    found = run(model, 0.6, friction=0.3, amplitude=0.5 * weight)
    energy = found["energy"].sel(term="input").to_numpy()
    assert energy[-1] == pytest.approx(0.5 * weight * centre(found)[-1, 0], rel=1e-3)
    assert abs(float(found.attrs["energy_residual"])) < 1e-3


def test_the_shortcomings_of_a_file_are_named(make_structure):
    with pytest.raises(InputError, match=r"external_forces\.0\.body: expected a body that is not driven"):
        make_structure([], external_forces=[{"body": "slab"}])
    with pytest.raises(InputError, match=r"external_forces\.0\.body: expected a body of this structure"):
        make_structure([], external_forces=[{"body": "ghost"}])
