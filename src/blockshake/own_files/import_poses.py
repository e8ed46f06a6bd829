"""Poses of bodies in an import: from the file's frame into x, y, z, and to the readings of the body's markers."""

from typing import NamedTuple

import numpy as np
import pandas as pd
from scipy.spatial.transform import Rotation

from blockshake.errors import InputError
from blockshake.geometry.rotations import rotation_matrices
from blockshake.geometry.schema import AXES
from blockshake.measurement.campaigns.recorded_test import FARTHEST_TURN
from blockshake.measurement.checks.joint_fit import UNLIKE, joint_fit, other_turns
from blockshake.measurement.motion.pose_columns import ANGLE, QUATERNION, free_body, poses_of_columns
from blockshake.own_files.import_columns import by_key, check_once, columns_of, rest_of
from blockshake.tables.units import UNITS, unit_size

_QUATERNIONS = ("body-to-world", "world-to-body")
_TURNS = tuple(f"q{part}" for part in QUATERNION)


class FilmedBody(NamedTuple):
    """Poses of a body from a test's table."""

    time: np.ndarray  # float64 (n_times,) [s]
    position: np.ndarray  # float64 (n_times, 3); centroid, in the file's origin [m]
    rotation: np.ndarray  # float64 (n_times, 3, 3); body to world
    remarks: list


def is_pose(key, structure):
    """Whether a key of the map's columns is a part of a body's pose."""
    name, _, part = key.rpartition(".")
    markers = {marker.name for marker in structure.file.markers}
    return name in structure.body_names and name not in markers and part in (*AXES, ANGLE, *_TURNS)


def filmed_body(source, body, posed, import_map, structure, where):
    """`FilmedBody` of a body of the structure, whose markers are to read what its pose gives.

    ``source``: table of the test, by its name; ``posed``: keys of the map's columns that are parts of poses; ``where``:
    file of the map, for messages. A body without markers in the structure is refused.
    """
    if not any(marker.body == body for marker in structure.file.markers):
        raise InputError(where, f"columns.{body}.x", f"expected markers of {body} in the structure")
    keys = [key for key in posed if key.startswith(f"{body}.")]
    time, columns, remarks = _pose_columns(source, body, keys, import_map, where)
    with by_key(import_map, where):
        position, rotation, _ = poses_of_columns(columns, source, body)
    return FilmedBody(time, position, rotation, remarks)


def markers_of_poses(filmed, source, body, import_map, structure, where):
    """Displacements (n_times, 3) [m] of all markers of a body, by name, from its `FilmedBody`.

    They count from the mean over ``rest`` of the map, else from the first known reading.
    """
    found = {}
    for marker in structure.file.markers:
        if marker.body != body:
            continue
        place = filmed.position + filmed.rotation @ np.array(marker.position)
        start = place[np.isfinite(place[:, 0]).argmax()]
        if import_map.rest:
            name, noise = f"{source}: {body}.x", import_map.sensors.marker_noise
            start = [rest_of(filmed.time, column, import_map, where, name, noise) for column in place.T]
        found[marker.name] = place - start
    return found


def check_poses(filmed, slab, import_map, structure, where):
    """Compare poses, `FilmedBody` by name, with the structure at the start, and rotations with places from then on.

    A block that rocks turns about its foot: with rotations of another unit, sign, order or conjugate its foot would
    slide. The setting that makes the feet stand is named in the refusal.

    ``slab`` (n_times, 3) is the displacement of the driven body by its markers, NaN where unknown [m]; a driven body
    without poses moves so, without a turn.

    Raises
    ------
    InputError
        A body that begins turned away from the structure's pose, or rotations by which feet slide where another reading
        of the same columns lets them stand.
    """
    for body, poses in filmed.items():
        _check_start(body, poses, import_map, structure, where)
    names, n_times = structure.body_names, len(next(iter(filmed.values())).time)
    position = np.full((n_times, len(names), 3), np.nan)
    rotation = np.full((n_times, len(names), 3, 3), np.nan)
    for body, name in enumerate(names):
        if name in filmed:
            position[:, body], rotation[:, body] = filmed[name].position, filmed[name].rotation
        elif structure.driven[body]:
            position[:, body], rotation[:, body] = slab, np.eye(3)
        across = np.isnan(position[:, body]).all(axis=0)
        position[:, body, across & (not across.all())] = 0.0
    fit = joint_fit(structure, position, rotation)
    free = [body for body, name in enumerate(names) if name in filmed and not structure.driven[body]]
    noise = import_map.sensors.marker_noise
    scale = _angle_unit(fit, free, import_map, names, noise)
    if scale:
        raise InputError(where, "rotation_unit", scale)
    turns = other_turns(fit, free, noise)
    if not turns:
        return
    body, turn = next(iter(turns.items()))
    name = names[body]
    slides = f"its foot would slide by {1e3 * fit.slip() ** 0.5:.2g} mm rms"
    wrong = f"{name} leans one way while its centroid goes another: {slides}"
    if f"{name}.{ANGLE}" in import_map.columns:
        raise InputError(
            where, f"columns.{name}.{ANGLE}", f"expected it {_other_sign(import_map, name)}; {wrong}"
        )
    if np.array_equal(turn, -np.eye(3)) and len(turns) == len(free):
        other = next(way for way in _QUATERNIONS if way != import_map.quaternion)
        raise InputError(where, "quaternion", f"expected {other}; {wrong}")
    size = np.nan_to_num(fit.turned[:, body] @ turn.T).std(axis=0)
    axis = int((size * (turn != np.eye(3)).any(axis=1)).argmax())  # that turns most, of those that differ
    source = int(np.abs(turn[axis]).argmax())
    entry = import_map.columns[f"{name}.q{AXES[source]}"]
    sign = (turn[axis, source] < 0.0) != entry.reversed
    likely = f"'{entry.column}'{' reversed' if sign else ''}"
    raise InputError(where, f"columns.{name}.q{AXES[axis]}", f"expected {likely}, by its motion; {wrong}")


def _other_sign(import_map, name):
    """Setting of a body's angle that reverses it."""
    return "not reversed" if import_map.columns[f"{name}.{ANGLE}"].reversed else "reversed"


def _angle_unit(fit, free, import_map, names, noise):
    """Expectation of another unit of angles, by which feet do not slide; None where the stated one fits."""
    angles = [body for body in free if f"{names[body]}.{ANGLE}" in import_map.columns]
    if not angles or not fit.worth_a_look(noise):
        return None
    mine, slips = unit_size("rotation", import_map.rotation_unit, "", ""), {}
    for unit, size in UNITS["rotation"].items():
        turned = fit.turned.copy()
        turned[:, angles] *= float(size / mine)
        slips[unit] = fit.slip(turned)
    unit = min(slips, key=slips.get)
    if slips[unit] > UNLIKE * fit.slip():
        return None
    return (
        f"expected {unit}, by which blocks turn about their feet; in {import_map.rotation_unit} these slide"
    )


def _check_start(body, poses, import_map, structure, where):
    """Refuse a body whose first pose is turned from the structure's by more than a survey may have."""
    start = rotation_matrices(structure.orientation[structure.body_names.index(body)])
    first = poses.rotation[np.isfinite(poses.rotation[:, 0, 0]).argmax()]
    if not np.isfinite(first).all():
        return
    angle = np.linalg.norm(Rotation.from_matrix(first @ start.T).as_rotvec())
    if angle <= FARTHEST_TURN:
        return
    wrong = f"expected it as in the structure; it begins turned by {np.rad2deg(angle):.3g} deg"
    key = f"columns.{body}.{ANGLE}"
    if key.removeprefix("columns.") not in import_map.columns:
        key = f"columns.{body}.qw"
        parts = np.abs(Rotation.from_matrix(first).as_quat(scalar_first=True))
        if parts.argmax() and parts.max() > np.cos(0.5 * FARTHEST_TURN) and np.allclose(start, np.eye(3)):
            scalar = import_map.columns[f"{body}.{_TURNS[int(parts.argmax())]}"].column
            wrong += f": '{scalar}' looks like the scalar part, of another order of the four"
    raise InputError(where, key, wrong)


def _pose_columns(source, body, keys, import_map, where):
    """Times, columns by key of a body's pose, in m and rad, and remarks."""
    places = [f"{body}.{axis}" for axis in AXES]
    turns = [f"{body}.{ANGLE}", *(f"{body}.{part}" for part in _TURNS)]
    for key in keys:
        if key in turns[1:] and (import_map.columns[key].unit or import_map.rotation_unit != "rad"):
            raise InputError(where, f"columns.{key}", "expected a quaternion's column without unit")
    _check_frame(body, keys, import_map, where)
    columns, remarks = {}, []
    for names, kind in ((places, "displacement"), (turns, "rotation")):
        mapped = [name for name in names if name in keys]
        if not mapped:
            raise InputError(where, "columns", f"expected a column of {body} among {', '.join(names)}")
        time, values, more = columns_of(source, mapped, import_map, kind, where)
        columns |= dict(zip(mapped, values.T, strict=True))
        remarks += more
    if import_map.quaternion != _QUATERNIONS[0]:
        columns |= {key: -columns[key] for key in turns[2:] if key in columns}
    return time, columns, remarks


def _check_frame(body, keys, import_map, where):
    """Refuse a map whose places and quaternions do not turn together from the file's frame into x, y, z.

    A map of places is a signed permutation of the file's axes, which the last letters of the columns name. The map is
    a frame where its determinant is 1, and the vector part of a quaternion then has the same map.
    """
    places, turns = ([f"{body}.{part}{axis}" for axis in AXES] for part in ("", "q"))
    if not {*places, *turns, f"{body}.qw"} <= set(keys):
        return
    place, turn = (_signed_axes([import_map.columns[key] for key in names]) for names in (places, turns))
    conjugate = 1 - 2 * import_map.columns[f"{body}.qw"].reversed
    if not place.any() or not turn.any():  # letters that are no axes: signs alone
        place, turn = (
            np.diag([1 - 2 * import_map.columns[key].reversed for key in names]) for names in (places, turns)
        )
        place = (
            conjugate * turn if np.array_equal(place, -conjugate * turn) else place
        )  # an odd exchange of axes, perhaps
    elif np.linalg.det(place) < 0.0:
        wrong = "expected axes that make a right-handed frame; the map mirrors: reverse one of them"
        raise InputError(where, f"columns.{body}.y", wrong)
    differs = np.flatnonzero((place != conjugate * turn).any(axis=1))
    if len(differs):
        axis = AXES[differs[0]]
        wrong = f"expected the axis and the sign of {body}.{axis}: places and rotations turn together"
        raise InputError(where, f"columns.{body}.q{axis}", wrong)


def _signed_axes(columns):
    """Signed permutation (3, 3) by the last letters of three columns; zeros where these are not x, y and z."""
    letters = [column.column.strip()[-1:].lower() for column in columns]
    if sorted(letters) != list(AXES):
        return np.zeros((3, 3))
    signs = [1 - 2 * column.reversed for column in columns]
    return np.diag(signs) @ np.eye(3)[[AXES.index(letter) for letter in letters]]


def posed_table(test, import_map, structure, where):
    """Text of a CSV table with ``time_s`` and the columns of the free body; see `read_poses`."""
    body = structure.body_names[free_body(structure)[0]]
    known = [f"{body}.{part}" for part in (*AXES, ANGLE, *_TURNS)]
    for key in import_map.columns:
        if key not in known:
            raise InputError(where, f"columns.{key}", f"expected one of {', '.join(known)}")
    check_once(import_map.columns, import_map, where)
    time, columns, _ = _pose_columns(test.file, body, list(import_map.columns), import_map, where)
    return pd.DataFrame({"time_s": time, **columns}).to_csv(index=False)
