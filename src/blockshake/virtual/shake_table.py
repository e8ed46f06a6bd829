"""One test on the virtual shake table: the stack put in place, surveyed, shaken and read."""

import numpy as np

from blockshake.dynamics.motion import ground_motion
from blockshake.effects.effect import Experiment
from blockshake.effects.registry import with_effect
from blockshake.measurement.sensors.instruments import observe
from blockshake.measurement.sensors.markers import RATE
from blockshake.simulation.models import part_parameters
from blockshake.simulation.simulate import placed, simulate
from blockshake.virtual.table import followed

_SINE_ROWS = 1000  # a second


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
        Of noise and survey.
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


def swelling_sine(sine):
    """Ground motion of a low-amplitude test: a sine along x that swells, stays and fades, ending at rest.

    Notes
    -----
    The displacement is given, so that the table ends where it started.
    """
    time = np.arange(round(sine.duration * _SINE_ROWS) + 1) / _SINE_ROWS
    omega = 2.0 * np.pi * sine.frequency
    swell = np.clip(np.minimum(time, time[-1] - time) / (0.2 * sine.duration), 0.0, 1.0)
    displacement = -sine.acceleration / omega**2 * np.sin(omega * time) * swell**2 * (3.0 - 2.0 * swell)
    return ground_motion("sine", time, {"x": displacement}, "displacement", {"synthetic": True})


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
