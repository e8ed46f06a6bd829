"""A ground motion as a Dataset to draw and tabulate: histories, response spectrum, figures."""

from pathlib import Path

import numpy as np
import xarray as xr

from blockshake.dynamics.intensity import DAMPING, motion_figures, response_spectrum
from blockshake.dynamics.load_motion import load_motion, plain_attributes
from blockshake.dynamics.record_choice import mean_and_scatter
from blockshake.dynamics.record_set import DrawnMotions, is_record_set
from blockshake.dynamics.synthetic_motion import load_synthetic, target_acceleration
from blockshake.files import named_file

_RATE = 200.0  # Hz, of the histories
_PERIODS = np.geomspace(0.04, 4.0, 120)  # s


def describe_motions(source, baseline, intensity=None):
    """`describe_motion` of a motion, or of the record of median peak acceleration of a set, as published.

    Parameters
    ----------
    source : str or path
        As `read_records` takes it.
    baseline : str or float
        As for `load_motion`.
    intensity : dict, optional
        That of a case: with a ``spectrum`` the records are those chosen to it, each with its scale.

    Returns
    -------
    xarray.Dataset
        A set of records also has ``spectra(record, period)`` [m/s2]; attributes ``records``, their number, and
        ``significant_end``, the latest [s]; ``synthetic`` where any is. Chosen ones have ``chosen`` and ``aim(bound,
        aimed_period)``:
        median and this less and plus a standard deviation, of the records and of the target [m/s2].
    """
    wanted = {"motion": source, "baseline": baseline, "scale": 1.0, "intensity": intensity}
    drawn = DrawnMotions.of(
        wanted if intensity and intensity.get("spectrum") else {**wanted, "intensity": None}
    )
    target, records = drawn.intensity.spectrum, drawn.records
    motions = [load_motion(record.path, baseline=baseline) for record in records]
    if target is not None:
        motions = [drawn.motion(record) for record in records]
    figures = [motion_figures(motion) for motion in motions]
    order = np.argsort([one["peak_acceleration"] for one in figures], kind="stable")
    middle = order[(len(order) - 1) // 2]
    described = describe_motion(motions[middle], named_file("motions", records[middle].path))
    if not is_record_set(source):
        return described
    spectra = np.array([response_spectrum(motion, _PERIODS) for motion in motions])
    described["spectra"] = ("record", "period"), spectra, described["pseudo_acceleration"].attrs
    if target is not None:
        mean, scatter = mean_and_scatter(target, motions)
        aimed = np.zeros(len(target.periods)), np.array(target.deviation or np.zeros(len(target.periods)))
        for name, (middle_of, width) in {"chosen": (mean, scatter), "aim": aimed}.items():
            bounds = np.exp(np.array([middle_of - width, middle_of, middle_of + width])) * target.median
            described[name] = ("bound", "aimed_period"), bounds, described["pseudo_acceleration"].attrs
        described = described.assign_coords(aimed_period=np.array(target.periods))
    return described.assign_coords(record=[record.name for record in records]).assign_attrs(
        name=f"{Path(source).stem}, {records[middle].name}",
        records=len(records),
        significant_end=max(one["significant_end"] for one in figures),
        synthetic=int(any(motion.attributes.get("synthetic") for motion in motions)),
    )


def describe_motion(motion, definition):
    """Histories along x, 5 % damped spectrum and intensity figures of a motion.

    Parameters
    ----------
    motion : GroundMotion
        Not scaled.
    definition : str or path
        Its file; a synthetic motion's YAML tells the target of its spectrum.

    Returns
    -------
    xarray.Dataset
        ``acceleration``, ``velocity``, ``displacement(time)`` [m/s2, m/s, m]; ``pseudo_acceleration(period)`` [m/s2]
        and, for a synthetic motion, ``target(ordinate)`` at ``target_period`` with ``published`` (1 where an ordinate
        is published). Attributes: the motion's own and its figures.
    """
    time = np.arange(int(np.floor(motion.duration * _RATE + 1e-9)) + 1) / _RATE
    described = xr.Dataset(
        {
            name: (
                "time",
                motion.evaluate(time, derivative)[:, 0],
                {"units": units, "long_name": f"ground {name} along x"},
            )
            for name, derivative, units in (
                ("acceleration", 2, "m s-2"),
                ("velocity", 1, "m s-1"),
                ("displacement", 0, "m"),
            )
        },
        coords={"time": ("time", time, {"units": "s"}), "period": ("period", _PERIODS, {"units": "s"})},
    )
    described["pseudo_acceleration"] = (
        "period",
        response_spectrum(motion, _PERIODS),
        {"units": "m s-2", "long_name": f"pseudo-acceleration at {DAMPING:.0%} damping"},
    )
    if motion.attributes.get("synthetic") and Path(definition).suffix != ".csv":
        _add_target(described, load_synthetic(definition))
    described.attrs = {
        "Conventions": "CF-1.11",
        "title": f"ground motion {motion.name}",
        "name": motion.name,
        **plain_attributes(motion.attributes),
        **motion_figures(motion),
    }
    return described


def _add_target(described, parameters):
    ordinates = parameters.target_spectrum
    periods = np.array([ordinate.period for ordinate in ordinates])
    described["target"] = (
        "ordinate",
        target_acceleration(parameters, periods),
        {"units": "m s-2", "long_name": "pseudo-acceleration that the synthesis aims at"},
    )
    described["target_period"] = ("ordinate", periods, {"units": "s"})
    described["published"] = ("ordinate", np.array([int(ordinate.published) for ordinate in ordinates]))
