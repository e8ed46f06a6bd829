"""Static equilibrium of stacks on their springs by Newton's method, and the largest time step that these allow."""

import numpy as np
from scipy.sparse import block_diag, coo_array, eye_array
from scipy.sparse.csgraph import connected_components
from scipy.sparse.linalg import eigsh, splu

from blockshake.geometry.rotations import rotate_into, rotation_matrices
from blockshake.geometry.vectors import add_impulse_into, difference, dot, matrix_product
from blockshake.jit import inner_kernel, kernel
from blockshake.solvers.ls_dem.contact.candidates import (
    empty_candidates,
    find_candidates,
    locate_pair_into,
    nearest_node,
    span_of,
)
from blockshake.solvers.ls_dem.contact.contact_forces import forces_into, no_loads
from blockshake.solvers.ls_dem.contact.packets import (
    AREA,
    DAMPING_WEIGHT,
    FACTOR,
    LANES,
    NORMAL,
    PHI,
    PLACE,
    triple,
)
from blockshake.solvers.ls_dem.contact.relative_pose import poses_at_rest
from blockshake.solvers.ls_dem.interfaces import dashpot_coefficient, in_series, normal_stiffness

_MOST_ITERATIONS = 20
_AT_REST = 1e-9  # out-of-balance force over weight; the thump it leaves is as small
_SEATED = 1e-5  # m; nodes of a hollow joint that are open by so much more than its nearest stay open
_SOFT = (
    1e-9  # of the stiffest entry; weak ground spring; an unsupported body then moves far, which reveals it
)


def approach_equilibrium(assembly, state, near, joints):
    """Poses at which stacks rest under gravity on the springs between them, near the given poses.

    Parameters
    ----------
    assembly : Assembly
    state : State
        Given poses; not changed.
    near : float
        Joints open by less than this are taken to close, and a stack with a body that moves farther
        has no equilibrium near [m].
    joints : NearPairs
        Shifts of the pairs; forces and slips are overwritten.

    Returns
    -------
    position, orientation : float64 arrays, shape (n_bodies, 3) and (n_bodies, 4)
        As given where no equilibrium is near.
    at_rest : float64 array, shape (n_bodies,)
        Out-of-balance force below which a body is at rest: a billionth of its weight, or what the rounding of
        its position makes of its springs [N].
    leaving : bool array, shape (n_bodies,)
        Free bodies of stacks that would move farther even with their joints bonded: they have no equilibrium near.
    stable_step : float
        Largest stable time step of the joints in touch, see `stable_time_step` [s].

    Notes
    -----
    Newton's method on the forces of `forces_into`, whose stiffness is the springs of the nodes in
    touch. At the first iteration all nodes within ``near`` count, those of an open joint across which gravity acts
    pulling it close; of hollow faces only the nodes at the rim. Where joints open or slide it may not converge, and
    relaxation has more to do. Bodies without inverse inertia do not turn.
    """
    bodies, surfaces, interfaces = assembly.bodies, assembly.surfaces, assembly.interfaces
    n_bodies = len(bodies.mass)
    position, orientation = state.position.copy(), state.orientation.copy()
    rotation = np.ascontiguousarray(rotation_matrices(orientation))
    poses = poses_at_rest(position, rotation)
    candidates, joints = find_candidates(
        surfaces, bodies.driven, poses, orientation, assembly.skin, empty_candidates(n_bodies), joints
    )
    loads = no_loads(n_bodies, joints)
    radius = surfaces.radius
    at_rest = _AT_REST * bodies.mass * np.linalg.norm(bodies.gravity) + 1e-300
    moves, solved, leaving = ways_to_move(bodies), ~bodies.driven, np.zeros(n_bodies, dtype=bool)
    for iteration in range(_MOST_ITERATIONS):
        forces_into(bodies, candidates, surfaces, interfaces, poses, 0.0, loads)
        poses.position_before[:] = position
        poses.rotation_before[:] = rotation
        reach = near if iteration == 0 else 0.0
        stiffness, pull, touching, relaxation = joint_stiffness(
            candidates, interfaces, surfaces, poses, reach, downwards(bodies)
        )
        if iteration == 0:
            stable_step = stable_time_step(candidates.pairs, stiffness, relaxation, bodies)
            at_rest = np.maximum(at_rest, _rounding(candidates.pairs, stiffness, position))
            group = _groups(candidates.pairs[touching], bodies.driven)
        load = np.where(moves, np.concatenate([loads.force, loads.moment], axis=1) + pull, 0.0)
        limit = np.where(np.arange(6) < 3, 1.0, radius[:, None]) * at_rest[:, None]
        if not solved.any() or (np.abs(load) < limit)[solved].all():
            break
        move = displacements(candidates.pairs, stiffness, solved[:, None] & moves, load)[solved]
        for body, (shift, turn) in zip(np.flatnonzero(solved), move, strict=True):
            position[body] += shift
            rotate_into(orientation[body], turn, orientation[body])
        # what nothing holds goes anywhere; not (x <= limit), so that NaN counts
        with np.errstate(over="ignore", invalid="ignore"):
            moved = np.linalg.norm(position - state.position, axis=1)
            cosine = np.abs((orientation * state.orientation).sum(axis=1))
            moved += 2.0 * radius * np.sqrt(np.maximum(1.0 - cosine**2, 0.0))
            lost = np.isin(group, group[solved & ~(moved <= near)])
        position[lost], orientation[lost] = state.position[lost], state.orientation[lost]
        solved &= ~lost
        if iteration == 0:
            leaving = lost & ~bodies.driven
        rotation[:] = rotation_matrices(orientation)
    return position, orientation, at_rest, leaving, stable_step


def _rounding(pairs, stiffness, position):
    """Force that the last bit of the positions makes of the springs on each body [N]."""
    stiffest = stiffness[:, np.arange(3), np.arange(3)].max(axis=1, initial=0.0)
    on_body = np.bincount(pairs.ravel(), np.repeat(stiffest, 2), minlength=len(position))
    return np.spacing(np.abs(position).max()) * on_body


def _groups(pairs, driven):
    """Number of the group of touching bodies that each belongs to, driven ones left out: int array (n_bodies,)."""
    free = pairs[~driven[pairs].any(axis=1)]
    links = coo_array((np.ones(len(free)), free.T), shape=(len(driven), len(driven)))
    return connected_components(links, directed=False)[1]


def ways_to_move(bodies):
    """Which displacements and rotations bodies can make: bool array, shape (n_bodies, 6)."""
    turns = bodies.inverse_inertia.any(axis=(1, 2))
    return ~bodies.driven[:, None] & (turns[:, None] | (np.arange(6) < 3))


def downwards(bodies):
    """Direction of gravity: float64 array, shape (3,), zero without any."""
    return bodies.gravity / max(np.linalg.norm(bodies.gravity), 1e-300)


def displacements(pairs, stiffness, solved, load):
    """Displacements and rotations under these loads, zero where not solved for: (n_bodies, 2, 3) [m, rad]."""
    chosen = np.flatnonzero(solved)
    matrix = assembled(pairs, stiffness, solved.size)[chosen][:, chosen]
    soft = _SOFT * abs(matrix).max() + 1e-300
    move = np.zeros(solved.size)
    move[chosen] = splu((matrix + soft * eye_array(len(chosen))).tocsc()).solve(load.ravel()[chosen])
    return move.reshape(-1, 2, 3)


@kernel
def joint_stiffness(candidates, interfaces, surfaces, poses, reach, down):
    """Stiffness of each pair for the displacements and rotations of its two bodies, and the pull of open nodes.

    Parameters
    ----------
    candidates, interfaces, surfaces, poses : Candidates, Interfaces, Surfaces, Poses
        The nodes are located anew; poses of the last force evaluation.
    reach : float
        Nodes whose level-set value is below this are in touch [m], but those in the hollow of a face.
    down : float64 array, shape (3,)
        Direction of gravity; zero without any.

    Returns
    -------
    stiffness : float64 array, shape (n_pairs, 12, 12)
        World frame, about the mass centres [N/m, N, N m].
    pull : float64 array, shape (n_bodies, 6)
        Force and moment that nodes in touch but not inside would have if springs could pull [N, N m], where the
        normal lies within 60 degrees of gravity: what the weight cannot close stays open.
    touching, relaxation : bool and float64 arrays, shape (n_pairs,)
        Whether a pair has a node in touch; coefficient of its dashpots over the stiffness of its springs [s].
    """
    n_pairs = candidates.pairs.shape[0]
    stiffness, pull = np.zeros((n_pairs, 12, 12)), np.zeros((poses.position.shape[0], 6))
    touching, relaxation = np.zeros(n_pairs, np.bool_), np.zeros(n_pairs)
    B, DB = np.zeros((3, 12)), np.empty((3, 12))
    turn, shift = np.empty((3, 3)), np.empty((2, 3))
    for pair in range(n_pairs):
        locate_pair_into(candidates, surfaces, poses, pair, turn, shift)
        a, b = candidates.pairs[pair, 0], candidates.pairs[pair, 1]
        k_n, k_s = normal_stiffness(interfaces, a, b), in_series(interfaces.k_s, a, b)
        area, weight, closed = 0.0, 0.0, reach
        if surfaces.hollow[surfaces.shape[a]] > 0.0 or surfaces.hollow[surfaces.shape[b]] > 0.0:
            closed = min(reach, max(0.0, nearest_node(candidates, pair)[0] + _SEATED))
        for side in range(2):
            owner, other = candidates.pairs[pair, side], candidates.pairs[pair, 1 - side]
            R = poses.rotation[other]
            span = span_of(candidates, pair, side)
            for packet in range(span.first, span.last):
                node = candidates.packets.alike[packet - span.first + span.alike]
                located, at_row = candidates.packets.located, packet - span.start
                for lane in range(LANES):
                    phi = located[at_row, PHI + lane]
                    if not phi < closed:
                        continue
                    n = matrix_product(R, triple(located, at_row, NORMAL, lane))
                    place = triple(located, at_row, PLACE, lane)
                    arm = matrix_product(R, difference(place, surfaces.offset[other]))
                    if phi >= 0.0 and abs(dot(n, down)) < 0.5:
                        continue
                    touching[pair] = True
                    factor = candidates.packets.kept[packet, FACTOR + lane]
                    half_area = 0.5 * (factor * node[AREA + lane])
                    area += half_area
                    weight += factor * node[DAMPING_WEIGHT + lane]
                    at = poses.position[other]
                    point = at[0] + arm[0], at[1] + arm[1], at[2] + arm[2]
                    _relative_motion_into(
                        difference(point, poses.position[a]), difference(point, poses.position[b]), B
                    )
                    for column in range(12):
                        along = dot(n, B[:, column])
                        for i in range(3):
                            DB[i, column] = half_area * (k_s * B[i, column] + (k_n - k_s) * along * n[i])
                    for row in range(12):
                        for column in range(12):
                            for i in range(3):
                                stiffness[pair, row, column] += B[i, row] * DB[i, column]
                    if phi >= 0.0:
                        size = -half_area * k_n * phi
                        force = size * n[0], size * n[1], size * n[2]
                        add_impulse_into(1.0, force, difference(point, poses.position[owner]), pull[owner])
                        add_impulse_into(-1.0, force, arm, pull[other])
        if area > 0.0:
            gamma = dashpot_coefficient(interfaces, a, b, interfaces.damping_ratio, k_n, area)
            relaxation[pair] = gamma * weight / (k_n * area)
    return stiffness, pull, touching, relaxation


@inner_kernel
def _relative_motion_into(arm_a, arm_b, B):
    """Motion of a point of body a against body b as a linear map of the displacements and rotations of both."""
    for i in range(3):
        B[i, i], B[i, 6 + i] = 1.0, -1.0
    # rotation x arm
    B[0, 4], B[0, 5], B[1, 3] = arm_a[2], -arm_a[1], -arm_a[2]
    B[1, 5], B[2, 3], B[2, 4] = arm_a[0], arm_a[1], -arm_a[0]
    B[0, 10], B[0, 11], B[1, 9] = -arm_b[2], arm_b[1], arm_b[2]
    B[1, 11], B[2, 9], B[2, 10] = -arm_b[0], -arm_b[1], arm_b[0]


def assembled(pairs, stiffness, size):
    """Sparse matrix (size, size) of the 12 x 12 blocks of pairs of bodies."""
    entries = (6 * pairs[:, :, None] + np.arange(6)).reshape(-1, 12)
    row = np.repeat(entries, 12, axis=1).ravel()
    column = np.tile(entries, (1, 12)).ravel()
    return coo_array((stiffness.ravel(), (row, column)), shape=(size, size)).tocsr()


def stable_time_step(pairs, stiffness, relaxation, bodies):
    """Largest stable time step of the joints at the start [s]; infinite where nothing holds a body.

    ``pairs`` int64 (n_pairs, 2); ``stiffness`` (n_pairs, 12, 12): of the pairs' springs, as `joint_stiffness` gives
    them; ``relaxation`` (n_pairs,): of the dashpots with them [s].

    Notes
    -----
    With the fastest mode's angular frequency w and fraction of critical damping z, leapfrog whose dashpots see
    ``3/2 v(n-1/2) - 1/2 v(n-3/2)`` is stable while ``w dt <= 2 (sqrt(1 + 4 z^2) - 2 z)``: there the root of its
    characteristic polynomial reaches -1. Joints that close later may allow less.
    """
    free = np.flatnonzero(~bodies.driven)
    chosen = (6 * free[:, None] + np.arange(6)).ravel()
    K, C = (
        assembled(pairs, part, 6 * len(bodies.mass))[chosen][:, chosen]
        for part in (stiffness, stiffness * relaxation[:, None, None])
    )
    if len(free) == 0 or abs(K).max() == 0.0:
        return np.inf
    M = block_diag(
        [block for body in free for block in (bodies.mass[body] * np.eye(3), bodies.inertia[body])],
        format="csc",
    )
    # any vector that no mode is orthogonal to, always the same
    start = np.cos(np.arange(1, len(chosen) + 1))
    value, vector = eigsh(K, k=1, M=M, which="LM", v0=start, tol=1e-3, rng=0)
    frequency, mode = np.sqrt(value[0]), vector[:, 0]
    ratio = mode @ (C @ mode) / (2.0 * frequency * (mode @ (M @ mode)))
    return float(2.0 * (np.sqrt(1.0 + 4.0 * ratio**2) - 2.0 * ratio) / frequency)
