"""A test as it was commanded, and what sensors would have read of it, had a drawn model been true."""

from dataclasses import dataclass
from pathlib import Path

import numpy as np
import xarray as xr
from scipy.interpolate import CubicSpline
from scipy.ndimage import gaussian_filter1d

from blockshake.diagnosis.reading import HISTORIES, read_off
from blockshake.dynamics.motion import GroundMotion
from blockshake.effects.effect import Experiment
from blockshake.effects.registry import with_effect
from blockshake.files import content_digest, write_dataset
from blockshake.geometry.structure import load_structure
from blockshake.measurement.campaign import Sensors
from blockshake.measurement.instruments import Instruments, observe
from blockshake.study.placement import placed
from blockshake.study.simulation import part_parameters, simulate

RATE = 200.0  # Hz
_SLOW = 0.04  # s, standard deviation of a Gaussian that is some 0.1 s wide at half its height


@dataclass(frozen=True)
class PlannedTest:
    """All that simulations of a test depend on, and nothing that was measured in it but its length.

    Attributes
    ----------
    structure : str
        The campaign's, shipped name or file.
    motion : GroundMotion
        Commanded, scaled.
    duration : float
        [s]
    sensors : Sensors
        Whose noise is read.
    markers, channels : tuple of str
        That were read.
    """

    structure: str
    motion: GroundMotion
    duration: float
    sensors: Sensors
    markers: tuple[str, ...]
    channels: tuple[str, ...]

    def digest(self):
        """Of the content: equal for equal tests, whatever their files are called."""
        built = load_structure(self.structure)
        return content_digest(
            built.file.model_dump(mode="json"),
            *(solid.vertices.tobytes() for solid in built.solids.values()),
            *(part.tobytes() for part in self.motion.table),
            self.duration,
            self.sensors.model_dump(),
            self.markers,
            self.channels,
        )


def simulated_test(planned, draw, effects=()):
    """Readings of a planned test that a drawn model gives.

    Parameters
    ----------
    planned : PlannedTest
        The draw says how the table followed its motion.
    draw : Draw
    effects : sequence of dict
        ``name``, ``values`` and ``place`` of each effect that the model has too.

    Returns
    -------
    test : xarray.Dataset
        As in a campaign's test file, synthetic.
    status : str
        How the run ended.
    """
    physical, numerics = part_parameters(draw.parameters)
    readings = {name: value for name, value in draw.noise.items() if name != "louder"}
    instruments = Instruments(
        marker_noise=draw.noise["louder"] * planned.sensors.marker_noise,
        accelerometer_noise=draw.noise["louder"] * planned.sensors.accelerometer_noise,
        **readings,
    )
    experiment = Experiment(
        str(planned.structure), physical | placed(planned.structure, draw.places),
        planned.motion.scaled(draw.amplitude), instruments,
    )  # fmt: skip
    experiment = experiment.with_motion(0, draw.fast * faster_part(experiment.motion))
    for effect in effects:
        experiment = with_effect(experiment, **effect)
    run = simulate(
        experiment.structure, experiment.motion, draw.model, experiment.parameters | numerics,
        time_step=draw.time_step, duration=planned.duration, output_rate=RATE,
    )  # fmt: skip
    test = observe(run, experiment.load(), experiment.instruments, draw.seed).sel(
        marker=list(planned.markers)
    )
    if "accelerometer" in test:
        test = test.sel(channel=list(planned.channels)) if planned.channels else test.drop_dims("channel")
    return test, run.attrs["status"]


def faster_part(motion):
    """What of a motion's displacement along x is faster than its mean over some 0.1 s, as polynomials of its table."""
    breaks = motion.table.breaks
    step = float(np.median(np.diff(breaks)))
    times = np.arange(breaks[0], breaks[-1] + 0.5 * step, step)
    displacement = motion.evaluate(times)[:, 0]
    fast = displacement - gaussian_filter1d(displacement, _SLOW / step, mode="nearest")
    return CubicSpline(breaks, np.interp(breaks, times, fast)).c[::-1].T


def kept_reading(planned, draw, effects, store, source, histories=True):
    """Features and histories of a simulated test, from the store if it was simulated before.

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

    Returns
    -------
    reading : xarray.Dataset
        As from `read_off`, with ``status``.
    how : str
        ``kept`` or ``simulated``.
    """
    key = content_digest(
        source, planned.digest(), draw.model, draw.time_step, draw.parameters, draw.amplitude, draw.fast,
        draw.noise, draw.places.tobytes(), draw.seed, list(effects), histories,
    )  # fmt: skip
    path = Path(store) / f"{key}.nc"
    if path.exists():
        return xr.load_dataset(path), "kept"
    test, status = simulated_test(planned, draw, effects)
    reading = read_off(test, load_structure(planned.structure), planned.sensors).assign(status=status)
    if not histories:
        reading = reading.drop_vars([*HISTORIES, "acceleration", "phase"]).drop_vars(["time", "body"])
    write_dataset(path, reading)
    return reading, "simulated"
