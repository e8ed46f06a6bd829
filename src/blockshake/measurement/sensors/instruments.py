"""The observation operator: what the sensors of a test read of a run, with all their faults as parameters."""

import numpy as np
import scipy
import xarray as xr
from pydantic import Field
from scipy.interpolate import CubicSpline

from blockshake.errors import InputError
from blockshake.files import history
from blockshake.geometry.rotations import rotation_matrices
from blockshake.geometry.schema import AXES, Vector
from blockshake.measurement.sensors import accelerometers, markers, transducers
from blockshake.measurement.sensors.markers import marker_position
from blockshake.validation import Finite, NotNegative, Positive, ProperFraction, Strict

_BURST = 10  # readings that a dropout loses in the mean
_OUTLIER = 10.0  # standard deviations of the noise
_LEAST_NOISE = {"marker_noise": 1e-6, "accelerometer_noise": 1e-4, "transducer_noise": 1e-6}  # m, m/s2, m


class SlowNoise(Strict):
    """The slow part of a sort of sensors' noise."""

    share: ProperFraction = Field(0.0, description="of the noise's variance [1]")
    memory: Positive = Field(0.1, description="time in which its correlation falls to 1/e [s]")


class Sensors(Strict):
    """Noise of the readings: standard deviations, and how it goes on from one reading to the next."""

    marker_noise: NotNegative = Field(markers.NOISE, description="of a marker's reading [m]")
    accelerometer_noise: NotNegative = Field(
        accelerometers.NOISE, description="of a channel's reading [m/s2]"
    )
    transducer_noise: NotNegative = Field(
        transducers.NOISE,
        description="of a displacement transducer's reading [m]",
        exclude_if=lambda noise: noise == transducers.NOISE,  # sensors without it keep their digest
    )
    marker_axes: Vector = Field(
        (1.0, 1.0, 1.0),
        description="noise of a marker along x, y and z over marker_noise: cameras read depth worse [1]",
        exclude_if=lambda axes: axes == (1.0, 1.0, 1.0),
    )
    marker_slow: SlowNoise = Field(
        SlowNoise(), description="of markers", exclude_if=lambda slow: not slow.share
    )
    accelerometer_slow: SlowNoise = Field(
        SlowNoise(), description="of accelerometers", exclude_if=lambda slow: not slow.share
    )

    @property
    def noise_by_axis(self):
        """Standard deviation of a marker's reading along x, y and z, float64 (3,) [m]."""
        return self.marker_noise * np.array(self.marker_axes)

    def not_noiseless(self):
        """These sensors with at least the noise of the best instruments: a stated 0 is taken as negligible noise."""
        return self.model_copy(
            update={name: max(getattr(self, name), least) for name, least in _LEAST_NOISE.items()}
        )


class Instruments(Sensors):
    """Sensors of a test; the defaults have noise and no other fault."""

    noise_memory: ProperFraction = Field(
        0.0, description="correlation of the noise of one reading with the next [1]"
    )
    marker_outliers: ProperFraction = Field(
        0.0, description="share of the marker readings that are wrong by ten times the noise [1]"
    )
    accelerometer_offset: NotNegative = Field(
        0.0, description="standard deviation of the channels' constant offsets [m/s2]"
    )
    marker_lag: Finite = Field(
        0.0, description="by which the optical clock is behind the accelerometers' [s]"
    )
    marker_drift: Vector = Field((0.0, 0.0, 0.0), description="of the optical system's frame [m/s]")
    marker_gain: dict[str, Finite] = Field({}, description="by marker: reading over displacement [1]")
    marker_offset: dict[str, Vector] = Field(
        {}, description="by marker: where it is less where it is said to be, body frame [m]"
    )
    marker_creep: dict[str, Vector] = Field({}, description="by marker: drift of its zero [m/s]")
    marker_range: dict[str, Positive] = Field({}, description="by marker: its largest reading [m]")
    channel_gain: dict[str, Finite] = Field({}, description="by accelerometer channel [1]")
    marker_dropouts: ProperFraction = Field(
        0.0, description="share of the marker readings that are lost, in bursts [1]"
    )


def observe(run, structure, instruments, seed):
    """Synthetic readings of a run.

    Parameters
    ----------
    run : xarray.Dataset
        A run file's content; with ``accelerometer`` and ``transducer_displacement`` these are read too.
    structure : Structure
        The run.
    instruments : Instruments
    seed : int
        Seed of noise, offsets and dropouts: each has a stream of its own, so that one fault more leaves the
        others' numbers as they are.

    Returns
    -------
    xarray.Dataset
        As in a campaign's test file; attribute ``synthetic`` is 1.

    Raises
    ------
    InputError
        A fault of a marker or channel that the structure lacks.

    Notes
    -----
    A marker that sits elsewhere than in the structure  reads the displacement of where it sits. A clock that is
    behind by the lag shows at the time t what was at t - lag; before the start everything rests.
    """
    noise, offsets, losses, wrong, slowly = (np.random.default_rng([seed, stream]) for stream in range(5))
    places = _places(run, structure, instruments)
    displacement = places - places[:1]
    names = [marker.name for marker in structure.file.markers]
    time = run["time"].to_numpy()
    channels = [str(name) for name in run["channel"].values] if "channel" in run.coords else []
    check_instruments(instruments, structure, channels)
    displacement = _delayed(displacement, time, instruments.marker_lag)
    displacement *= np.array([instruments.marker_gain.get(name, 1.0) for name in names])[:, None]
    creeps = [instruments.marker_creep.get(name, (0.0, 0.0, 0.0)) for name in names]
    displacement += (time - time[0])[:, None, None] * (np.array(instruments.marker_drift) + creeps)

    def noisy(times, shape, slow):
        return _noise((noise, slowly), times, shape, instruments.noise_memory, slow)

    read = displacement + noisy(time, displacement.shape, instruments.marker_slow) * instruments.noise_by_axis
    far = wrong.random(read.shape[:2]) < instruments.marker_outliers
    far[0] = False
    read[far] += wrong.normal(0.0, _OUTLIER * instruments.marker_noise, (far.sum(), 3))
    first = places[0] + read[0]
    read -= read[:1]
    for name, end in instruments.marker_range.items():
        np.clip(read[:, names.index(name)], -end, end, out=read[:, names.index(name)])
    read[_lost(losses, len(time), len(names), instruments.marker_dropouts)] = np.nan
    test = xr.Dataset(
        {
            "marker_displacement": (
                ("time", "marker", "axis"), read,
                {"units": "m", "long_name": "synthetic marker displacement since the first reading, inertial frame"},
            ),
            "marker_initial_position": (
                ("marker", "axis"), first, {"units": "m", "long_name": "synthetic first reading, inertial frame"},
            ),
        },
        {"time": ("time", time, {"units": "s"}), "marker": names, "axis": list(AXES)},
        {
            "Conventions": "CF-1.11",
            "title": "virtual test: synthetic, not measured",
            "synthetic": 1,
            "source": "one simulated run seen through its instruments",
            "history": history(run.attrs.get("history"), "generate-campaign: seen through instruments"),
        },
    )  # fmt: skip
    for name, dimension, sigma, slow in (
        ("accelerometer", "channel", instruments.accelerometer_noise, instruments.accelerometer_slow),
        ("transducer_displacement", "transducer", instruments.transducer_noise, SlowNoise()),
    ):
        if name not in run:
            continue
        values, sensors = run[name].to_numpy(), [str(sensor) for sensor in run[dimension].values]
        if name == "accelerometer":
            values = values * [instruments.channel_gain.get(channel, 1.0) for channel in sensors]
            values = values + offsets.normal(0.0, 1.0, len(sensors)) * instruments.accelerometer_offset
        values = values + noisy(run["time_acc"].to_numpy(), values.shape, slow) * sigma
        if name == "transducer_displacement":
            values = values - values[:1]
        test[name] = ("time_acc", dimension), values, dict(run[name].attrs)
        times = "time_acc", run["time_acc"].to_numpy(), {"units": "s"}
        test = test.assign_coords({"time_acc": times, dimension: sensors})
    return test


def _noise(generators, times, shape, memory, slow):
    """Gaussian noise of unit variance along the first axis: of a memory from reading to reading, and a slow part."""
    fast = _autoregressive(generators[0], shape, memory)
    if slow.share == 0.0:
        return fast
    step = (times[-1] - times[0]) / (len(times) - 1)
    slowly = _autoregressive(generators[1], shape, np.exp(-step / slow.memory))
    return np.sqrt(1.0 - slow.share) * fast + np.sqrt(slow.share) * slowly


def _autoregressive(generator, shape, memory):
    """Gaussian noise of unit variance, first-order autoregressive along the first axis."""
    white = generator.normal(0.0, 1.0, shape)
    if memory == 0.0:
        return white
    white[0] /= np.sqrt(1.0 - memory**2)
    return scipy.signal.lfilter([np.sqrt(1.0 - memory**2)], [1.0, -memory], white, axis=0)


def _places(run, structure, instruments):
    """Where the markers really are, (n_times, n_markers, 3), inertial frame [m]."""
    position = run["position"].transpose("time", "body", "axis").to_numpy()
    orientation = run["orientation"].transpose("time", "body", "quaternion").to_numpy()
    places = marker_position(structure, position, orientation)
    for index, marker in enumerate(structure.file.markers):
        if marker.name in instruments.marker_offset:
            body = structure.body_names.index(marker.body)
            turn = rotation_matrices(orientation[:, body])
            places[:, index] += turn @ np.array(instruments.marker_offset[marker.name])
    return places


def _delayed(displacement, time, lag):
    """Histories ``lag`` later; a cubic spline through the states, at rest before the first.

    Without a lag it gives the states themselves, to the bit, for one more knot after the last.
    """
    whole = np.isfinite(displacement).all(axis=(1, 2))
    known, states = time[whole], displacement[whole]
    spline = CubicSpline(np.append(known, 2.0 * known[-1] - known[-2]), np.concatenate([states, states[-1:]]))
    delayed = np.maximum(time - lag, known[0])
    shifted = np.full_like(displacement, np.nan)
    reached = delayed <= known[-1]
    shifted[reached] = spline(delayed[reached])
    return shifted


def _lost(generator, n_times, n_markers, share):
    """Readings lost, bool (n_times, n_markers): bursts of geometric length, never the first reading."""
    lost = np.zeros((n_times, n_markers), dtype=bool)
    if share == 0.0:
        return lost
    end, begin = 1.0 / _BURST, share / (1.0 - share) / _BURST
    chance = generator.random((n_times, n_markers))
    for row in range(1, n_times):
        lost[row] = np.where(lost[row - 1], chance[row] > end, chance[row] < begin)
    return lost


def check_instruments(instruments, structure, channels):
    """Refuse faults of markers that a structure lacks, and of other ``channels``, with `InputError`."""
    markers = [marker.name for marker in structure.file.markers]
    of_markers = ("marker_gain", "marker_offset", "marker_creep", "marker_range")
    for key, known in (*((key, markers) for key in of_markers), ("channel_gain", channels)):
        for name in getattr(instruments, key):
            if name not in known:
                wrong = f"expected one of {', '.join(known) or 'no channel'}"
                raise InputError("instruments", f"{key}.{name}", wrong)
