"""A compliant base turns by its moment, in both solvers."""

import numpy as np
import pytest

from blockshake.dynamics.motion import ground_motion
from blockshake.effects.base_compliance import EFFECT
from blockshake.effects.effect import Experiment
from blockshake.effects.registry import with_effect
from blockshake.geometry.structure import DEEPEST_OVERLAP, load_structure
from blockshake.measurement.sensors.instruments import Instruments
from blockshake.simulation.simulate import simulate

COMPLIANCE = 2e-9  # rad/(N m)
PUSH, HEIGHT = 2000.0, 1.5  # N, and m above the bed
REST = ground_motion("rest", np.array([0.0, 3.0]), {"x": np.zeros(2)}, "displacement", {"source": "test"})


# LS-DEM's nodes on the wider slab do not end where the bed does: a joint's stiffness has this spread with its lattice
@pytest.mark.parametrize(
    ("model", "time_step", "within"), [("ls-dem", 5e-5, 0.1), ("nscd-rigid", 1e-3, 1e-3)]
)
def test_a_static_push_turns_the_base_by_its_moment(model, time_step, within, make_structure):
    """Winkler's bed: phi = c M, M the push about the bed; the weight that leans with it adds less than 1 %."""
    cube = {"name": "cube", "shape": "cube", "position": [0.0, 0.0, 0.5]}
    force = {"body": "cube", "position": [0.0, 0.0, HEIGHT - 0.7], "amplitude": PUSH}
    structure = make_structure([cube], external_forces=[force])
    experiment = with_effect(
        Experiment(structure, REST, Instruments()), "base-compliance", {"compliance": COMPLIANCE}, {}
    )
    assert experiment.structure.body_names == ["slab", "cube", "slab-bed"]
    run = simulate(experiment.structure, REST, model, time_step=time_step, duration=2.0, accelerometers=False)
    turn = 2.0 * run["orientation"].sel(body="slab", quaternion="y").to_numpy()
    # the push starts at once: the base swings, and comes to rest
    assert turn[-20:].mean() == pytest.approx(COMPLIANCE * PUSH * HEIGHT, rel=within)


@pytest.mark.parametrize("name", ["configuration-1", "configuration-3", "configuration-4"])
def test_the_softest_bed_of_a_heavy_wall_sinks_no_farther_than_a_structure_may_overlap(name):
    experiment = Experiment(load_structure(name), REST, Instruments())
    softest = EFFECT.parameters[0].upper
    structure = with_effect(experiment, "base-compliance", {"compliance": softest}, {}).structure
    slab, bed = structure.body_names[0], structure.body_names[-1]
    top, bottom = _level(structure, bed, np.max), _level(structure, slab, np.min)
    assert 0.0 < top - bottom < DEEPEST_OVERLAP


@pytest.mark.parametrize("spacing", [0.15, 0.2135, 0.25, 0.3])
def test_a_bed_that_sinks_as_far_as_it_may_starts_in_ls_dem(spacing):
    """Nodes of a lattice carry less than the layer: they sink farther."""
    experiment = Experiment(load_structure("configuration-3"), REST, Instruments())
    softest = EFFECT.parameters[0].upper
    structure = with_effect(experiment, "base-compliance", {"compliance": softest}, {}).structure
    numerics = {"ls_dem.node_spacing": spacing, "ls_dem.perimeter_inset": 0.006}
    run = simulate(structure, REST, "ls-dem", numerics, time_step=5e-5, duration=0.01)
    assert run.attrs["status"] == "completed"


def _level(structure, name, of):
    index = structure.body_names.index(name)
    vertices = structure.solids[structure.file.bodies[index].shape].vertices
    return structure.centroid[index, 2] + of(vertices[:, 2])
