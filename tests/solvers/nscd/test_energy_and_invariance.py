import numpy as np
import pytest

from blockshake.dynamics.motion import ground_motion
from blockshake.geometry.structure import build_structure, load_structure
from blockshake.solvers.nscd.driver import simulate_nscd
from blockshake.solvers.nscd.parameters import NscdParameters

G = 9.81
SHAPES = {"cube": {"box": [0.5, 0.5, 0.5]}, "block": {"box": [0.8, 2.4, 1.6], "chamfer": 0.02}}


@pytest.fixture(scope="module")
def shaking():
    time = np.linspace(0.0, 4.0, 801)
    return ground_motion("sine", time, {"x": 2.5 * np.sin(2.0 * np.pi * 1.5 * time)}, "acceleration")


@pytest.fixture(scope="module")
def rocking_stack(shaking):
    return simulate_nscd(
        load_structure("configuration-1"), shaking, NscdParameters(), np.linspace(0.0, 1.5, 301)
    )


def balance(run):
    kinetic, potential, elastic, friction, contact, viscous, given = run.energy.T
    return kinetic + potential + elastic + friction + contact + viscous - given


def test_energy_adds_up_for_sliding_blocks(scene, simulate):
    # translation: the work of an impulse with the mean velocity is an identity of the scheme
    body = {"name": "b", "shape": "cube", "position": [0, 0, 0.25], "velocity": [2.0, 1.0, 0.0]}
    run = simulate(scene(SHAPES, [body], friction=0.1, gravity=[0.5, 0.0, -G]), 1.0)
    in_play = run.energy[0, 0]
    assert np.abs(balance(run) - balance(run)[0]).max() < 1e-8 * in_play
    assert run.numerics["energy_residual"] < 1e-8


def test_energy_adds_up_in_rocking(rocking_stack):
    assert np.ptp(rocking_stack.position[:, 3, 2]) > 5e-3
    # what is left is net work of normal impulses that turns back for a moment, of second order in the step
    assert rocking_stack.numerics["energy_residual"] < 1e-5
    in_play = rocking_stack.energy[:, 0].max()
    assert np.abs(balance(rocking_stack) - balance(rocking_stack)[0]).max() < 1e-4 * in_play


def test_dissipated_terms_grow(rocking_stack):
    dissipated = rocking_stack.energy[:, 3:6]
    assert dissipated.min() >= 0.0
    assert np.diff(dissipated, axis=0).min() >= 0.0
    assert dissipated[-1, 1] > 1.0


def test_steps_converge(rocking_stack):
    numerics = rocking_stack.numerics
    assert rocking_stack.status == "completed"
    assert numerics["capped_steps"] == 0
    assert numerics["max_residual"] <= NscdParameters().tolerance
    assert numerics["max_penetration"] < 1e-6


def test_order_of_bodies_does_not_matter(rocking_stack, shaking):
    file = load_structure("configuration-1").file.model_dump()
    order = [2, 0, 3, 1]
    file["bodies"] = [file["bodies"][body] for body in order]
    shapes = {"slab": {"box": [3.0, 3.0, 0.2]}, "block": {"box": [0.8, 2.4, 1.6], "chamfer": 0.02}}
    structure = build_structure({**file, "shapes": shapes}, "permuted", ".")
    run = simulate_nscd(structure, shaking, NscdParameters(), np.linspace(0.0, 1.5, 301))
    size = np.abs(rocking_stack.position[:, :, 0]).max()
    difference = np.abs(run.position - rocking_stack.position[:, order]).max()
    assert difference < 10.0 * NscdParameters().tolerance * size
    assert sorted(map(tuple, run.joints)) == sorted(
        (order.index(a), order.index(b)) for a, b in rocking_stack.joints
    )


def test_record_times_need_not_be_uniform(rocking_stack, shaking):
    times = np.array([0.0, 0.00037, 0.1, 0.10005, 0.5, 1.5])
    run = simulate_nscd(load_structure("configuration-1"), shaking, NscdParameters(), times)
    same = np.searchsorted(rocking_stack.time, [0.1, 0.5, 1.5])
    np.testing.assert_allclose(run.position[[2, 4, 5]], rocking_stack.position[same], atol=1e-12)
    np.testing.assert_allclose(np.linalg.norm(run.orientation, axis=2), 1.0, atol=1e-14)
    assert np.isfinite(run.joint_force).all()


def test_start_alone_can_be_asked_for():
    structure = load_structure("configuration-1")
    run = simulate_nscd(structure, None, NscdParameters(), np.array([0.0]))
    np.testing.assert_array_equal(run.position[0], structure.position)
    assert run.joint_force.shape == (1, 0, 3)
    assert np.isfinite(run.energy).all()


def test_too_few_iterations_are_told(shaking):
    run = simulate_nscd(
        load_structure("configuration-1"),
        shaking,
        # one leaves 11 % of the steps above 1e-4
        NscdParameters(max_iterations=1),
        np.linspace(0.0, 0.6, 16),
    )
    assert run.numerics["fraction_unconverged"] > 0.01
    assert run.numerics["capped_steps"] > 0
    assert run.status == "not-converged"
    assert "relative residual" in run.reason


def test_runaway_is_told(scene, simulate):
    body = {"name": "b", "shape": "cube", "position": [0, 0, 3.0], "velocity": [0, 0, 2e3]}
    run = simulate(scene(SHAPES, [body]), 0.1)
    assert run.status == "diverged"
    assert "b " in run.reason
    assert np.isnan(run.position[-1]).all()


@pytest.mark.parametrize("parameters", [{"theta": 1.0}, {"shrink": 0.05}])
def test_a_stack_rests_with_other_parameters(parameters, simulate):
    run = simulate(load_structure("configuration-3"), 0.2, **parameters)
    # a resting block moves only while the solver settles, by the tolerance times g dt^2
    assert np.abs(run.position - run.position[0]).max() < 1e-8
