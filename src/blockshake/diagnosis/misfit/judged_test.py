"""A measured test against ensembles that predict it, cell by cell, as long as each cell can be predicted."""

from dataclasses import dataclass

import numpy as np
import xarray as xr

from blockshake.diagnosis.nominal.ensemble import NOMINAL, TWIN, runs_of
from blockshake.diagnosis.nominal.histories import as_cells, at_readings, common_times, read_histories
from blockshake.geometry.structure import load_structure
from blockshake.measurement.campaigns.initial_poses import initial_poses
from blockshake.parity.correction import load_corrected_test
from blockshake.statistics.intervals import sample_quantiles

BAND = (0.05, 0.5, 0.95)
_MOVES = 5.0  # standard deviations of a reading, beyond which a cell moves
_OFTEN = 0.99  # of the time that a cell is nearer
_ENDED = 0.5  # share of an ensemble's members that have ended, from which on a test is not judged
_PARTED_BY = 3.0  # standard deviations of a reading that twins must be apart to be distinguished
_SHARE_OF_MOTION = 0.3  # of the farthest that a cell has moved until then


@dataclass(frozen=True)
class JudgedTest:
    """One test."""

    name: str
    measured: xr.DataArray  # xarray.DataArray, (time, cell); cells of `as_cells`
    # str to xarray.DataArray, (run, time, cell); by kind, at the measured times: the members of all solvers,
    # one solver after the other
    members: dict
    models: np.ndarray  # str array, shape (n_members,); solver of each
    # float64 (n_cells,); until which the cells are judged [s], by the solver that can be predicted for the
    # shortest time; of a test in which half the members of an ensemble fall, until then. Minus infinity of a
    # cell in which nothing moves
    horizon: np.ndarray

    @property
    def judged(self):
        """Times and cells that are judged, bool (n_times, n_cells)."""
        return self.measured["time"].to_numpy()[:, None] <= self.horizon

    def until_horizon(self, values):
        """Values (..., n_times, n_cells) with NaN beyond the horizon."""
        return np.where(self.judged, values, np.nan)

    def bands(self):
        """Quantiles of the ensembles against what was measured, and the horizon.

        Returns
        -------
        xarray.Dataset
            ``band(kind, quantile, time, cell)``, ``measured(time, cell)`` and ``horizon(cell)``, in single precision.
        """
        rows = [sample_quantiles(one.to_numpy(), BAND) for one in self.members.values()]
        band = self.measured.expand_dims(kind=list(self.members), quantile=list(BAND)).copy(data=rows)
        return xr.Dataset(
            {
                "band": band.astype(np.float32),
                "measured": self.measured.astype(np.float32),
                "horizon": ("cell", self.horizon, {"units": "s"}),
            }
        )


def judged_test(name, histories, ensembles, kinds=(NOMINAL,)):
    """`JudgedTest` of a measured test.

    Parameters
    ----------
    name : str
    histories : xarray.Dataset
        From `read_histories`, measured.
    ensembles : list of xarray.Dataset
        One a solver, from `simulate_members`: runs of this test alone, of all kinds, and twins.
    kinds : sequence of str
    """
    measured = as_cells(histories)
    by_solver = [
        [as_cells(runs_of(ensemble, kind=kind)) for kind in (*kinds, TWIN)] for ensemble in ensembles
    ]
    everywhere = [cells for by_kind in by_solver for cells in by_kind]
    names = [
        cell for cell in measured["cell"].values if all(cell in cells["cell"].values for cells in everywhere)
    ]
    time = common_times(measured, *everywhere)
    measured = measured.sel(cell=names, time=time)
    noise = as_cells(histories, "_noise").sel(cell=names)
    limits = [horizons(by_kind[-1].sel(cell=names), noise) for by_kind in by_solver]
    members = {
        kind: xr.concat(
            [at_readings(by_kind[index].sel(cell=names), time) for by_kind in by_solver], dim="run"
        )
        for index, kind in enumerate(kinds)
    }
    models = np.concatenate(
        [
            [ensemble.attrs["model"]] * by_kind[0].sizes["run"]
            for ensemble, by_kind in zip(ensembles, by_solver, strict=True)
        ]
    )
    horizon = np.minimum(np.min(limits, axis=0), min(_last_standing(cells) for cells in members.values()))
    moves = (
        np.max([_moved(cells) for cells in (measured, *members.values())], axis=0) > _MOVES * noise.to_numpy()
    )
    horizon = np.where(moves, horizon, -np.inf)
    return JudgedTest(name, measured, members, models, horizon)


def _moved(cells):
    """How far a cell is away for a hundredth of the time, of several runs the median, (n_cells,)."""
    away = sample_quantiles(np.abs(cells.transpose("time", ...).to_numpy()), (_OFTEN,))[0]
    return away if away.ndim == 1 else np.median(away, axis=0)


def _last_standing(cells):
    """Last time at which more than half the members of an ensemble have not ended [s]."""
    known = np.isfinite(cells.to_numpy()).any(axis=2)
    going = np.logical_or.accumulate(known[:, ::-1], axis=1)[:, ::-1]
    running = np.flatnonzero(going.mean(axis=0) > _ENDED)
    return cells["time"].to_numpy()[running[-1]] if len(running) else -np.inf


def horizons(twins, noise):
    """Time until which each cell of a test can be predicted.

    Parameters
    ----------
    twins : xarray.DataArray, (run, time, cell)
        Cells of nominal draw 0 and of its twins, from `as_cells`; all with the same noise of the sensors.
    noise : xarray.DataArray, (cell,)
        Standard deviation of a reading.

    Returns
    -------
    float64 array, shape (n_cells,)
        [s]; the end of the twins where they stay together.

    Notes
    -----
    The horizon is the first time at which the standard deviation over the twins is above three standard deviations of
    a reading, so that they can be distinguished, and above 0.3 of the farthest that draw 0 has moved until then, so
    that it matters. Twins of which one has ended are distinguished.
    """
    time, values = twins["time"].to_numpy(), twins.transpose("run", "time", "cell").to_numpy()
    moved = np.maximum.accumulate(np.nan_to_num(np.abs(values[0])), axis=0)
    limit = np.maximum(_SHARE_OF_MOTION * moved, _PARTED_BY * noise.to_numpy())
    known = np.isfinite(values)
    started, going = np.logical_or.accumulate(known, axis=1), known[:, ::-1]
    going = np.logical_or.accumulate(going, axis=1)[:, ::-1]
    parted = (started & ~going).any(axis=0)
    whole = known.all(axis=0)
    spread = np.where(whole, values, 0.0).std(axis=0, ddof=1)
    parted |= whole & (spread > limit)
    return np.where(parted.any(axis=0), time[parted.argmax(axis=0)], time[-1])


def measured_histories(campaign, names, findings):
    """Histories of tests by name, from `read_histories`.

    Parameters
    ----------
    campaign : Campaign
    names : iterable of str
        A sealed test is read only where the gain is measured.
    findings : sequence of Finding
        Sensor faults that are taken out first.
    """
    structure = load_structure(campaign.structure)
    tests = {name: load_corrected_test(campaign, name, structure, findings) for name in names}
    return {
        name: read_histories(test, initial_poses(structure, test), campaign.sensors)
        for name, test in tests.items()
    }
