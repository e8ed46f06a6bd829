"""Histories that follow from a run file: drift of the blocks, state of the joints, residual of the energy audit."""

import numpy as np
import xarray as xr

from blockshake.geometry.rotations import rotation_matrices
from blockshake.measurement.motion.joints import contact_normals, find_joints, joint_coordinates
from blockshake.simulation.energy_residual import unexplained_energy
from blockshake.simulation.pounding import pounding
from blockshake.simulation.rocking import angular_momentum_ratio, overturning_margins
from blockshake.simulation.run_dataset import histories

# dimensions, unit and name of the histories of the joints, and of all
JOINT_HISTORIES = {
    "normal_force": ("time joint", "N", "normal force, compression positive"),
    "shear_force": ("time joint", "N", "magnitude of the shear force"),
    "friction_ratio": ("time joint", "1", "shear over Coulomb's limit"),
    "uplift": ("time joint", "m", "opening at the middle of the face"),
    "slip": ("time joint", "m", "slip at the middle of the face, magnitude"),
}
_HISTORIES = {
    "drift": ("time body axis", "m", "displacement against the base"),
    **JOINT_HISTORIES,
    "joint_position": ("time joint axis", "m", "middle of the joint"),
    "residual": ("time", "J", "unexplained energy"),
}
_LEAST_LOAD = 0.01  # of the upper body's weight: below it the ratio of two small forces tells nothing
RARELY = 0.01  # share of the time for which a joint is pressed harder; the peaks of impacts are briefer


def run_histories(run, structure):
    """Histories of a run, from its run file and its structure.

    Returns
    -------
    xarray.Dataset
        ``drift(time, body, axis)``: displacement of the mass centre since the start against the first driven body,
        in that body's frame; in the inertial frame where no body is driven [m].

        Histories of every pair that touched, by the face that it had at the start, NaN where it had none or a shape
        is not convex: ``normal_force(time, joint)``, positive in compression, and ``shear_force`` [N];
        ``friction_ratio``, shear over the largest shear that Coulomb's law at rest allows [1], NaN below 1 % of the
        upper body's weight;
        ``uplift`` along the normal and ``slip`` along the face, both at the middle of the face [m].

        ``joint_position(time, joint, axis)``: middle of what the bounding boxes of the two have in common, inertial
        frame [m]. ``residual(time)``: energy that the audit does not explain [J]. Coordinates ``driven(body)``,
        and those of the run.

    Notes
    -----
    The normal turns with the lower body. A block that rocks about its edge is lifted at the middle of its face by half
    the width times the angle.
    """
    position, turns = run["position"].to_numpy(), rotation_matrices(run["orientation"])
    names = structure.body_names
    sides = [[names.index(name) for name in run[side].values] for side in ("lower", "upper")]
    pairs = np.array(sides, dtype=int).T
    joints = _joint_states(run, structure, pairs, position, turns)
    return xr.Dataset(
        histories(
            _HISTORIES,
            {
                **joints,
                "drift": drift_histories(structure, position, turns),
                "joint_position": _middles(structure, pairs, position, turns),
                "residual": unexplained_energy(run["energy"].to_numpy()),
            },
        ),
        coords={
            "time": run["time"],
            "body": run["body"],
            "driven": ("body", structure.driven),
            "axis": run["axis"],
            "joint": run["joint"],
            "lower": run["lower"],
            "upper": run["upper"],
        },
    )  # fmt: skip


def drift_histories(structure, position, turns):
    """Displacement of every mass centre since the start against the first driven body, as in `run_histories` [m].

    ``position`` (n_times, n_bodies, 3) and ``turns`` (n_times, n_bodies, 3, 3), body to world, in the inertial frame.
    """
    seen = position
    if structure.driven.any():
        base = int(np.argmax(structure.driven))
        seen = np.einsum("tji,tbj->tbi", turns[:, base], position - position[:, base, None])
        start = rotation_matrices(structure.orientation[base])
        seen = seen @ start.T  # axes of the world at the start, whatever the base's own are called
    return seen - seen[:1]


def _joint_states(run, structure, pairs, position, turns):
    """Forces along the faces of the joints and motion across them, by name, float64 arrays (n_times, n_joints)."""
    states = {name: np.full((len(position), len(pairs)), np.nan) for name in JOINT_HISTORIES}
    known = find_joints(structure)[0]
    if not len(known):
        return states
    seen = joint_coordinates(structure, position, turns)
    moved = np.concatenate([seen["slip"], seen["opening"].to_numpy()[..., None]], axis=-1)
    normals = contact_normals(structure, known)
    gravity = np.linalg.norm(structure.file.gravity)
    rows = {frozenset(pair): row for row, pair in enumerate(known.tolist())}
    for joint, pair in enumerate(pairs.tolist()):
        row = rows.get(frozenset(pair))
        if row is None:
            continue
        lower, upper = known[row]
        # in the lower body's frame
        face_normal = rotation_matrices(structure.orientation[lower]).T @ normals[row]
        across = turns[:, lower] @ face_normal
        force = run["joint_force"].to_numpy()[:, joint] * (1.0 if pair == [lower, upper] else -1.0)
        normal = np.einsum("ti,ti->t", force, across)
        shear = np.linalg.norm(force - normal[:, None] * across, axis=1)
        limit = structure.friction[lower, upper] * normal
        loaded = (normal > _LEAST_LOAD * structure.mass[upper] * gravity) & (limit > 0.0)
        uplift = moved[:, row] @ face_normal
        states["normal_force"][:, joint], states["shear_force"][:, joint] = normal, shear
        states["friction_ratio"][loaded, joint] = shear[loaded] / limit[loaded]
        states["uplift"][:, joint] = uplift
        states["slip"][:, joint] = np.linalg.norm(moved[:, row] - uplift[:, None] * face_normal, axis=1)
    return states


def _middles(structure, pairs, position, turns):
    """Middle of what the bounding boxes of each pair have in common, (n_times, n_joints, 3), inertial frame [m]."""
    low, high = np.empty_like(position), np.empty_like(position)
    for body in range(position.shape[1]):
        corners = np.einsum("tij,vj->tvi", turns[:, body], structure.solid(body).vertices)
        low[:, body] = position[:, body] + corners.min(axis=1)
        high[:, body] = position[:, body] + corners.max(axis=1)
    first, second = pairs.T
    return 0.5 * (np.maximum(low[:, first], low[:, second]) + np.minimum(high[:, first], high[:, second]))


def joint_figures(run, structure):
    """Largest compression, uplift and slip, in a run, of every joint that its structure has at the start.

    Returns
    -------
    xarray.Dataset
        ``joint_compression(joint)``: normal force that is exceeded for 1 % of the time [N]; ``joint_uplift`` and
        ``joint_slip(joint)``: largest opening and slip at the middle of the face, see `run_histories` [m]. NaN where
        a joint is not known there. ``joint_margin(joint)``, from `overturning_margins`, and ``joint_spin_kept(joint)``,
        from `angular_momentum_ratio` [1]. Coordinate ``joint``, ``lower-upper``, from the foundation up. And of
        `pounding`: ``blows`` [1], ``blow_velocity`` [m/s] and ``blow_pair``.

    Notes
    -----
    The largest normal force of all is that of an impact: it lasts a few milliseconds, and depends on the stiffness of
    the contact and on the instants at which a run is written.
    """
    histories = run_histories(run, structure)
    pairs, _ = find_joints(structure)
    names = structure.body_names
    # a run names a pair in the order in which its bodies met
    touched = zip(histories["lower"].values, histories["upper"].values, strict=True)
    columns = {frozenset(pair): column for column, pair in enumerate(touched)}
    columns = [columns.get(frozenset((names[lower], names[upper]))) for lower, upper in pairs]

    def figure(name, statistic):
        """Statistic over the finite values of every joint; NaN where there are none."""
        values = histories[name].to_numpy()
        known = [column is not None and np.isfinite(values[:, column]).any() for column in columns]
        return [
            float(statistic(values[:, c])) if there else np.nan
            for c, there in zip(columns, known, strict=True)
        ]

    reached = np.isfinite(run["position"]).all(("body", "axis")).to_numpy()
    seen = run.isel(time=reached).transpose("time", "body", "axis", "quaternion", ...)
    moved = structure, seen["position"].to_numpy(), rotation_matrices(seen["orientation"].to_numpy())
    time, spin = seen["time"].to_numpy(), seen["angular_velocity"].to_numpy()
    rocking = {
        "joint_margin": overturning_margins(*moved),
        "joint_spin_kept": angular_momentum_ratio(structure, time, *moved[1:], spin),
    }
    blows, velocity, pair = pounding(run, structure)
    return xr.Dataset(
        {
            name: ("joint", figure(history, statistic), {"units": units, "long_name": long_name})
            for name, (history, statistic, units, long_name) in _FIGURES.items()
        }
        | {
            name: ("joint", values, {"units": "1", "long_name": _ROCKING[name]})
            for name, values in rocking.items()
        }
        | {
            "blows": ((), float(blows), {"units": "1", "long_name": "blows of blocks that stand apart"}),
            "blow_velocity": ((), velocity, {"units": "m s-1", "long_name": "velocity of the fastest blow"}),
            "blow_pair": ((), pair, {"long_name": "blocks of the fastest blow"}),
        },
        coords={"joint": np.array([f"{names[lower]}-{names[upper]}" for lower, upper in pairs], dtype=str)},
    )


def _rarely_exceeded(values):
    return np.nanquantile(values, 1.0 - RARELY)


# history of `run_histories`, statistic over time, unit and name of every figure
_FIGURES = {
    "joint_compression": ("normal_force", _rarely_exceeded, "N", "normal force exceeded for 1 % of the time"),
    "joint_uplift": ("uplift", np.nanmax, "m", "largest opening at the middle of the face"),
    "joint_slip": ("slip", np.nanmax, "m", "largest slip at the middle of the face"),
}
_ROCKING = {
    "joint_margin": "least margin against overturning of all above the joint",
    "joint_spin_kept": "share of the spin that impacts of the joint keep, median over them",
}
JOINT_FIGURES, BLOW_FIGURES = (*_FIGURES, *_ROCKING), ("blows", "blow_velocity", "blow_pair")
