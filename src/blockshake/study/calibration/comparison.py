"""Open tests of a case against the samples of the calibration: how far all readings are from each other."""

from pathlib import Path

import numpy as np
import pandas as pd
import xarray as xr

from blockshake.geometry.reference_block import reference_block
from blockshake.geometry.structure import load_structure
from blockshake.measurement.campaigns.campaign import load_campaign
from blockshake.simulation.models import solver_of
from blockshake.sources import script_sources, source_digest
from blockshake.study.calibration.answers import Distances, chance_of_test, distances
from blockshake.study.calibration.readings import (
    acceleration_spectra,
    displacement_curves,
    open_test,
    simulate_readings,
)
from blockshake.study.calibration.settings import (
    HOLLOW,
    OTHERS,
    RESTITUTION,
    STIFFNESS,
    CalibrationSettings,
)
from blockshake.study.sampling.distributions import load_distributions
from blockshake.study.sampling.latin_hypercube import draw_samples
from blockshake.study.sampling.sample_parameters import has_parameter
from blockshake.study.stiffness.wave_speed import calibrate_design

_CURVES, _SPECTRA = "displacement", "acceleration"
_FEWEST = 0.9  # of the samples, that have a reading: with fewer some values would have none near them


def compare_open_tests(case, campaign, model, given, store):
    """Distances of the samples' readings of a case's open tests from the measured ones and from each other.

    Parameters
    ----------
    case : dict
        ``name``, ``structure`` and ``duration`` [s] of a case of the configuration.
    campaign : str
        Folder of its tests; the sealed ones are not read.
    model : str
    given : dict
        Entries ``calibration``, ``ensemble``, ``models`` and ``output_rate`` of the configuration.
    store : Store

    Returns
    -------
    xarray.Dataset
        ``to_test(test, reading, sample)`` and ``between(test, reading, sample, other)`` [1], NaN where a test or a
        sample has no such reading; ``chance(test, reading)`` of `chance_of_test` [1]; ``share(parameter, sample)``,
        where a sample lies in the range of each parameter that structure and model have a use for [1]; by test
        ``motion``, ``scale`` [1], ``synthetic`` and ``unsolved``, the number of samples that ended for a numerical
        reason. ``reading``: the displacement, and the spectrum of the acceleration. Attributes ``case``, ``model``.
    """
    settings = CalibrationSettings(**given["calibration"])
    ensemble = {
        **given["ensemble"],
        "seed": _second_seed(given["ensemble"]["seed"]),
        "linked": given["ensemble"]["linked"] | settings.linked,
    }
    variables = load_distributions(ensemble["distributions"], "ensemble")
    ranges = settings.ranges_of(variables)
    drawn = draw_samples(settings.size, ensemble["seed"], variables | ranges).values
    structure = load_structure(case["structure"])
    used = [one for one in ranges if has_use(model, structure, one)]
    rows = _as_parameters(drawn, used, structure, case["structure"], store)
    run_settings = {**given["models"][model], "output_rate": given["output_rate"]}
    steps = _time_steps(drawn, used, run_settings["time_step"])
    tests = {}
    for name in settings.chosen(load_campaign(campaign)):
        test = open_test(case, campaign, name)
        store.say(f"{name}: {test.case['motion']} at {test.case['scale']:g}, {test.case['duration']:.4g} s")
        run = run_settings, rows, steps, ensemble, store
        tests[name] = _compared(test, simulate_readings(test, model, *run))
    shares = [ranges[one].share(drawn[one].to_numpy()) for one in used]
    found = xr.concat(tests.values(), dim=xr.Variable("test", list(tests)))
    found = found.assign(share=(("parameter", "sample"), shares)).assign_coords(parameter=used)
    found.attrs = {
        "title": "open tests of a case against the samples of the calibration",
        "case": case["name"],
        "model": model,
    }
    return found


def _second_seed(seed):
    """Seed of the calibration's design, whose samples are others than those of the study."""
    return int(np.random.SeedSequence([seed, 0]).generate_state(1)[0])


def _compared(test, files):
    """Distances of one test by reading, NaN where it or all samples have none."""
    read = {}
    if sum(path is not None for path in files) > 1:
        read = {_CURVES: displacement_curves(test, files), _SPECTRA: acceleration_spectra(test, files)}
    nothing = np.full(1, np.nan), np.full((len(files), 1), np.nan)
    found = [distances(*reversed(read.get(kind) or nothing)) for kind in (_CURVES, _SPECTRA)]
    return xr.Dataset(
        {
            "to_test": (("reading", "sample"), [one.to_test for one in found]),
            "between": (("reading", "sample", "other"), [one.between for one in found]),
            "chance": ("reading", [chance_of_test(one) for one in found]),
            "motion": ((), Path(test.case["motion"]).stem),
            "scale": ((), test.case["scale"]),
            "synthetic": ((), int(test.measured.attrs.get("synthetic", 0))),
            "unsolved": ((), sum(path is None for path in files)),
        },
        {"reading": [_CURVES, _SPECTRA], "sample": np.arange(len(files))},
    )


def has_use(model, structure, parameter):
    """Whether a model has a use for a parameter of the calibration in a structure."""
    if parameter == HOLLOW and hollow_shape(structure)[0] is None:
        return False
    if parameter in OTHERS:
        return bool(solver_of(model).calibrated)
    return has_parameter(structure, parameter)


def hollow_shape(structure):
    """Name of the shape of a structure's upright blocks, and its smallest edge [m]; two None where it is no box."""
    name = structure.file.bodies[reference_block(structure).body].shape
    box = structure.file.shapes[name].box
    return (name, min(box)) if box else (None, None)


def parameter_of(structure, name):
    """Dotted name in a structure of a parameter of the calibration, not of a stiffness, and its value over that."""
    if name == HOLLOW:
        shape, edge = hollow_shape(structure)
        return f"shapes.{shape}.hollow", edge
    return name, 1.0


def read_distances(compared):
    """`Distances` by test and reading of a Dataset of `compare_open_tests`, without those of `left_out`."""
    found = {}
    for test in map(str, compared["test"].values):
        for reading in map(str, compared["reading"].values):
            one = compared.sel(test=test, reading=reading)
            if np.isfinite(one["to_test"]).mean() >= _FEWEST:
                found[test, reading] = Distances(one["to_test"].to_numpy(), one["between"].to_numpy())
    return found


def left_out(compared):
    """Tests of a Dataset of `compare_open_tests` of which too many samples have no reading, list of str."""
    answered = np.isfinite(compared["to_test"]).mean("sample").max("reading")
    return [str(test) for test in compared["test"].values[(answered < _FEWEST).to_numpy()]]


def _as_parameters(drawn, used, structure, named, store):
    """Rows by dotted name: stiffness as the factor times that of the nominal wave test, the concavity as its depth.

    Parameters of contact springs are left out where the model has none: rigid contact needs no wave test.
    """
    rows = drawn.drop(
        columns=[one for one in OTHERS if one in drawn and (one not in used or one != RESTITUTION)]
    )
    if STIFFNESS in used:
        waves = store._replace(source=source_digest(*script_sources("calibrate_stiffness")))
        wave = calibrate_design(named, pd.DataFrame(index=[0]), {}, waves).iloc[0]
        rows = rows.assign(**{name: value * drawn[STIFFNESS] for name, value in wave.items()})
    if HOLLOW in used:
        hollow, edge = parameter_of(structure, HOLLOW)
        rows = rows.assign(**{hollow: drawn[HOLLOW] * edge})
    return rows


def _time_steps(drawn, used, usual):
    """Time steps of the samples [s], the same share of the period of their contact springs as the usual one is."""
    return usual / np.sqrt(drawn[STIFFNESS] if STIFFNESS in used else pd.Series(1.0, drawn.index))
