"""Synthetic campaigns without a simulator: a table, and blocks that follow it, slip, turn and rock as prescribed."""

import copy
from dataclasses import replace

import numpy as np
import xarray as xr
from scipy.signal import lfilter
from scipy.spatial.transform import Rotation

from blockshake.files import load_yaml, shipped
from blockshake.geometry.structure import build_structure
from blockshake.measurement.sensors.accelerometers import (
    FINE_RATE,
    SKIP,
    accelerometer_channels,
    reading_times,
    readings_of,
    specific_forces,
)
from blockshake.measurement.sensors.instruments import Instruments, observe
from blockshake.measurement.sensors.transducers import transducer_lengths, transducer_names

DURATION = 10.0  # s
HALF_WIDTH = 0.4  # m
# peak rotation of each test's rocking: one test below onset
ROCKING = (0.0, 8e-3, 16e-3)


def structure_of_three(face_markers_only=False, transducers=()):
    """Configuration 1: four markers a body as shipped, or only those on one face, which lie on a line."""
    mapping = copy.deepcopy(load_yaml(shipped("structures", "configuration-1")))
    mapping["displacement_transducers"] = list(transducers)
    if face_markers_only:
        mapping["markers"] = [marker for marker in mapping["markers"] if not marker["name"].endswith("-end")]
    return build_structure(mapping, "three.yaml", ".")


def make_run(structure, rocking, seed, pitch=0.0, survey=3e-4):
    """Run file's content of a prescribed motion.

    Parameters
    ----------
    structure : Structure
        A stack on a driven slab.
    rocking : float
        Peak rotation of the stack about its base edges [rad]; slip and yaw grow with it.
    seed : int
    pitch : float
        For slab and stack about the slab's centre, over the table's acceleration [rad s2/m].
    survey : float
        Standard deviation of the blocks' places at the start, against the structure [m].
    """
    generator = np.random.default_rng([seed, 77])
    table = _table(generator)
    offsets = generator.normal(0.0, survey, (len(structure.mass), 3)) * [1.0, 1.0, 0.0]
    structure = replace(
        structure, position=structure.position + np.where(structure.driven[:, None], 0.0, offsets)
    )
    kicks = _kicks(generator)
    markers = np.arange(round(DURATION * 200) + 1) / 200.0
    fine = np.arange(round(DURATION * FINE_RATE) + 1) / FINE_RATE
    position, orientation = _poses(structure, markers, table, kicks, rocking, pitch)
    fine_position, fine_orientation = _poses(structure, fine, table, kicks, rocking, pitch)
    velocity = np.gradient(fine_position, fine, axis=0)
    turns = _quaternions_to_rotation(fine_orientation)
    spin = np.stack([np.gradient(turn, fine, axis=0) for turn in turns], axis=1)
    time_acc = reading_times(fine)
    readings = readings_of(specific_forces(structure, fine_orientation, velocity, spin), time_acc)
    run = xr.Dataset(
        {
            "position": (("time", "body", "axis"), position),
            "orientation": (("time", "body", "quaternion"), orientation),
            "accelerometer": (("time_acc", "channel"), readings, {"units": "m s-2"}),
        },
        {"time": markers, "time_acc": time_acc, "channel": accelerometer_channels(structure)},
    )
    if structure.file.displacement_transducers:
        lengths = transducer_lengths(structure, fine_position[::SKIP], fine_orientation[::SKIP])
        run["transducer_displacement"] = (("time_acc", "transducer"), lengths - lengths[0], {"units": "m"})
        run["transducer"] = transducer_names(structure)
    return run


def make_test(structure, run, seed, colour=0.0, mounting=0.0, outliers=0.0, **faults):
    """Readings of a run with coloured noise, markers mounted within ``mounting`` [m], outliers and faults."""
    places = dict(faults.pop("marker_offset", {}))
    generator = np.random.default_rng([seed, 5])
    # a marker stays where it is mounted in all tests of a campaign
    mounted = np.random.default_rng([seed // 100, 6])
    for marker in structure.file.markers:
        shift = mounted.uniform(-mounting, mounting, 3)
        places[marker.name] = tuple(shift + np.array(places.get(marker.name, (0.0, 0.0, 0.0))))
    ranges = faults.pop("marker_range", {})  # which the noise is held to as well
    sigma, sigma_acc = faults.pop("marker_noise", 1e-4), faults.pop("accelerometer_noise", 0.02)
    silent = Instruments(
        marker_noise=0.0, accelerometer_noise=0.0, transducer_noise=0.0, marker_offset=places, **faults
    )
    test = observe(run, structure, silent, seed)
    noise = coloured(generator, test["marker_displacement"].shape, colour, sigma)
    hit = generator.random(noise.shape[:2]) < outliers
    noise[hit] += generator.normal(0.0, 50.0 * sigma, (hit.sum(), 3))
    test["marker_displacement"] = test["marker_displacement"] + noise - noise[:1]
    for name, end in ranges.items():
        read = test["marker_displacement"].loc[{"marker": name}]
        read[:] = read.clip(-end, end)
    test["accelerometer"] = test["accelerometer"] + coloured(
        generator, test["accelerometer"].shape, colour, sigma_acc
    )
    if "transducer_displacement" in test:
        noise = coloured(generator, test["transducer_displacement"].shape, colour, sigma)
        test["transducer_displacement"] = test["transducer_displacement"] + noise - noise[:1]
    return test


def make_tests(structure, seed, rocking=ROCKING, pitch=0.0, colour=0.3, **faults):
    """Tests of a campaign by name; a pool of runs would correlate campaigns, so each has its own."""
    return {
        f"t{index + 1}": make_test(
            structure,
            make_run(structure, peak, 100 * seed + index, pitch),
            100 * seed + index,
            colour,
            **faults,
        )
        for index, peak in enumerate(rocking)
    }


def coloured(generator, shape, coefficient, spread):
    """Stationary first-order autoregressive noise along the first axis."""
    white = generator.normal(0.0, spread * np.sqrt(1.0 - coefficient**2), shape)
    white[0] /= np.sqrt(1.0 - coefficient**2)
    return lfilter([1.0], [1.0, -coefficient], white, axis=0)


def _table(generator):
    """Displacement of the table: sines from 0.3 to 8 Hz under a window, 1 to 1.6 m/s2 at its peak."""
    frequency = np.geomspace(0.3, 8.0, 40)
    phase = generator.uniform(0.0, 2.0 * np.pi, 40)
    strength = generator.normal(0.0, 1.0, 40) / frequency**1.2

    def displacement(time):
        inside = np.clip((time - 0.6) / (DURATION - 1.6), 0.0, 1.0)
        window = np.sin(np.pi * inside) ** 2
        waves = np.sin(2.0 * np.pi * frequency * time[:, None] + phase) @ strength
        return window * waves

    grid = np.linspace(0.0, DURATION, 2001)
    peak = np.abs(np.gradient(np.gradient(displacement(grid), grid), grid)).max()
    size = generator.uniform(1.0, 1.6) / peak
    return lambda time: size * displacement(time)


def _kicks(generator):
    """Times, lengths and signs of the excursions of rocking [s, s, 1] with their relative size."""
    starts = 3.0 + np.cumsum(generator.uniform(0.35, 0.8, 8))
    lengths = generator.uniform(0.3, 0.6, 8)
    return starts, lengths, generator.choice([-1.0, 1.0], 8), generator.uniform(0.3, 1.0, 8)


def _poses(structure, time, table, kicks, rocking, pitch):
    """Positions and quaternions (n_times, n_bodies, 3 and 4)."""
    step = 1e-3
    shift = table(time)
    lean = pitch * (table(time + step) - 2.0 * shift + table(time - step)) / step**2
    angle, slip, yaw = np.zeros(len(time)), np.zeros(len(time)), np.zeros(len(time))
    for start, length, sign, size in zip(*kicks, strict=True):
        part = np.clip((time - start) / length, 0.0, 1.0)
        angle += sign * size * rocking * np.sin(np.pi * part) ** 2
        slip += 0.1 * sign * size * rocking * (part - np.sin(2.0 * np.pi * part) / (2.0 * np.pi))
        yaw += 0.05 * size * rocking * (part - np.sin(2.0 * np.pi * part) / (2.0 * np.pi))
    n_bodies = len(structure.mass)
    position = np.empty((len(time), n_bodies, 3))
    centre = structure.position[0]
    edge = np.column_stack([HALF_WIDTH * np.sign(angle), 0.0 * angle, 0.0 * angle])
    rock = Rotation.from_rotvec(angle[:, None] * [0.0, 1.0, 0.0])
    tilt = Rotation.from_rotvec(lean[:, None] * [0.0, 1.0, 0.0])
    whole = tilt * Rotation.from_rotvec(yaw[:, None] * [0.0, 0.0, 1.0]) * rock
    for body in range(n_bodies):
        place = np.tile(structure.position[body], (len(time), 1))
        if body:
            place = edge + rock.apply(place - edge)
            place[:, 0] += body * slip
        position[:, body] = centre + tilt.apply(place - centre) + shift[:, None] * [1.0, 0.0, 0.0]
    turns = [tilt if body == 0 else whole for body in range(n_bodies)]
    return position, np.stack([turn.as_quat()[:, [3, 0, 1, 2]] for turn in turns], axis=1)


def _quaternions_to_rotation(orientation):
    """Rotation vectors of each body: small and about nearly one axis, so their rate is the angular velocity."""
    return [
        Rotation.from_quat(orientation[:, body, [1, 2, 3, 0]]).as_rotvec()
        for body in range(orientation.shape[1])
    ]
