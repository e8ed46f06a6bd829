"""Predictability of a test: spread of twin simulations that start apart by less than sensors resolve."""

import numpy as np
import xarray as xr

from blockshake.diagnosis.libraries.designed_test import simulated_test
from blockshake.diagnosis.libraries.null_model import MODELS, draw_nominal
from blockshake.geometry.rotations import rotation_matrices
from blockshake.measurement.motion.compared_curves import histories_at
from blockshake.measurement.motion.joint_coordinates import joint_coordinates
from blockshake.measurement.motion.joint_histories import joint_histories
from blockshake.measurement.motion.reconstructed_base import reconstruct_base
from blockshake.simulation.models import part_parameters
from blockshake.simulation.placement import placed
from blockshake.simulation.simulate import simulate

QUANTITIES = ("slip", "rotation")
_PLACED = 2e-4  # m, standard deviation of where a twin's block stands, along x and y
_TURNED = 1e-4  # rad, of how it is turned about z
_INPUT_SPREAD = 1e-3  # of the amplitude: how well a measured base motion is known
_TOLD_APART_BY = 3.0  # standard deviations of a reading that twins must be apart to be told apart
_SHARE_OF_NOMINAL = 0.3  # of the nominal ensemble's standard deviation
_FOLDS = 4.0  # e-foldings before the horizon over which the rate is taken


def twins(planned, model, n_twins, progress):
    """Joint coordinates of nominal draw 0 of a planned test and of its twins, as they are, without noise.

    Parameters
    ----------
    planned : PlannedTest
    model : str
        One of `null_model.MODELS`.
    n_twins : int
        Beside draw 0. Blocks of each stand 0.2 mm and 0.1 mrad elsewhere and the base moves 0.1 % differently
        (standard deviations); the first also has half the time step.
    progress : callable
        Called with a line of text after each.

    Returns
    -------
    xarray.Dataset
        ``slip`` [m] along x and ``rotation`` [rad] about y ``(twin, time, joint)``; twin 0 is draw 0; NaN after a
        run that ended early.
    """
    structure = planned.structure
    free = ~structure.driven
    draw = draw_nominal(structure, model, 0)
    physical, numerics = part_parameters(draw.parameters)
    parts = []
    for twin in range(n_twins + 1):
        places, amplitude = draw.places.copy(), draw.amplitude
        if twin:
            generator = np.random.default_rng([twin, *model.encode()])
            places[free] += generator.normal(0.0, [_PLACED, _PLACED, _TURNED], (free.sum(), 3))
            amplitude *= 1.0 + generator.normal(0.0, _INPUT_SPREAD)
        run = simulate(
            structure, planned.driving.scaled(amplitude), model,
            physical | placed(structure, places) | numerics,
            time_step=draw.time_step / (2.0 if twin == 1 else 1.0), duration=planned.duration,
            output_rate=planned.clock.rate, accelerometers=False,
        )  # fmt: skip
        progress(f"{planned.motion.name} {model} twin {twin}/{n_twins}: {run.attrs['status']}")
        moved = joint_coordinates(
            structure, run["position"].to_numpy(), rotation_matrices(run["orientation"].to_numpy())
        )
        parts.append(
            xr.Dataset(
                {
                    "slip": moved["slip"].sel(tangent="x", drop=True),
                    "rotation": moved["rotation"].sel(axis="y", drop=True),
                }
            ).assign_coords(time=run["time"].to_numpy())
        )
    return xr.concat(parts, dim="twin").assign_coords(twin=np.arange(n_twins + 1))


def reading_noise(planned, model):
    """Standard deviations of a reading of ``slip`` [m] and ``rotation`` [rad] ``(joint)`` in a planned test."""
    structure = planned.structure
    test, _ = simulated_test(planned, draw_nominal(structure, model, 0))
    histories = joint_histories(
        test, structure, planned.sensors, reconstruct_base(test, structure, planned.sensors)
    )
    return xr.Dataset(
        {
            "slip": histories["slip_noise"].sel(tangent="x", drop=True),
            "rotation": histories["rotation_noise"].sel(axis="y", drop=True),
        }
    )


def predictability(moved, noise, nominal):
    """Spread of twins in time, how fast it grows, and when a test is no longer predictable.

    Parameters
    ----------
    moved : xarray.Dataset
        From `twins`.
    noise : xarray.Dataset
        From `reading_noise`.
    nominal : xarray.Dataset
        ``slip`` and ``rotation(draw, time, joint)`` of the nominal draws, such as the histories of `library`.

    Returns
    -------
    xarray.Dataset
        ``spread`` and ``limit(quantity, time, joint)`` [m or rad]; ``coordinate_horizon(quantity, joint)`` [s], the
        first time at which the spread is above the limit, or the end; ``rate(quantity, joint)`` [1/s]; and
        ``horizon``, the earliest [s].

    Notes
    -----
    Spread is the standard deviation over the twins. The limit is three standard deviations of a reading or 0.3 of the
    nominal draws' standard deviation at that time, whichever is larger: within it the twins cannot be told
    apart, or what is not known of the parameters matters more. The rate is the slope of the spread's
    logarithm over the last four e-foldings before the horizon, or before the largest spread where there is no horizon;
    NaN where the spread has not grown by one e-folding.
    """
    time = moved["time"].to_numpy()
    spread = xr.concat([moved[name].std("twin", ddof=1, skipna=False) for name in QUANTITIES], dim="quantity")
    nominal = histories_at(nominal[list(QUANTITIES)], time)
    scatter = xr.concat([nominal[name].std("draw", ddof=1) for name in QUANTITIES], dim="quantity")
    reading = xr.concat([noise[name] for name in QUANTITIES], dim="quantity")
    limit = xr.where(
        _SHARE_OF_NOMINAL * scatter > _TOLD_APART_BY * reading,
        _SHARE_OF_NOMINAL * scatter,
        _TOLD_APART_BY * reading,
    )
    spread, limit = (
        part.transpose("quantity", "time", "joint").drop_vars("draw", errors="ignore")
        for part in (spread, limit)
    )
    shape = (len(QUANTITIES), spread.sizes["joint"])
    horizons, rates = np.empty(shape), np.empty(shape)
    for place in np.ndindex(shape):
        own = spread.to_numpy()[place[0], :, place[1]]
        beyond = own > limit.to_numpy()[place[0], :, place[1]]
        # twins of which one has fallen are told apart
        beyond |= ~np.isfinite(own)
        horizons[place] = time[np.argmax(beyond)] if beyond.any() else time[-1]
        rates[place] = _growth(time, own, int(np.argmax(beyond)) if beyond.any() else None)
    return xr.Dataset(
        {
            "spread": (("quantity", "time", "joint"), spread.to_numpy()),
            "limit": (("quantity", "time", "joint"), limit.to_numpy()),
            "coordinate_horizon": (("quantity", "joint"), horizons, {"units": "s"}),
            "rate": (("quantity", "joint"), rates, {"units": "s-1"}),
            "horizon": ((), horizons.min(), {"units": "s"}),
        },
        {
            "quantity": list(QUANTITIES),
            "time": ("time", time, {"units": "s"}),
            "joint": moved["joint"].to_numpy(),
        },
    )


def predictability_of(planned, n_twins, nominal, progress):
    """`predictability` by every solver, along ``model``.

    Parameters
    ----------
    planned : PlannedTest
    n_twins : int
    nominal : dict of str to xarray.Dataset
        By solver: histories of its nominal draws, as from `library`.
    progress : callable

    Returns
    -------
    xarray.Dataset
    """
    parts = [
        predictability(
            twins(planned, model, n_twins, progress), reading_noise(planned, model), nominal[model]
        )
        for model in MODELS
    ]
    return xr.concat(parts, dim="model").assign_coords(model=list(MODELS))


def _growth(time, spread, end):
    """Slope of ln(spread) over the last `_FOLDS` e-foldings before a reading [1/s]."""
    end = int(np.nanargmax(spread)) if end is None else end
    if not np.isfinite(spread[end]) or spread[end] <= 0.0:
        return np.nan
    below = np.flatnonzero(spread[:end] < spread[end] * np.exp(-_FOLDS))
    begin = int(below[-1]) + 1 if len(below) else 0
    part = slice(begin, end + 1)
    grown = spread[part] > 0.0
    if grown.sum() < 3 or np.log(spread[end] / spread[part][grown][0]) < 1.0:
        return np.nan
    return float(np.polyfit(time[part][grown], np.log(spread[part][grown]), 1)[0])
