"""Bodies that overlap as they were laid: contact sees them apart, pressed together by what they carry and no more."""

import numpy as np

from blockshake.errors import InputError
from blockshake.geometry.rotations import rotation_matrices
from blockshake.geometry.structure import DEEPEST_OVERLAP, START_TOLERANCE
from blockshake.jit import kernel
from blockshake.solvers.ls_dem.contact.candidates import (
    empty_candidates,
    find_candidates,
    locate_pair_into,
    nearest_node,
)
from blockshake.solvers.ls_dem.contact.packets import LANES, NORMAL
from blockshake.solvers.ls_dem.contact.relative_pose import poses_at_rest
from blockshake.solvers.ls_dem.progress import no_joints
from blockshake.solvers.ls_dem.start.equilibrium import (
    displacements,
    downwards,
    joint_stiffness,
    ways_to_move,
)

_MOST_PARTINGS = 20  # of a pair: one, but where it meets at several faces
_ROUNDING = 1e-12  # m
_TYPED = 2e-9  # m, of typed places: what a structure file may have is never refused here


def joints_as_laid(structure, assembly, state, settled):
    """Joints whose shifts leave no overlap but the elastic one of the weight that the joint carries.

    Parameters
    ----------
    structure, assembly : Structure, Assembly
    state : State
        As given.
    settled : bool array, shape (n_bodies,)
        Free bodies with an equilibrium near without any shift. A pair of them has a shift only where it overlaps by
        0.1 mm more than its weight presses it: between two walls, say, that do not give way.

    Returns
    -------
    joints : NearPairs
    overlap : float
        Deepest that was taken up, zero where no joint has a shift [m].

    Raises
    ------
    InputError
        Bodies that start inside one another: deeper than a structure may, or so that no shift parts them.

    Notes
    -----
    A pair is parted along the normal at its deepest node until no node is inside. The elastic penetration comes from
    one solution of the bonded joints under gravity: the normal force of a joint over its stiffness.
    """
    bodies, surfaces = assembly.bodies, assembly.surfaces
    rotation = np.ascontiguousarray(rotation_matrices(state.orientation))
    poses = poses_at_rest(state.position, rotation)
    none = empty_candidates(len(bodies.mass))
    candidates, joints = find_candidates(
        surfaces, bodies.driven, poses, state.orientation, assembly.skin, none, no_joints()
    )
    pairs, shift = candidates.pairs, candidates.shift
    depth, rest = _part_into(candidates, surfaces, poses)
    unsettled = (~bodies.driven & ~settled)[pairs].any(axis=1) & (depth > _ROUNDING)
    if not (unsettled | (depth > START_TOLERANCE)).any():
        return joints, 0.0
    stiffness, pull, _, _ = joint_stiffness(
        candidates, assembly.interfaces, surfaces, poses, START_TOLERANCE, downwards(bodies)
    )
    load = pull + np.pad(bodies.mass[:, None] * bodies.gravity, ((0, 0), (0, 3)))
    moves = ways_to_move(bodies)
    move = displacements(pairs, stiffness, moves, np.where(moves, load, 0.0)).reshape(-1, 6)
    carried = np.einsum("pij,pj->pi", stiffness, move[pairs].reshape(-1, 12))[:, :3]
    apart = np.einsum("pij,pj->pi", rotation[pairs[:, 1]], shift)
    along = np.einsum("pi,pij,pj->p", apart, stiffness[:, :3, :3], apart)
    # elastic penetration over the overlap
    pressed = np.clip(-(apart * carried).sum(axis=1) / np.where(along > 0.0, along, np.inf), 0.0, 1.0)
    taken = unsettled | ((1.0 - pressed) * depth > START_TOLERANCE)
    depth, rest = np.where(taken, depth, 0.0), np.where(taken, rest, 0.0)
    _refuse_above(DEEPEST_OVERLAP + _TYPED, structure, pairs, depth, "")
    _refuse_above(START_TOLERANCE, structure, pairs, rest, " on sides that no shift parts")
    joints.shift[candidates.joint] = shift * np.where(taken, 1.0 - pressed, 0.0)[:, None]
    return joints, float(depth.max())


def _refuse_above(limit, structure, pairs, depth, where):
    """Refuse a pair that overlaps by more than the limit [m]."""
    if depth.max(initial=0.0) > limit:
        a, b = pairs[depth.argmax()]
        raise InputError(
            structure.source,
            f"bodies.{structure.body_names[b]}.position",
            f"overlaps {structure.body_names[a]} by {1e3 * depth.max():.3g} mm{where}; "
            f"expected at most {1e3 * limit:g} mm",
        )


@kernel
def _part_into(candidates, surfaces, poses):
    """Shift pairs of bodies apart until they just touch: the shifts of the candidates are overwritten.

    The depth of the deepest node of every pair before and after is returned, (n_pairs,) each, zero where none is
    inside [m].
    """
    n_pairs = candidates.pairs.shape[0]
    depth, rest = np.zeros(n_pairs), np.zeros(n_pairs)
    R, d = np.empty((3, 3)), np.empty((2, 3))
    for pair in range(n_pairs):
        for parting in range(_MOST_PARTINGS):
            locate_pair_into(candidates, surfaces, poses, pair, R, d)
            phi, row, lane = nearest_node(candidates, pair)
            rest[pair] = max(0.0, -phi)
            if parting == 0:
                depth[pair] = rest[pair]
            if rest[pair] <= _ROUNDING:
                break
            of_first = candidates.first[2 * pair] + row < candidates.first[2 * pair + 1]
            for i in range(3):
                n = candidates.packets.located[row, NORMAL + i * LANES + lane]
                if of_first:
                    candidates.shift[pair, i] += rest[pair] * n
                else:
                    for j in range(3):
                        candidates.shift[pair, j] -= rest[pair] * n * R[i, j]
    return depth, rest
