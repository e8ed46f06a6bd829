"""Ensembles at a time step of 1e-4 s against 1e-5 s: the check that lets the study take the larger one."""

import logging

import numpy as np
import pandas as pd
import pytest

from blockshake.dynamics.system import FINISHED
from blockshake.geometry.structure import load_structure
from blockshake.measurement.sensors.markers import driven_marker
from blockshake.store import Store
from blockshake.study.ensembles.batch import CaseRuns, samples_of, simulate_samples
from blockshake.study.ensembles.case_input import driving_motions
from blockshake.study.ensembles.ensemble import join_batches, relative_to_slab
from blockshake.study.sampling.distributions import LINKED
from blockshake.study.sampling.latin_hypercube import draw_samples
from blockshake.study.stiffness.wave_speed import calibrate_design

SIZE, SEEDS = 50, (1, 2, 3)  # of designs like the study's, whose is the first
CASE = {
    "structure": "configuration-1",
    "motion": "basso-tirreno",
    "scale": 2.25,
    "baseline": "auto",
    "duration": 12.0,
    "input": "commanded",
}
STEPS = (1e-4, 1e-5)  # s
QUANTILES = (0.05, 0.5, 0.95)
RESAMPLES = 2000
# Two-sided, of a test for each of the three quantiles of the history and of the peak: Bonferroni's 5 % in all.
LEVEL = 0.05 / 6
_log = logging.getLogger(__name__)


def simulated(step, rows, linked, store):
    """Drift of the top block's marker at one time step [m], shape (sample, time)."""
    structure = load_structure(CASE["structure"])
    motions = driving_motions(CASE, None, SEEDS[0])
    runs = CaseRuns(CASE, "ls-dem", {"time_step": step}, linked, 200.0)
    files = simulate_samples(runs, motions, rows, Store(store, "", _log.info))
    ensemble = join_batches(samples_of(files, rows))
    assert np.isin(ensemble["status"], FINISHED).all()
    drift = relative_to_slab(ensemble["marker_displacement"], driven_marker(structure))
    return drift.sel(marker="block-3-face", axis="x").transpose("sample", "time").to_numpy()


def figures(drift):
    """Compared figures: the drift's history and its peak, shape (sample, n)."""
    return {"history": drift, "peak": np.abs(drift).max(axis=1, keepdims=True)}


def compared(coarse, fine, probability, seed):
    """Shift of one quantile, its sampling error and how likely chance alone makes so large a shift.

    Parameters
    ----------
    coarse, fine : float64 arrays, shape (n_samples, n)
        The same samples at both steps.
    probability : float
        The quantile.
    seed : int

    Returns
    -------
    shift, error : float
        Root mean squares over the n of the quantile's shift from ``fine`` to ``coarse`` and of the standard
        error of that shift, from drawing the samples anew with replacement, both runs of a sample together
        (paired bootstrap).
    chance : float
        Share of random exchanges of the steps, sample by sample, whose shift is at least as large.

    Notes
    -----
    Where the step makes no systematic difference, which of a sample's two runs is called the coarse one does
    not matter: the exchanges give the distribution of the shift exactly, chaos in each run included.
    """
    rng = np.random.default_rng(seed)
    size = len(fine)

    def moved(one, other):
        return np.quantile(one, probability, axis=0) - np.quantile(other, probability, axis=0)

    shift = rms(moved(coarse, fine))
    picks = rng.integers(size, size=(RESAMPLES, size))
    error = rms(np.std([moved(coarse[pick], fine[pick]) for pick in picks], axis=0, ddof=1))
    larger = 0
    for swap in rng.random((RESAMPLES, size, 1)) < 0.5:
        larger += rms(moved(np.where(swap, fine, coarse), np.where(swap, coarse, fine))) >= shift
    return shift, error, (larger + 1) / (RESAMPLES + 1)


def rms(values):
    return float(np.sqrt(np.mean(np.square(values))))


@pytest.fixture(scope="module")
def drifts(tmp_path_factory):
    linked = LINKED
    design = pd.concat([draw_samples(SIZE, seed).values for seed in SEEDS], ignore_index=True)
    design.index.name = "sample"
    stiffness = calibrate_design(
        "configuration-2", design, linked, Store(tmp_path_factory.mktemp("store"), "")
    )
    rows = pd.concat([design, stiffness], axis=1)
    return [simulated(step, rows, linked, tmp_path_factory.mktemp("store")) for step in STEPS]


@pytest.mark.slow
@pytest.mark.parametrize("what", ["history", "peak"])
@pytest.mark.parametrize("probability", QUANTILES)
def test_quantiles_agree_within_their_sampling_error(drifts, what, probability):
    """The shift is below two standard errors of itself, and no rarer than exchanging the steps makes it."""
    coarse, fine = (figures(drift)[what] for drift in drifts)
    shift, error, chance = compared(coarse, fine, probability, seed=2)
    _log.info(
        "%s, %g: shift %.3g m, standard error %.3g m, chance %.3f", what, probability, shift, error, chance
    )
    assert shift < 2.0 * error
    assert chance > LEVEL


def test_a_shifted_ensemble_is_found():
    """The check can fail: noise of a fiftieth of the spread passes, every sample moved by a tenth does not."""
    rng = np.random.default_rng(3)
    fine = rng.standard_normal((SIZE, 20))
    noisy = fine + 0.02 * rng.standard_normal(fine.shape)
    shift, error, chance = compared(noisy, fine, 0.5, seed=4)
    assert shift < 2.0 * error
    assert chance > LEVEL
    shift, error, chance = compared(noisy + 0.1, fine, 0.5, seed=4)
    assert shift > 2.0 * error
    assert chance < LEVEL
