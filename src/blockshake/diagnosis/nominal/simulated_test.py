"""Synthetic readings that one sampled model gives for a planned test, and the histories that they show."""

from dataclasses import dataclass
from typing import Any

import numpy as np
from scipy.interpolate import CubicSpline
from scipy.ndimage import gaussian_filter1d

from blockshake.diagnosis.nominal.histories import read_histories
from blockshake.diagnosis.nominal.nominal_model import Draw
from blockshake.diagnosis.nominal.planned_test import PlannedTest
from blockshake.effects.effect import Experiment
from blockshake.measurement.campaigns.clocks import since
from blockshake.measurement.campaigns.initial_poses import placed
from blockshake.measurement.sensors.instruments import Instruments, observe
from blockshake.simulation.models import part_parameters
from blockshake.simulation.simulate import simulate
from blockshake.store import Unit, load_made

_SLOW = 0.04  # s, standard deviation of a Gaussian that is some 0.1 s wide at half its height


def simulated_test(planned, draw, extension=None, accelerometers=False):
    """Synthetic readings that a sampled model gives for a planned test, as in a campaign's test file.

    Parameters
    ----------
    planned : PlannedTest
        The draw states how the table followed its motion.
    draw : Draw
    extension : callable, optional
        Of an `Experiment`: the experiment with what the extended model has against the nominal one.
    accelerometers : bool
        Whether they are read too.

    Returns
    -------
    xarray.Dataset
        With the run's ``status`` as an attribute.
    """
    physical, numerics = part_parameters(draw.parameters)
    readings = {name: value for name, value in draw.noise.items() if name != "louder"}
    louder = {
        name: draw.noise["louder"] * getattr(planned.sensors, name)
        for name in ("marker_noise", "accelerometer_noise")
    }
    instruments = Instruments(**{**dict(planned.sensors), **louder, **readings})
    structure = planned.structure.with_parameters(physical | placed(planned.structure, draw.places))
    experiment = Experiment(structure, planned.driving.scaled(draw.amplitude), instruments)
    experiment = experiment.with_motion(0, draw.fast * faster_part(experiment.motion))
    if extension is not None:
        experiment = extension(experiment)
    run = simulate(
        experiment.structure, experiment.motion, draw.model, numerics,
        time_step=draw.time_step, duration=planned.duration, output_rate=planned.clock.rate,
        accelerometers=accelerometers,
    )  # fmt: skip
    test = observe(run, experiment.structure, experiment.instruments, draw.seed).sel(
        marker=list(planned.markers)
    )
    for marker, axis in planned.unread:
        test["marker_displacement"].loc[{"marker": marker, "axis": axis}] = np.nan
    if planned.clock.first > 0.0:
        test = since(test, 0.0, planned.clock.first)
        moved = test["marker_displacement"].transpose("time", "marker", "axis")
        first = np.isfinite(moved.to_numpy()).argmax(axis=0)
        test["marker_displacement"] = moved - np.take_along_axis(moved.to_numpy(), first[None], axis=0)[0]
    return test.assign_attrs(status=run.attrs["status"])


def faster_part(motion):
    """Fast part of a motion's displacement along x, less its running mean over about 0.1 s, as polynomials."""
    breaks = motion.table.breaks
    step = float(np.median(np.diff(breaks)))
    times = np.arange(breaks[0], breaks[-1] + 0.5 * step, step)
    displacement = motion.evaluate(times)[:, 0]
    fast = displacement - gaussian_filter1d(displacement, _SLOW / step, mode="nearest")
    return CubicSpline(breaks, np.interp(breaks, times, fast)).c[::-1].T


def simulated_histories(words, planned, draw, store, extension=None):
    """Histories of a simulated test as from `read_histories`, simulated where the store has not got them.

    Parameters
    ----------
    words : str
        Which test by which model it is.
    planned : PlannedTest
    draw : Draw
    store : Store
    extension : callable, optional
        As of `simulated_test`, with an attribute ``digest`` of all that it does.

    Returns
    -------
    xarray.Dataset
        With the run's ``status`` as an attribute.
    """

    return load_made(store.dataset(words, _Histories(planned, draw, extension)))


@dataclass(frozen=True)
class _Histories(Unit):
    """Histories of one simulated test."""

    planned: PlannedTest
    draw: Draw
    extension: Any

    def made(self, checkpoint):
        test = simulated_test(self.planned, self.draw, self.extension)
        read = read_histories(test, self.planned.structure, self.planned.sensors)
        return read.assign_attrs(status=test.attrs["status"])
