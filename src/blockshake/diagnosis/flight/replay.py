"""A filmed test once more by a solver, from the state that its first flight shows."""

from dataclasses import dataclass

import numpy as np
from scipy.spatial.transform import Rotation

from blockshake.diagnosis.flight.causes import air_drag
from blockshake.dynamics.motion import GroundMotion, rest_table
from blockshake.forces.flight.paths import dragged_by_square, fallen, off_centre
from blockshake.geometry.rotations import rotation_matrices
from blockshake.measurement.poses.posed_test import PosedTest
from blockshake.simulation.simulate import simulate

MODEL = "nscd-rigid"
_LATEST = 5  # rows, after which a first flight is no start of the test


@dataclass(frozen=True)
class FlightModel:
    """A model of the tests.

    Attributes
    ----------
    friction, restitution : float
        Of the body on the ground; Newton's [1].
    fits : tuple of FlightFit
        Causes in it.
    shift : tuple of float
        Steady acceleration without a name [m/s2].
    """

    friction: float
    restitution: float
    fits: tuple = ()
    shift: tuple = (0.0, 0.0, 0.0)


@dataclass(frozen=True)
class Replayed:
    """Distance of a replay from its test at each reading, from the first flight on.

    ``middle`` (n_times,): of the body's middle [m]; ``turned`` (n_times,): angle between the rotations [rad].
    """

    middle: np.ndarray
    turned: np.ndarray


def start_arc(test, arcs):
    """The flight from which a test can be simulated, None where it starts in an impact or broken."""
    own = [arc for arc in arcs if arc.test == test.name]
    return own[0] if own and own[0].first < _LATEST else None


def replay(posed, test, arc, model):
    """`Replayed` test by a `FlightModel`.

    Parameters
    ----------
    posed : PosedCampaign
    test : PosedTest
    arc : Arc
        From `start_arc`.
    model : FlightModel
    """
    run = filmed_replay(posed, test, arc, model)
    seen = slice(arc.first, None)
    return Replayed(
        np.linalg.norm(run.position - np.nan_to_num(test.position[seen]) / _length(model), axis=1),
        (Rotation.from_matrix(test.rotation[seen]).inv() * Rotation.from_matrix(run.rotation)).magnitude(),
    )


def filmed_replay(posed, test, arc, model, solver=MODEL, **options):
    """A `PosedTest` as a solver has it, at the readings of a test from its first flight on.

    Parameters
    ----------
    posed, test, arc, model
        As of `replay`.
    solver : str
    **options
        Parameters and time step of `simulate`.
    """
    structure = _structure(posed, test, arc, model)
    time = test.time[arc.first :] - test.time[arc.first]
    step = float(np.median(np.diff(time)))
    still = GroundMotion("ground at rest", rest_table(), "displacement")
    run = simulate(
        structure, still, solver, duration=float(time[-1]) + step, output_rate=1.0 / step, accelerometers=False,
        **options,
    )  # fmt: skip
    rotation = rotation_matrices(run["orientation"].to_numpy()[:, posed.body])
    centroid = run["position"].to_numpy()[:, posed.body] - rotation @ structure.mass_offset[posed.body]
    at = np.clip(np.rint(time / step).astype(int), 0, len(centroid) - 1)
    return PosedTest(test.name, time, centroid[at], rotation[at], planar=False)


def _size(model, name):
    """Sizes of a cause in a model, zero where it has none."""
    return next((fit.sizes for fit in model.fits if fit.cause.name == name), np.zeros(3))


def _length(model):
    """Lengths read over true ones."""
    return 1.0 + _size(model, "sensor-gain")[0]


def _structure(posed, test, arc, model):
    """The structure with the body at the start of a test, and the causes in it."""
    mapping = posed.structure.file.model_dump(mode="json")
    body = mapping["bodies"][posed.body]
    offset = np.array(body["mass_offset"]) + _size(model, "eccentricity")
    position, velocity, orientation, spin = _start(posed, arc, model)
    body |= {
        "mass_offset": offset.tolist(), "position": position.tolist(), "velocity": velocity.tolist(),
        "orientation": orientation.tolist(), "angular_velocity": spin.tolist(),
    }  # fmt: skip
    materials = sorted({one["material"] for one in mapping["bodies"]})
    for entry in mapping["friction"]:
        if sorted(set(entry["pair"])) == materials:
            entry["coefficient"] = model.friction
    mapping["gravity"] = (np.array(mapping["gravity"]) + model.shift).tolist()
    mapping["nscd_restitution"] = mapping["restitution"] = model.restitution
    damping, dry = _size(model, "drag")[0], _size(model, "dry-drag")[0]
    if damping or dry:
        mapping["external_forces"] += [
            {"body": posed.name, "position": offset.tolist(), "axis": axis, "damping": damping, "drag": dry}
            for axis in "xyz"
        ]
    pushes = _size(model, "push")
    mapping["external_forces"] += [
        {"body": posed.name, "position": offset.tolist(), "axis": axis, "amplitude": float(size)}
        for axis, size in zip("xy", pushes[:2], strict=True)
        if size
    ]
    return posed.structure.with_mapping(mapping)


def _start(posed, arc, model):
    """State at the flight's first reading by least squares over the flight.

    Returns
    -------
    position, velocity, orientation, spin : float64 arrays
        Of the centroid [m, m/s], unit quaternion, world frame [rad/s].
    """
    offset = np.array(posed.structure.file.bodies[posed.body].mass_offset) + _size(model, "eccentricity")
    known = fallen(arc, posed.structure.file.gravity) + air_drag(posed) * dragged_by_square(arc)[:, 0]
    known = known + 0.5 * arc.time[:, None] ** 2 * np.array(model.shift)
    for fit in model.fits:
        if fit.cause.name not in ("sensor-gain", "eccentricity"):
            known = known + np.einsum("nkx,k->nx", fit.cause.paths(arc, posed), fit.sizes)
    centre = arc.position / _length(model) - np.einsum("nkx,k->nx", off_centre(arc), offset) - known
    line = np.stack([np.ones_like(arc.time), arc.time], axis=1)
    (place, velocity), *_ = np.linalg.lstsq(line, centre, rcond=None)
    turned = Rotation.from_matrix(arc.rotation)
    middle = turned[len(arc.time) // 2]
    (away, spin), *_ = np.linalg.lstsq(line, (turned * middle.inv()).as_rotvec(), rcond=None)
    orientation = Rotation.from_rotvec(away) * middle
    arm = orientation.apply(offset)
    return place - arm, velocity - np.cross(spin, arm), orientation.as_quat(scalar_first=True), spin
