"""Synthetic readings that one sampled model gives for a commanded test."""

from dataclasses import dataclass
from pathlib import Path
from typing import NamedTuple

import numpy as np
import xarray as xr
from scipy.interpolate import CubicSpline
from scipy.ndimage import gaussian_filter1d

from blockshake.diagnosis.features.reading import HISTORIES, read_off
from blockshake.dynamics.motion import GroundMotion
from blockshake.effects.effect import Experiment
from blockshake.effects.registry import with_effect
from blockshake.files import content_digest
from blockshake.geometry.structure import Structure
from blockshake.measurement.campaigns.campaign import Sensors
from blockshake.measurement.campaigns.command_clock import since
from blockshake.measurement.motion.compared_curves import histories_at
from blockshake.measurement.sensors import accelerometers
from blockshake.measurement.sensors.instruments import Instruments, observe
from blockshake.measurement.sensors.markers import RATE
from blockshake.simulation.models import part_parameters
from blockshake.simulation.placement import placed
from blockshake.simulation.simulate import simulate
from blockshake.simulation.structure_digest import structure_digest
from blockshake.store import keep_dataset, kept, load_made

_SLOW = 0.04  # s, standard deviation of a Gaussian that is some 0.1 s wide at half its height


class Clock(NamedTuple):
    """Times at which a test was read, counted from `simulation_start`.

    ``late``: start of the command, less than a step [s]; ``rate`` and ``rate_acc`` of markers and accelerometers [Hz];
    ``first``: the first reading, where the record begins after the command [s].
    """

    late: float = 0.0
    rate: float = RATE
    rate_acc: float = accelerometers.RATE
    first: float = 0.0


_SIMULATED = Clock()


@dataclass(frozen=True)
class PlannedTest:
    """A commanded test: all that its simulations depend on. Of the readings only their times enter.

    Attributes
    ----------
    structure : Structure
        The campaign's.
    motion : GroundMotion
        Commanded, scaled.
    duration : float
        [s]
    sensors : Sensors
        Whose noise is read.
    markers, channels : tuple of str
        That were read.
    unread : tuple of (str, str)
        Marker and axis of the directions that were not measured.
    clock : Clock
    """

    structure: Structure
    motion: GroundMotion
    duration: float
    sensors: Sensors
    markers: tuple[str, ...]
    channels: tuple[str, ...]
    unread: tuple[tuple[str, str], ...] = ()
    clock: Clock = _SIMULATED

    @property
    def driving(self):
        """The commanded motion on the clock of the readings."""
        return self.motion.delayed(self.clock.late)

    def digest(self):
        """Of the content: equal for equal tests, whatever their files are called."""
        return content_digest(
            structure_digest(self.structure),
            *(part.tobytes() for part in self.motion.table),
            self.duration,
            self.sensors.model_dump(),
            self.markers,
            self.channels,
            self.unread,
            self.clock,
        )


class SimulatedTest(NamedTuple):
    """Synthetic readings as in a campaign's test file, and the outcome of the run."""

    test: xr.Dataset
    status: str


class KeptReading(NamedTuple):
    """Reading as from `read_off`, with ``status``; ``how`` is ``kept`` or ``simulated``."""

    reading: xr.Dataset
    how: str


def simulated_test(planned, draw, effects=()):
    """`SimulatedTest`: synthetic readings that a sampled model gives for a planned test.

    Parameters
    ----------
    planned : PlannedTest
        The draw says how the table followed its motion.
    draw : Draw
    effects : sequence of dict
        ``name``, ``values`` and ``place`` of each effect that the model has too.
    """
    physical, numerics = part_parameters(draw.parameters)
    readings = {name: value for name, value in draw.noise.items() if name != "louder"}
    instruments = Instruments(
        marker_noise=draw.noise["louder"] * planned.sensors.marker_noise,
        accelerometer_noise=draw.noise["louder"] * planned.sensors.accelerometer_noise,
        **readings,
    )
    structure = planned.structure.with_parameters(physical | placed(planned.structure, draw.places))
    experiment = Experiment(structure, planned.driving.scaled(draw.amplitude), instruments)
    experiment = experiment.with_motion(0, draw.fast * faster_part(experiment.motion))
    for effect in effects:
        experiment = with_effect(experiment, **effect)
    run = simulate(
        experiment.structure, experiment.motion, draw.model, numerics,
        time_step=draw.time_step, duration=planned.duration, output_rate=planned.clock.rate,
    )  # fmt: skip
    rate = planned.clock.rate_acc
    if "time_acc" in run.coords and rate != accelerometers.RATE:
        count = int(float(run["time_acc"][-1]) * rate)
        run = histories_at(run, np.arange(count + 1) / rate, "time_acc")
    test = observe(run, experiment.structure, experiment.instruments, draw.seed).sel(
        marker=list(planned.markers)
    )
    for marker, axis in planned.unread:
        test["marker_displacement"].loc[{"marker": marker, "axis": axis}] = np.nan
    if "accelerometer" in test:
        test = test.sel(channel=list(planned.channels)) if planned.channels else test.drop_dims("channel")
    if planned.clock.first > 0.0:
        test = since(test, 0.0, planned.clock.first)
        moved = test["marker_displacement"].transpose("time", "marker", "axis")
        first = np.isfinite(moved.to_numpy()).argmax(axis=0)
        test["marker_displacement"] = moved - np.take_along_axis(moved.to_numpy(), first[None], axis=0)[0]
    return SimulatedTest(test, run.attrs["status"])


def faster_part(motion):
    """Fast part of a motion's displacement along x, less its running mean over about 0.1 s, as polynomials."""
    breaks = motion.table.breaks
    step = float(np.median(np.diff(breaks)))
    times = np.arange(breaks[0], breaks[-1] + 0.5 * step, step)
    displacement = motion.evaluate(times)[:, 0]
    fast = displacement - gaussian_filter1d(displacement, _SLOW / step, mode="nearest")
    return CubicSpline(breaks, np.interp(breaks, times, fast)).c[::-1].T


def kept_reading(planned, draw, effects, store, source, histories=True):
    """`KeptReading` of a simulated test: features and histories, from the store if it was simulated before.

    Parameters
    ----------
    planned : PlannedTest
    draw : Draw
    effects : sequence of dict
        As of `simulated_test`.
    store : str or path
        Folder of finished tests: one that is there is not simulated again.
    source : str
        Digest of the sources that compute.
    histories : bool
        Whether they are kept too.
    """
    key = content_digest(
        source, planned.digest(), draw.model, draw.time_step, draw.parameters, draw.amplitude, draw.fast,
        draw.noise, draw.places.tobytes(), draw.seed, list(effects), histories,
    )  # fmt: skip
    path = Path(store) / f"{key}.nc"
    if kept(path):
        return KeptReading(load_made(path), "kept")
    test, status = simulated_test(planned, draw, effects)
    reading = read_off(test, planned.structure, planned.sensors, laws=histories).assign(status=status)
    if not histories:
        reading = reading.drop_vars([*HISTORIES, "acceleration", "phase"]).drop_vars(["time", "body"])
    keep_dataset(path, reading)
    return KeptReading(reading, "simulated")
