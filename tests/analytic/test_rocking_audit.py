"""Where each joule of free rocking goes: the audit with C_res 1, and what friction does as contacts let go."""

import numpy as np
import pytest
from both_solvers import leans
from rocking_theory import Rocker

from blockshake.dynamics.motion import ground_motion

G = 9.81
STEP = 1e-5  # s, the default
AUDIT = 1e-4  # of the energy in play, issue's target
INSET = 0.004  # m; leaning by half of alpha the edge of the flat is then 0.9 mm under the base
KINETIC, POTENTIAL, ELASTIC, FRICTION, CONTACT, VISCOUS, INPUT = range(7)


def _leaning_stack(make_structure, n, **keys):
    """n blocks as one, let go at half of the lean at which they would fall."""
    pivot = 0.4 - 0.02 - INSET
    angle = 0.5 * np.arctan(pivot / (0.8 * n))
    c, s = np.cos(angle), np.sin(angle)
    bodies = []
    for i in range(n):
        z = 0.8 + 1.6 * i
        bodies.append(
            {
                "name": f"b{i}", "shape": "block", "orientation": [np.cos(angle / 2), 0.0, np.sin(angle / 2), 0.0],
                "position": [pivot - pivot * c + z * s, 0.0, pivot * s + z * c],
            }
        )  # fmt: skip
    return make_structure(bodies, **keys)


def _gained(run):
    return run.energy - run.energy[0]


def _residual(run):
    e = _gained(run)
    return e[:, :3].sum(axis=1) + e[:, 3:6].sum(axis=1) - e[:, INPUT]


@pytest.mark.parametrize("n", [1, 3])
def test_the_audit_of_an_undamped_stack_closes(n, make_structure, run_ls_dem):
    """3 s from half of alpha, C_res 1, mu 0.75: every joule that leaves the rocking is friction heat."""
    structure = _leaning_stack(make_structure, n, friction=0.75, restitution=1.0)
    run = run_ls_dem(structure, 3.0, time_step=STEP, perimeter_inset=INSET / 0.76)
    assert run.status == "completed"
    e = _gained(run)
    in_play = -e[:, POTENTIAL].min()
    assert in_play > 4000.0
    assert np.abs(_residual(run)).max() < AUDIT * in_play
    # no dashpot: the contact term holds what shear springs lose where a normal turns, near to nothing
    assert np.abs(e[:, CONTACT]).max() < 1e-3 * e[-1, FRICTION]
    assert (e[:, [VISCOUS, INPUT]] == 0.0).all()
    assert e[-1, FRICTION] > 0.01 * in_play
    # heat only grows
    assert np.diff(e[:, FRICTION]).min() >= 0.0


def test_without_friction_nothing_is_lost(make_structure, run_ls_dem):
    """C_res 1 and mu 0: after 3 s of bouncing kinetic, potential and elastic energy still add up."""
    structure = make_structure([Rocker(0.0024).body(0.1)], friction=0.0, restitution=1.0)
    run = run_ls_dem(structure, 3.0, time_step=STEP)
    e = _gained(run)
    in_play = -e[:, POTENTIAL].min()
    assert in_play > 2000.0
    assert (e[:, 3:] == 0.0).all()
    assert np.abs(_residual(run)).max() < AUDIT * in_play


def test_the_heat_of_an_impact_is_the_laws_and_not_the_schemes(make_structure, run_ls_dem):
    """Friction heat at the first turn: 445 J of 2,563, the same from 5e-5 to 5e-6 s to a part in 200.

    Coulomb's heat, at nodes that let go while their shear springs are stretched; the scheme's own error is
    the residual, 600 times less at 5e-5 s and falling with the step.
    """
    heat, residual = [], []
    for step in (5e-5, 1e-5, 5e-6):
        structure = make_structure([Rocker(0.0024).body(0.1)], friction=0.9, restitution=1.0)
        run = run_ls_dem(structure, 0.5, time_step=step, rate=1000)
        heat.append(run.energy[leans(run).argmin(), FRICTION])
        residual.append(np.abs(_residual(run)).max())
    assert min(heat) > 400.0
    assert np.ptp(heat) < 0.005 * heat[-1]
    assert residual[0] < 0.005 * heat[0]
    # a factor of ten in the step; kinks leave the order to the phase of the step, at least 1.5 is seen
    assert residual[2] < residual[0] / 10.0**1.5


@pytest.mark.parametrize("speed", [0.05, 5.0])
def test_a_stretched_shear_spring_ends_as_friction_heat(speed, make_structure, run_ls_dem):
    """Unloaded at a fixed stretch, the limit mu F_n falls through the shear force T: heat T^2 / (2 k_s A).

    A cube held on an incline by its shear springs, and the slab drops away from under it: in 10 steps or
    within one. Coulomb's law has no other end for that energy, since a massless spring cannot ring.
    """
    slope = 0.2
    angle = np.arctan(slope)
    gravity = [G * np.sin(angle), 0.0, -G * np.cos(angle)]
    structure = make_structure(
        [{"name": "b", "shape": "squat", "position": [0.0, 0.0, 0.1]}],
        friction=0.75, restitution=1.0, gravity=gravity,
        shapes={"squat": {"box": [1.0, 1.0, 0.2]}, "slab": {"box": [1.0, 1.0, 0.2]}},
    )  # fmt: skip
    motion = ground_motion("away", np.array([0.0, 1.0]), {"z": np.array([-speed, -speed])}, "velocity")
    step = 1e-6
    run = run_ls_dem(structure, 1e-3, motion=motion, time_step=step, rate=10_000)
    assert np.abs(run.joint_force[-1]).max() == 0.0
    tangential = structure.mass[1] * G * np.sin(angle)
    stored = tangential**2 / (2.0 * 9.0e9)
    # meanwhile the spring pulls the block back: it swings by omega t, where the depth m g / k_n leaves at
    # the given speed, and by a step at the least
    depth = structure.mass[1] * G / 2.16e10
    swing = np.sqrt(9.0e9 / structure.mass[1]) * max(depth / speed, step)
    assert swing < 0.05
    assert run.energy[-1, FRICTION] == pytest.approx(stored, rel=2.0 * swing)
