"""Unknowns of a body whose fall was seen, and the causes that they stand for."""

from dataclasses import dataclass

import numpy as np
from scipy.spatial.transform import Rotation

_OFFSET = 0.03  # of the body's largest extent, by which its mass centre may lie off at most


@dataclass(frozen=True)
class Unknown:
    """One unknown, of which a model has a share ``u`` from -1 to 1; 0 is the structure file's."""

    # name, unit: of the parameter that it stands for
    name: str
    unit: str
    cause: str | None  # effect whose parameter this is; None of what is never named
    usual: float  # largest share, up or down, that an undamaged model has


UNKNOWNS = (
    Unknown("offset_x", "m", "eccentricity", 0.2),
    Unknown("offset_y", "m", "eccentricity", 0.2),
    Unknown("offset_z", "m", "eccentricity", 0.2),
    Unknown("friction_factor", "1", "weak-joint", 0.2),
    Unknown("restitution_change", "1", "impact-restitution", 0.25),
    Unknown("motion_factor", "1", None, 0.2),
    Unknown("heading", "rad", None, 0.5),
)
_FACTOR = {"friction_factor": 2.0, "motion_factor": 1.15}  # at a share of 1
_RESTITUTION, _HEADING = 0.5, np.radians(10.0)  # at a share of 1
RESTITUTION = {
    "nscd-rigid": "nscd_restitution",
    "ls-dem": "restitution",
}  # key of the structure file, by solver


def value_of(unknown, share, extent):
    """Value of an unknown at a share, in its unit; ``extent``: the body's largest [m]. Shares may be arrays."""
    if unknown.name in _FACTOR:
        return np.exp(share * np.log(_FACTOR[unknown.name]))
    if unknown.name == "restitution_change":
        return share * _RESTITUTION
    return share * (_HEADING if unknown.name == "heading" else _OFFSET * extent)


def model_at(structure, body, solver, shares):
    """Structure and the factor on the motion of the model with some shares, in the order of `UNKNOWNS`.

    ``body``: number of the one free body. The mass centre moves in the body's frame, the heading turns the body about
    the vertical through its centroid, and restitution stays within 0 and 0.95.
    """
    file = structure.file
    own = file.bodies[body]
    values = {
        unknown.name: float(value_of(unknown, share, largest_extent(structure, body)))
        for unknown, share in zip(UNKNOWNS, shares, strict=True)
    }
    offset = np.array(own.mass_offset) + [values[f"offset_{axis}"] for axis in "xyz"]
    turned = Rotation.from_rotvec([0.0, 0.0, values["heading"]]) * Rotation.from_quat(
        own.orientation, scalar_first=True
    )
    key = RESTITUTION[solver]
    parameters = {
        f"bodies.{own.name}.mass_offset": offset.tolist(),
        f"bodies.{own.name}.orientation": turned.as_quat(scalar_first=True).tolist(),
        key: float(np.clip(getattr(file, key) + values["restitution_change"], 0.0, 0.95)),
        **{
            "friction." + ".".join(entry.pair): entry.coefficient * values["friction_factor"]
            for entry in file.friction
        },
    }
    return structure.with_parameters(parameters), values["motion_factor"]


def largest_extent(structure, body):
    """Largest extent of a body along its own axes [m]."""
    return float(np.ptp(structure.solid(body).vertices, axis=0).max())
