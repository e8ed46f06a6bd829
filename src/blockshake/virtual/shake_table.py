"""One test on the virtual shake table: the stack put in place, surveyed, shaken and read."""

import numpy as np
import scipy
from scipy.interpolate import CubicSpline

from blockshake.effects.effect import Experiment
from blockshake.effects.registry import with_effect
from blockshake.measurement.campaigns.initial_poses import placed
from blockshake.measurement.sensors.instruments import observe
from blockshake.measurement.sensors.markers import RATE
from blockshake.simulation.models import part_parameters
from blockshake.simulation.simulate import simulate


def shake(structure, parameters, effect, motion, settings, places, duration, seed, surveyed=None):
    """Readings of one test.

    Parameters
    ----------
    structure : Structure
    parameters : dict of str to float
        True ones.
    effect : dict or None
        From `hidden_effect`.
    motion : GroundMotion
        Commanded.
    settings : VirtualCampaign
    places : float64 array, shape (n_bodies, 3)
        Where the blocks stand off the structure file: along x and y [m], turned about z [rad].
    duration : float
        [s]
    seed : int
        Noise and survey.
    surveyed : Structure, optional
        The one that the survey knows, where the blocks stand on bodies that it does not.

    Returns
    -------
    test : xarray.Dataset
        As in a campaign's test file, with ``initial_offset`` and ``initial_rotation`` as surveyed.
    run : xarray.Dataset
        The simulated run behind the readings: the truth.
    """
    physical, numerics = part_parameters(parameters | settings.numerics)
    standing = structure.with_parameters(physical | placed(structure, places))
    experiment = followed(Experiment(standing, motion, settings.instruments), settings.table)
    if effect is not None:
        experiment = with_effect(experiment, **effect)
    # a clock that is ahead shows what comes after the end
    longer = max(duration - experiment.instruments.marker_lag, duration)
    run = simulate(
        experiment.structure, experiment.motion, settings.model, numerics,
        time_step=settings.time_step, duration=longer, output_rate=RATE,
    )  # fmt: skip
    test = observe(run, experiment.structure, experiment.instruments, seed)
    _add_survey(test, surveyed or structure, places, settings.survey_noise, seed)
    end = duration + 0.5 / RATE
    test = test.isel(time=test["time"].to_numpy() < end)
    if "time_acc" in test.coords:
        test = test.isel(time_acc=test["time_acc"].to_numpy() < end)
    return test, run


def followed(experiment, table):
    """The `Experiment` on a table that errs, by its `TableErrors`.

    Notes
    -----
    ``H(f) = gain + high i f / (f_c + i f)`` on the displacement along x: the gain goes over from one value to the other
    around the corner frequency, with the phase of a first-order filter. The pitch is that of the effect `table-pitch`.
    """
    breaks = experiment.motion.table.breaks
    times = np.linspace(breaks[0], breaks[-1], round(np.ptp(breaks) / np.diff(breaks).min()) + 1)
    command = experiment.motion.evaluate(times)[:, 0]
    command = command - command[0]
    omega = 2.0 * np.pi * table.corner
    _, slow, _ = scipy.signal.lsim(([omega], [1.0, omega]), command, times)
    change = np.interp(breaks, times, (table.gain - 1.0) * command + table.high * (command - slow))
    experiment = experiment.with_motion(0, CubicSpline(breaks, change).c[::-1].T)
    if table.pitch == 0.0:
        return experiment
    return with_effect(experiment, "table-pitch", {"coefficient": table.pitch}, {})


def _add_survey(test, structure, places, noise, seed):
    """Places as a survey finds them, on the free bodies; it turns nothing about x or y."""
    generator = np.random.default_rng([seed, 3])
    read = places + generator.normal(0.0, noise, places.shape)
    read = np.where(structure.driven[:, None], 0.0, read)
    zero = np.zeros(len(places))
    test.coords["body"] = structure.body_names
    test["initial_offset"] = (
        ("body", "axis"), np.column_stack([read[:, 0], read[:, 1], zero]),
        {"units": "m", "long_name": "surveyed place of the mass centre against the structure file"},
    )  # fmt: skip
    test["initial_rotation"] = (
        ("body", "axis"), np.column_stack([zero, zero, read[:, 2]]),
        {"units": "rad", "long_name": "surveyed rotation vector against the structure file"},
    )  # fmt: skip
