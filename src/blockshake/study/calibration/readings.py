"""Readings of the instruments of an open test, of the specimen and of every sample alike: curves and spectra."""

from dataclasses import dataclass
from typing import NamedTuple

import numpy as np
import pandas as pd
import scipy
import xarray as xr

from blockshake.dynamics.motion import GroundMotion
from blockshake.dynamics.system import FINISHED, Status
from blockshake.files import content_digest, shipped_names
from blockshake.geometry.structure import Structure, load_structure
from blockshake.measurement.campaigns.campaign import load_campaign
from blockshake.measurement.motion.compared_curves import curves_along_x
from blockshake.measurement.sensors.accelerometers import CUTOFF, whole_channels
from blockshake.measurement.sensors.instruments import Instruments, observe
from blockshake.measurement.sensors.markers import driven_marker
from blockshake.simulation.models import solver_of
from blockshake.simulation.simulate import simulate
from blockshake.store import Unit, load_made
from blockshake.study.ensembles.batch import CALIBRATION, part_name
from blockshake.study.ensembles.case_input import (
    MEASURED,
    check_known,
    driving_motions,
    measured_input,
    measured_on_clock,
    structure_of_case,
)
from blockshake.study.sampling.sample_parameters import used_parameters

_SEGMENT = 1.0  # s, of the spectra: lines 1 Hz apart
# of the step of a run that does not converge: joints of a concave face or of many blocks ask for less
_HALVINGS = 3
_DECIMALS = {"m": 7, "1": 5}  # a thousandth of the markers' noise; of a logarithm


class OpenTest(NamedTuple):
    """An open test of a case's campaign, as the models are driven and read in it."""

    name: str
    # ``structure``, ``motion``, ``scale``, ``baseline``, ``duration`` [s] and ``input``, the measured one, as
    # `driving_motions` takes them
    case: dict
    base: xr.Dataset  # xarray.Dataset; from `measured_input`
    # xarray.Dataset; readings, time 0 where the input starts; markers that measure x, and accelerometers
    # where there are any
    measured: xr.Dataset
    instruments: Instruments  # noise of the campaign's sensors


def open_test(case, campaign, name):
    """`OpenTest` of a case of the configuration, of the test ``name`` in the folder ``campaign``.

    The simulated window is the case's, or the record where that is shorter.
    """
    loaded = load_campaign(campaign)
    listed = loaded.tests[name]
    motion = (
        listed.motion if listed.motion in shipped_names("motions") else str(loaded.folder / listed.motion)
    )
    named = {"campaign": campaign, "test": name}
    case = {**case, "motion": motion, "scale": listed.scale, "baseline": listed.baseline, "input": MEASURED}
    base = measured_input({**case, "duration": 0.0}, named)
    duration = min(case["duration"], float(base.attrs["end"] - base.attrs["start"]))
    check_known(base, duration, name)
    measured, _ = measured_on_clock(named, base)
    sensors = loaded.sensors
    instruments = Instruments(
        marker_noise=sensors.marker_noise, accelerometer_noise=sensors.accelerometer_noise
    )
    return OpenTest(name, {**case, "duration": duration}, base, measured, instruments)


def simulate_readings(test, model, settings, rows, time_steps, ensemble, store):
    """Synthetic readings of every sample, simulated where the store has not got them.

    Parameters
    ----------
    test : OpenTest
    model : str
        Name of the study's model.
    settings : dict
        ``parameters`` of the solver by dotted name, ``output_rate`` [Hz].
    rows : pandas.DataFrame
        Sampled values, index the sample, columns dotted names.
    time_steps : pandas.Series
        Time step of each sample [s]; a run that does not converge is made again by half the step, down to an eighth.
    ensemble : dict
        ``seed`` of the design, of which the motions' draws are, and ``linked``, parameters that take another's value.
    store : Store

    Returns
    -------
    list of Path or None
        By sample; none for a run that ended for a numerical reason.
    """
    case, structure = test.case, structure_of_case(test.case, test.base)
    motions = driving_motions(case, test.base, ensemble["seed"])
    part = part_name(CALIBRATION, case["name"], model)
    solver, found = solver_of(model).name, []
    for sample, row in rows.iterrows():
        parameters = settings["parameters"] | used_parameters(row, structure, ensemble["linked"], solver)
        noise = content_digest("noise", test.name, solver, structure.digest, ensemble["seed"], int(sample))
        unit = _Readings(
            structure, motions(sample, row), solver, parameters, float(time_steps[sample]), case["duration"],
            settings["output_rate"], test.instruments, int(noise, 16),
        )  # fmt: skip
        path = store.dataset(f"{part}: sample {sample} in {test.name}", unit)
        status = load_made(path, ("marker_displacement", "log_spectrum")).attrs["status"]
        found.append(path if status in FINISHED else None)
    return found


@dataclass(frozen=True)
class _Readings(Unit):
    """Synthetic readings of one sample."""

    decimals = _DECIMALS
    structure: Structure
    motion: GroundMotion
    model: str
    parameters: dict
    time_step: float  # [s]
    duration: float  # [s]
    output_rate: float  # [Hz]
    instruments: Instruments
    noise: int  # seed of the sensors' noise

    def made(self, checkpoint):
        for halving in range(_HALVINGS + 1):
            run = simulate(
                self.structure, self.motion, self.model, self.parameters, time_step=self.time_step / 2**halving,
                duration=self.duration, output_rate=self.output_rate, checkpoint=checkpoint,
            )  # fmt: skip
            if run.attrs["status"] != Status.NOT_CONVERGED:
                break
        read = observe(run, self.structure, self.instruments, self.noise)
        along = read[["marker_displacement"]].sel(axis=["x"])
        along = along.assign(log_spectrum=log_spectrum(read, self.structure, self.duration))
        return along.assign_attrs(status=run.attrs["status"])


def displacement_curves(test, files):
    """Displacement along x relative to the slab's marker, of the test and of the samples.

    Parameters
    ----------
    test : OpenTest
    files : list of Path or None
        From `simulate_readings`, at least one run.

    Returns
    -------
    measured : float64 array, shape (n_times, n_markers)
        [m]; NaN is a gap.
    samples : float64 array, shape (n_samples, n_times, n_markers)
        [m]; NaN all over without a run. After a collapse the last displacement stands: a fallen block is no nearer.
    """
    runs = [load_made(path, ("log_spectrum",)) for path in files if path]
    read, curves = curves_along_x(test.measured, xr.concat(runs, dim="sample", combine_attrs="drop"))
    slab = driven_marker(load_structure(test.case["structure"]), read["marker"].values)
    blocks = [name for name in read["marker"].values if name != slab]
    read, curves = (one.sel(marker=blocks) - one.sel(marker=slab, drop=True) for one in (read, curves))
    moved = [
        pd.DataFrame(curve).ffill().to_numpy()
        for curve in curves.transpose("sample", "time", "marker").to_numpy()
    ]
    return read.transpose("time", "marker").to_numpy(), _at_places(np.array(moved), files)


def acceleration_spectra(test, files):
    """Spectra of the blocks' accelerometers, of the test and of the samples; None where the test has none.

    Parameters
    ----------
    test : OpenTest
    files : list of Path or None
        From `simulate_readings`, at least one run.

    Returns
    -------
    measured : float64 array, shape (n_lines, n_channels)
        As of `log_spectrum`.
    samples : float64 array, shape (n_samples, n_lines, n_channels)
        NaN all over without a run, and for one that fell too soon to have a spectrum.
    """
    structure = load_structure(test.case["structure"])
    measured = log_spectrum(test.measured, structure, test.case["duration"])
    runs = [load_made(path, ("marker_displacement",))["log_spectrum"] if path else None for path in files]
    long = [run if run is not None and run.size else None for run in runs]
    measured, *read = xr.align(measured, *(run for run in long if run is not None), join="inner")
    if not measured.size or not read:
        return None
    return measured.to_numpy(), _at_places(np.array([run.to_numpy() for run in read]), long)


def log_spectrum(test, structure, duration):
    """Logarithm of the spectra of the accelerometer channels on blocks, ``(line, channel)``; empty without whole ones.

    Parameters
    ----------
    test : xarray.Dataset
        As in a campaign's test file, its accelerometers' time from the start of the input on [s].
    structure : Structure
    duration : float
        The window [s].

    Returns
    -------
    xarray.DataArray
        Natural logarithm of the power spectral density in m2/s3, by Welch's method (1967) with segments of a second.
        ``line`` is the frequency, 1 Hz to the low-pass.

    Notes
    -----
    A spectrum has the frequencies of a test of low amplitude as its peaks, and in a strong test what impacts excite. It
    does not know when: late rocking, whose phase nobody predicts, counts as far as it has the same strength.
    """
    empty = xr.DataArray(
        np.empty((0, 0)), {"line": np.empty(0, dtype=int), "channel": np.empty(0, dtype=str)}
    )
    read = whole_channels(test, structure)
    if read is None:
        return empty
    count = int(np.searchsorted(read.time, duration, side="right"))
    rate = (len(read.time) - 1) / (read.time[-1] - read.time[0])
    if count < 2.0 * _SEGMENT * rate:
        return empty
    _, power = scipy.signal.welch(read.values[:count], rate, nperseg=round(_SEGMENT * rate), axis=0)
    power = np.log(np.maximum(power[1:], np.finfo(float).tiny))[: round(CUTOFF * _SEGMENT)]
    lines = np.arange(1, len(power) + 1)
    return xr.DataArray(power, {"line": lines, "channel": read.names}, attrs={"units": "1"})


def _at_places(values, samples):
    """Values of the samples that are there at their places, NaN where there is none."""
    table = np.full((len(samples), *values.shape[1:]), np.nan)
    table[[place for place, one in enumerate(samples) if one is not None]] = values
    return table
