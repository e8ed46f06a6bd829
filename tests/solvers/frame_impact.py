"""Rigid impacts of a lintel on two columns that come upright: the energy kept, by the column that comes down first."""

import numpy as np


def energy_kept(structure, pivot, leans, friction=0.75):
    """Share of the kinetic energy that is left when nothing closes any more [1].

    Bodies 1 and 2 of the structure are columns, rear and front, and turn about their rear lower edges; body 3 lies on
    their front upper edges. ``pivot``: distance of the edges from a column's axis [m]. ``leans`` of both columns, in
    any unit: the impacts follow each other within so short a time that gravity does nothing. Each is Moreau's: of all
    contacts that touch and do not open, at once, without rebound, with Coulomb's friction.
    """
    centre, mass = structure.centroid[1:], structure.mass[1:]
    inertia = structure.inertia[1:, 1, 1]
    weight = np.column_stack([mass, mass, inertia]).ravel()
    axes, top = centre[:2, 0], 2.0 * centre[0, 2]
    slope = 2.0 * pivot * (leans[1] - leans[0]) / (axes[1] - axes[0])
    rows, gaps = [], []
    for column in range(2):
        for side in (-1.0, 1.0):
            x = axes[column] + side * pivot
            rows.append(_row(centre, x, 0.0, None, column))
            rows.append(_row(centre, x, top, column, 2))
            closing = 2.0 * pivot * leans[column]
            gaps += [closing, 0.0] if side > 0.0 else [0.0, closing - 2.0 * pivot * slope]
    rows, gaps = np.array(rows), np.array(gaps)
    velocity = np.zeros((3, 3))  # along x and z, spin about y
    for column in range(2):
        velocity[column] = centre[column, 2], axes[column] - pivot - centre[column, 0], 1.0
    velocity[2] = top, -2.0 * pivot, 0.0
    velocity = velocity.ravel()
    before = weight @ velocity**2
    while True:
        opening = rows[:, 0] @ velocity
        touching = (gaps < 1e-9) & (opening < 1e-9)
        if (opening[touching] < -1e-9).any():
            velocity = _after(rows[touching], weight, velocity, friction)
            opening = rows[:, 0] @ velocity
        closing = (gaps >= 1e-9) & (opening < -1e-9)
        if not closing.any():
            return weight @ velocity**2 / before
        gaps = gaps + opening * (gaps[closing] / -opening[closing]).min()


def _row(centre, x, z, lower, upper):
    """Normal and tangential velocity of the upper body against the lower at a place, by the bodies' velocities."""
    row = np.zeros((2, 3, 3))
    for body, sign in ((lower, -1.0), (upper, 1.0)):
        if body is not None:
            row[0, body] = 0.0, sign, -sign * (x - centre[body, 0])
            row[1, body] = sign, 0.0, sign * (z - centre[body, 2])
    return row.reshape(2, 9)


def _after(rows, weight, velocity, friction):
    """Velocities after one impact: each contact's law in turn until all hold."""
    impulse = np.zeros(rows.shape[:2])
    velocity = velocity.copy()
    mobility = (rows**2 / weight).sum(axis=2)
    for _ in range(100_000):
        last = velocity.copy()
        for contact, row in enumerate(rows):
            for part in range(2):
                wanted = impulse[contact, part] - row[part] @ velocity / mobility[contact, part]
                limit = friction * impulse[contact, 0]
                wanted = max(wanted, 0.0) if part == 0 else np.clip(wanted, -limit, limit)
                velocity += row[part] / weight * (wanted - impulse[contact, part])
                impulse[contact, part] = wanted
        if np.abs(velocity - last).max() < 1e-12:
            return velocity
    raise AssertionError("the impact has not been solved")
