"""Newton and Euler: the wrench that each body must have been given, from its motion."""

from dataclasses import dataclass

import numpy as np

_UNREAD = 1e-12  # of the largest eigenvalue


@dataclass(frozen=True)
class RequiredWrenches:
    """Wrenches of all contacts on each body, about its mass centre, world frame."""

    # float64 (n_times, n_bodies, 6); force [N] and moment [N m]; NaN where the body's motion is unknown
    wrench: np.ndarray
    # float64 (n_times, n_bodies, 6, 6); inverse covariance; singular where a direction is not read
    information: np.ndarray
    # list of dict of Colour to float64 (n_times, 6, n_sources); by body: errors of the wrench by one standard
    # deviation of every sensor's noise
    errors: list


def required_wrenches(structure, motion):
    """`RequiredWrenches` of a `Motion` by Newton, ``F = m (a - g)``, and Euler, ``M = I alpha + omega x I omega``.

    Of driven bodies too, whose mass is the structure's.
    """
    turn = motion.rotation
    inertia = turn @ structure.inertia @ np.swapaxes(turn, -1, -2)
    gravity = np.array(structure.file.gravity)
    force = structure.mass[:, None] * (motion.acceleration - gravity)
    spin = motion.angular_velocity
    momentum = np.einsum("tbij,tbj->tbi", inertia, spin)
    moment = np.einsum("tbij,tbj->tbi", inertia, motion.angular_acceleration) + np.cross(spin, momentum)
    known = np.isfinite(inertia).all(axis=(-2, -1))
    masses, inverse = np.zeros((2, *inertia.shape[:2], 6, 6))
    masses[..., :3, :3] = np.eye(3) * structure.mass[:, None, None]
    masses[known, 3:, 3:] = inertia[known]
    inverse[known] = np.linalg.inv(masses[known])
    information = np.swapaxes(inverse, -1, -2) @ motion.information @ inverse
    errors = [
        {colour: masses[:, body] @ part for colour, part in parts.items()}
        for body, parts in enumerate(motion.errors)
    ]
    return RequiredWrenches(np.concatenate([force, moment], axis=-1), information, errors)


def unread_directions(information):
    """Unit vectors, in columns, along which information matrices hold none; zero columns for the others."""
    values, vectors = np.linalg.eigh(information)
    return np.where((values > _UNREAD * values[..., -1:])[..., None, :], 0.0, vectors)


def covariance_root(information):
    """Symmetric roots C of the inverses of information matrices; directions not read are left out.

    They go smoothly from instant to instant, as roots of eigenvectors with their free signs do not.
    """
    values, vectors = np.linalg.eigh(information)
    read = values > _UNREAD * values[..., -1:]
    scaled = vectors * np.where(read, 1.0 / np.sqrt(np.where(read, values, 1.0)), 0.0)[..., None, :]
    return scaled @ np.swapaxes(vectors, -1, -2)
