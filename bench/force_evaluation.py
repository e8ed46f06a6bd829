"""Time of one evaluation of all contact forces of a stack at rest, by node and by pair."""

import numpy as np
from measuring import process_seconds, spread

from blockshake.geometry.rotations import rotation_matrices
from blockshake.geometry.structure import load_structure
from blockshake.jit import loop_kernel
from blockshake.solvers.ls_dem.contact.candidates import empty_candidates, find_candidates
from blockshake.solvers.ls_dem.contact.contact_forces import contact_forces_into, no_loads
from blockshake.solvers.ls_dem.contact.relative_pose import poses_at_rest
from blockshake.solvers.ls_dem.driver import simulate_ls_dem
from blockshake.solvers.ls_dem.interfaces import assemble_interfaces
from blockshake.solvers.ls_dem.parameters import LsDemParameters
from blockshake.solvers.ls_dem.progress import no_joints
from blockshake.solvers.ls_dem.surfaces import assemble_surfaces

STRUCTURE = "configuration-1"
TIME_STEP = 1e-5  # s
SPACINGS = (0.4, 0.3, 0.2, 0.15)  # m, for the line through cost over nodes
MEASURED_SPACING = 0.2  # m, the study's
EVALUATIONS = 40_000
# level sets and what selects them among the parameters of LS-DEM
LEVEL_SETS = {"exact distance": {}, "grid": {"level_set": "grid"}}
TARGET_NS = {"exact distance": 6.0, "grid": 15.0}


@loop_kernel
def _evaluate(times, candidates, surfaces, interfaces, poses, dt, loads):
    for _ in range(times):
        contact_forces_into(candidates, surfaces, interfaces, poses, dt, loads)


def assembled_stack(parameters):
    """Arguments of `contact_forces_into` for the settled stack, at rest."""
    structure = load_structure(STRUCTURE)
    start = simulate_ls_dem(structure, None, parameters, np.array([0.0, TIME_STEP]), TIME_STEP)
    position, orientation = start.position[0], start.orientation[0]
    surfaces = assemble_surfaces(structure, parameters)
    n_bodies = len(structure.mass)
    rotation = np.ascontiguousarray(rotation_matrices(orientation))
    poses = poses_at_rest(position, rotation)
    candidates, joints = find_candidates(
        surfaces, structure.driven, poses, orientation, parameters.skin, empty_candidates(n_bodies),
        no_joints(),
    )  # fmt: skip
    interfaces = assemble_interfaces(structure, parameters)
    return candidates, surfaces, interfaces, poses, TIME_STEP, no_loads(n_bodies, joints)


def measure_force_evaluation(repeats, evaluations=EVALUATIONS):
    """Cost of a node evaluation for each level set.

    Returns
    -------
    dict of str to dict
        ``ns_per_node``: median and quartiles at the study's spacing, all that an evaluation does
        spread over the listed nodes [ns]; ``ns_per_node_alone`` and ``ns_per_pair``: slope over
        the listed nodes and rest by pair, from a fit over four spacings [ns].
    """
    return {name: _measure_level_set(chosen, repeats, evaluations) for name, chosen in LEVEL_SETS.items()}


def _measure_level_set(chosen, repeats, evaluations):
    stacks = {
        spacing: assembled_stack(LsDemParameters(node_spacing=spacing, **chosen)) for spacing in SPACINGS
    }
    n_nodes = {spacing: int((stack[0].node >= 0).sum()) for spacing, stack in stacks.items()}
    _evaluate(1, *stacks[MEASURED_SPACING])
    nanoseconds = {spacing: [] for spacing in SPACINGS}
    # in turn, so that what else the machine does falls on all alike
    for _ in range(repeats):
        for spacing, stack in stacks.items():
            seconds = process_seconds(_evaluate, evaluations, *stack)
            nanoseconds[spacing].append(1e9 * seconds / evaluations)
    slope, rest = np.polyfit(list(n_nodes.values()), [np.median(n) for n in nanoseconds.values()], 1)
    nodes, n_pairs = n_nodes[MEASURED_SPACING], len(stacks[MEASURED_SPACING][0].pairs)
    return {
        "nodes": nodes,
        "pairs": n_pairs,
        "ns_per_node": spread(np.array(nanoseconds[MEASURED_SPACING]) / nodes),
        "ns_per_node_alone": float(slope),
        "ns_per_pair": float(rest / n_pairs),
    }
