"""A filmed test once more by a solver, from the state that its first flight shows."""

from dataclasses import dataclass

import numpy as np
from scipy.spatial.transform import Rotation, Slerp

from blockshake.dynamics.motion import GroundMotion, rest_table
from blockshake.geometry.rotations import rotation_matrices
from blockshake.simulation.simulate import simulate
from blockshake_flight.causes import air_drag
from blockshake_flight.inertia import with_inertia
from blockshake_flight.paths import dragged_by_square, fallen, off_centre
from blockshake_flight.tracked_test import TrackedTest
from blockshake_flight.tumbling import spins, tumbling

MODEL = "nscd-rigid"


@dataclass(frozen=True)
class FlightModel:
    """A model of the tests."""

    # friction, restitution: of the body on the ground; Newton's [1]
    friction: float
    restitution: float
    fits: tuple = ()  # of FlightFit; causes in it
    shift: tuple = (0.0, 0.0, 0.0)  # of float; steady acceleration without a name [m/s2]
    # of float; logarithms of the moments along the body's axes over those of the structure file
    inertia: tuple = (0.0, 0.0, 0.0)


@dataclass(frozen=True)
class Replayed:
    """Distance of a replay from its test at each reading, from the first flight on.

    ``middle`` (n_times,): of the body's middle [m]; ``turned`` (n_times,): angle between the rotations [rad]; both
    NaN in gaps.
    """

    middle: np.ndarray
    turned: np.ndarray


def start_arc(test, arcs):
    """The first flight of a test, from which it can be simulated; None without any."""
    return next((arc for arc in arcs if arc.test == test.name), None)


def replay(tracked, test, arc, model):
    """`Replayed` test by a `FlightModel`.

    Parameters
    ----------
    tracked : TrackedCampaign
    test : TrackedTest
    arc : Arc
        From `start_arc`.
    model : FlightModel
    """
    run = filmed_replay(tracked, test, arc, model)
    position, rotation = test.position[arc.first :], test.rotation[arc.first :]
    read = np.isfinite(position[:, test.axes]).all(axis=1) & np.isfinite(rotation).all(axis=(1, 2))
    middle, turned = np.full((2, len(read)), np.nan)
    seen = _true_lengths(tracked, np.nan_to_num(position[read]), model)
    middle[read] = np.linalg.norm(run.position[read] - seen, axis=1)
    turned[read] = (
        Rotation.from_matrix(rotation[read]).inv() * Rotation.from_matrix(run.rotation[read])
    ).magnitude()
    return Replayed(middle, turned)


def filmed_replay(tracked, test, arc, model, solver=MODEL, **options):
    """A `TrackedTest` as a solver has it, at the readings of a test from its first flight on.

    Parameters
    ----------
    posed, test, arc, model
        As of `replay`.
    solver : str
    **options
        Parameters and time step of `simulate`.
    """
    tracked = with_inertia(tracked, model.inertia)
    structure = _structure(tracked, test, arc, model)
    time = test.time[arc.first :] - test.time[arc.first]
    step = float(np.median(np.diff(time)))
    still = GroundMotion("ground at rest", rest_table(), "displacement")
    run = simulate(
        structure, still, solver, duration=float(time[-1]) + step, output_rate=1.0 / step, accelerometers=False,
        **options,
    )  # fmt: skip
    rotation = rotation_matrices(run["orientation"].to_numpy()[:, tracked.body])
    centroid = run["position"].to_numpy()[:, tracked.body] - rotation @ structure.mass_offset[tracked.body]
    clock = run["time"].to_numpy()
    place = np.array([np.interp(time, clock, values) for values in centroid.T]).T
    turned = Slerp(clock, Rotation.from_matrix(rotation))(np.minimum(time, clock[-1])).as_matrix()
    return TrackedTest(test.name, time, place, turned, planar=False)


def _size(model, name):
    """Sizes of a cause in a model, zero where it has none."""
    return next((fit.sizes for fit in model.fits if fit.cause.name == name), np.zeros(3))


def _true_lengths(tracked, position, model):
    """Positions as they are where lengths were read too long; heights count from the ground."""
    ground = np.array([0.0, 0.0, tracked.ground])
    return ground + (position - ground) / (1.0 + _size(model, "sensor-gain")[0])


def _structure(tracked, test, arc, model):
    """The structure with the body at the start of a test, and the causes in it."""
    mapping = tracked.structure.file.model_dump(mode="json")
    body = mapping["bodies"][tracked.body]
    offset = np.array(body["mass_offset"]) + _size(model, "eccentricity")
    position, velocity, orientation, spin = _start(tracked, arc, model)
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
    damping = float(_size(model, "drag")[0])
    if damping:
        mapping["external_forces"] += [
            {"body": tracked.name, "position": offset.tolist(), "axis": axis, "damping": damping}
            for axis in "xyz"
        ]
    pushes = _size(model, "push")
    mapping["external_forces"] += [
        {"body": tracked.name, "position": offset.tolist(), "axis": axis, "amplitude": float(size)}
        for axis, size in zip("xy", pushes[:2], strict=True)
        if size
    ]
    return tracked.structure.with_mapping(mapping)


def _start(tracked, arc, model):
    """State at the flight's first reading by least squares over the flight.

    Returns
    -------
    position, velocity, orientation, spin : float64 arrays
        State of the centroid [m, m/s], unit quaternion, spin in the world frame [rad/s].
    """
    offset = np.array(tracked.structure.file.bodies[tracked.body].mass_offset) + _size(model, "eccentricity")
    known = fallen(arc, tracked.structure.file.gravity) + air_drag(tracked) * dragged_by_square(arc)[:, 0]
    known = known + 0.5 * arc.time[:, None] ** 2 * np.array(model.shift)
    for fit in model.fits:
        if fit.cause.name not in ("sensor-gain", "eccentricity"):
            known = known + np.einsum("nkx,k->nx", fit.cause.paths(arc, tracked), fit.sizes)
    centre = (
        _true_lengths(tracked, arc.position, model) - np.einsum("nkx,k->nx", off_centre(arc), offset) - known
    )
    line = np.stack([np.ones_like(arc.time), arc.time], axis=1)
    (place, velocity), *_ = np.linalg.lstsq(line, centre, rcond=None)
    path, momentum = tumbling(tracked, arc)
    orientation, spin = path[0], spins(tracked, path, momentum)[0]
    arm = orientation.apply(offset)
    return place - arm, velocity - np.cross(spin, arm), orientation.as_quat(scalar_first=True), spin
