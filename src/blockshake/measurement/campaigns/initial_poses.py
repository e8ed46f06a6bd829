"""Where the blocks stand as a test begins: as surveyed, or as the markers' first places show them."""

import numpy as np
import xarray as xr
from scipy.spatial.transform import Rotation

from blockshake.errors import InputError
from blockshake.geometry.rotations import rotation_matrices
from blockshake.geometry.schema import AXES
from blockshake.measurement.motion.body_poses import fit_poses

# m and rad, within which blocks that are put back stand: nominal models scatter by a third of it
_PUT_BACK = 1e-3
# m, m, rad: markers are mounted by hand, and tell no less of their block
_BY_MARKERS = np.array([5e-3, 5e-3, 1e-2])
_MOUNTED = 2e-3  # m, root mean square about a rigid body: where one sits elsewhere, they tell nothing
_LEVER = 0.6  # m, root of the sum of squares about the vertical, with which they tell a turn of 10 mrad
_UPRIGHT = 5e-3  # m and rad, along z and about x and y


def with_initial_poses(test, structure, path):
    """A test with ``starting_place(block, place)``, where a block stands more than 1 mm or 1 mrad off the structure.

    Parameters
    ----------
    test : xarray.Dataset
        Perhaps with ``initial_offset``, ``initial_rotation`` and ``marker_initial_position`` as in a campaign's file.
    structure : Structure
        The campaign's.
    path : Path
        For messages.

    Returns
    -------
    xarray.Dataset
        ``starting_place``: of every block the offset of its centroid along x and y [m] and its turn about z [rad],
        against those of the slab.

    Raises
    ------
    InputError
        A survey that contradicts the markers' first places, or has a block higher or tilted; blocks that would no
        longer touch, or would overlap.

    Notes
    -----
    The survey counts; the markers' first places do for blocks that it does not hold, where three markers fit a rigid
    body within 2 mm and stand more than 5 mm or 10 mrad off. The bodies below say how high a block stands.
    """
    surveyed, seen = _surveyed(test, structure, path), _by_markers(test, structure)
    for body, axis in np.argwhere(np.abs(surveyed - seen) > _BY_MARKERS)[:1]:
        key = f"{'initial_rotation' if axis == 2 else 'initial_offset'}.{structure.body_names[body]}"
        apart = (
            f"{1e3 * abs(surveyed - seen)[body, axis]:.3g} {('mm along x', 'mm along y', 'mrad')[axis]} off"
        )
        raise InputError(path, key, f"expected the place of its marker_initial_position, which is {apart}")
    seen[~(np.abs(seen) > _BY_MARKERS).any(axis=1)] = 0.0
    places = np.nan_to_num(np.where(np.isfinite(surveyed), surveyed, seen))
    places[structure.driven] = 0.0
    if (np.abs(places) <= _PUT_BACK).all():
        return test
    test = test.assign(starting_place=(("block", "place"), places)).assign_coords(block=structure.body_names)
    try:
        touching = initial_poses(structure, test).touching
    except InputError as error:
        wrong = f"expected blocks that bear on each other; {error}"
        raise InputError(path, "initial_offset", wrong) from None
    for pair in np.argwhere(np.triu(touching != structure.touching))[:1]:
        lower, upper = (structure.body_names[body] for body in pair)
        wrong = f"expected the joints of the structure file; {lower} and {upper} touch in one of both alone"
        raise InputError(path, "initial_offset", wrong)
    return test


def initial_poses(structure, test):
    """The structure with its blocks where a test, or what was made of it, has them at the start; as it is without."""
    if "starting_place" not in test:
        return structure
    places = test["starting_place"].reindex(block=structure.body_names, fill_value=0.0)
    return structure.with_parameters(placed(structure, places.to_numpy()))


def placed(structure, places):
    """Start poses of the free bodies: ``bodies.NAME.position`` and ``bodies.NAME.orientation`` of the structure.

    ``places`` (n_bodies, 3): off the structure file, along x and y [m], turned about z [rad]. Driven bodies stay, and
    so do those behind the last place, which an effect has added.
    """
    poses = {}
    for body, (along_x, along_y, turn) in zip(structure.file.bodies, places, strict=False):
        if body.driven:
            continue
        x, y, z = body.position
        turned = Rotation.from_rotvec([0.0, 0.0, turn]) * Rotation.from_quat(
            body.orientation, scalar_first=True
        )
        poses[f"bodies.{body.name}.position"] = [x + float(along_x), y + float(along_y), z]
        poses[f"bodies.{body.name}.orientation"] = turned.as_quat(scalar_first=True).tolist()
    return poses


def initial_pose_lines(test):
    """The line that states which blocks of a test stand off the structure file; none of a test that starts there."""
    if "starting_place" not in test:
        return []
    places = zip(test["block"].values, test["starting_place"].to_numpy(), strict=True)
    off = [
        f"{name} {1e3 * np.hypot(x, y):.3g} mm and {1e3 * abs(turn):.3g} mrad"
        for name, (x, y, turn) in places
        if max(abs(x), abs(y), abs(turn)) > _PUT_BACK
    ]
    return [f"it is seen and simulated from where its blocks stood, off the structure file: {', '.join(off)}"]


def _surveyed(test, structure, path):
    """Places by the survey (n_bodies, 3), NaN where it holds none."""
    none = xr.DataArray(np.full((1, 3), np.nan), {"body": [""], "axis": list(AXES)})
    parts = [
        test.get(name, none).reindex(body=structure.body_names, axis=list(AXES)).transpose("body", "axis")
        for name in ("initial_offset", "initial_rotation")
    ]
    read = _against_slab(np.hstack(parts), structure)
    off = np.nan_to_num(np.abs(read[:, 2:5]))
    body, axis = np.unravel_index(off.argmax(), off.shape)
    if off[body, axis] > _UPRIGHT:
        key = f"{'initial_rotation' if axis else 'initial_offset'}.{structure.body_names[body]}"
        size = f"{1e3 * off[body, axis]:.3g} {('mm along z', 'mrad about x', 'mrad about y')[axis]}"
        wrong = f"expected a block as high and upright as in the structure file, not {size} off"
        raise InputError(path, key, wrong)
    return read[:, [0, 1, 5]]


def _by_markers(test, structure):
    """Places by the markers' first places (n_bodies, 3), NaN of bodies on which fewer than three agree."""
    places = np.full((len(structure.mass), 3), np.nan)
    if "marker_initial_position" not in test:
        return places
    names = [marker.name for marker in structure.file.markers]
    first = test["marker_initial_position"].reindex(marker=names, axis=list(AXES)).transpose("marker", "axis")
    first, arms = first.to_numpy(), structure.arms(structure.file.markers)
    for body, start in enumerate(rotation_matrices(structure.orientation)):
        mine = (structure.carriers(structure.file.markers) == body) & np.isfinite(first).all(axis=1)
        if not mine.any():
            continue
        (position,), (rotation,), _ = fit_poses(arms[mine], first[None, mine], 1.0)
        if np.sqrt(np.mean((position + arms[mine] @ rotation.T - first[mine]) ** 2)) < _MOUNTED:
            moved = position - rotation @ structure.mass_offset[body] - structure.centroid[body]
            lever = np.linalg.norm(((arms[mine] - arms[mine].mean(axis=0)) @ start.T)[:, :2])
            turn = Rotation.from_matrix(rotation @ start.T).as_rotvec()[2]
            places[body] = *moved[:2], turn if lever > _LEVER else np.nan
    return _against_slab(places, structure)


def _against_slab(read, structure):
    """Readings of the bodies, less those of the first driven one, where there are any."""
    return read - np.nan_to_num(read[np.flatnonzero(structure.driven)[:1]])
