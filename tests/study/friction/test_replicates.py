"""Replicated designs: independent, tied to who they are, and with the error bars that theory gives."""

import numpy as np
import pytest
from scipy.special import ndtr, ndtri

from blockshake.errors import InputError
from blockshake.study.ensembles.intervals import sample_quantiles
from blockshake.study.friction.replicates import replicate_error, replicate_seed, replicated_designs
from blockshake.study.sampling.distributions import Lognormal

VARIABLES = {
    "friction.concrete.concrete": Lognormal(mean=0.75, cov=0.10),
    "friction.concrete.foundation": Lognormal(mean=0.75, cov=0.10),
    "materials.concrete.density": Lognormal(mean=2400.0, cov=0.04),
}
SIZE, COUNT = 50, 60


@pytest.fixture(scope="module")
def chances():
    """Probabilities of the variables' values in every design, (n_replicates, n_samples, n_variables)."""
    designs = replicated_designs(COUNT, SIZE, 5, distributions=VARIABLES, effort=1)
    return np.stack(
        [
            np.column_stack(
                [
                    ndtr(np.log(design.values[name] / one.median) / one.log_deviation)
                    for name, one in VARIABLES.items()
                ]
            )
            for design in designs
        ]
    )


# the error of a standard deviation from 60 replicates is 1 / sqrt(118) = 9 %: three of it
KNOWN_TO = 3.0 / np.sqrt(2.0 * (COUNT - 1))


@pytest.mark.parametrize("probability", [0.5, 0.8])
def test_error_of_a_quantile_is_the_known_one_where_the_design_cannot_help(chances, probability):
    """y = Phi^-1((u1 + u2 + u3) mod 1) depends on no variable by itself: a hypercube then errs as independent draws do
    (Stein 1987), and a quantile by sqrt(p (1 - p) / n) / f."""
    score = ndtri(np.clip(chances.sum(axis=2) % 1.0, 0.5 / SIZE, 1.0 - 0.5 / SIZE))
    found = sample_quantiles(score.T, np.array([probability]))[0]
    mean, of_one, of_mean = replicate_error(found)
    quantile = ndtri(probability)
    density = np.exp(-0.5 * quantile**2) / np.sqrt(2.0 * np.pi)
    known = np.sqrt(probability * (1.0 - probability) / SIZE) / density
    assert of_one == pytest.approx(
        known, rel=KNOWN_TO + 0.05
    )  # 1 / n terms of the formula: a few per cent at 50
    assert mean == pytest.approx(quantile, abs=4.0 * of_mean + 0.03)  # interpolation in 50 values: 1 / (n f)
    assert of_mean == pytest.approx(of_one / np.sqrt(COUNT))


def test_error_is_far_below_that_of_independent_draws_where_variables_add(chances):
    """The mean of a sum of functions of one variable each is the same in every hypercube (Stein 1987)."""
    total = ndtri(chances).sum(axis=2).mean(axis=1)
    independent = np.sqrt(3.0 / SIZE)
    assert replicate_error(total)[1] < 1e-9 * independent


def test_designs_are_independent_of_each_other_and_of_the_study_s(chances):
    first = chances[:, :, 0]
    correlation = np.corrcoef(first)[np.triu_indices(COUNT, 1)]
    # 1 / sqrt(n - 1) = 0.143 each
    assert correlation.std() == pytest.approx(1.0 / np.sqrt(SIZE - 1), rel=0.1)
    assert abs(correlation.mean()) < 0.02
    seeds = {replicate_seed(seed, place) for seed in range(20) for place in range(1, 20)}
    assert len(seeds) == 20 * 19
    assert not seeds & set(range(1000))


def test_a_replicate_is_the_same_whichever_others_are_drawn():
    few, more = (replicated_designs(count, 10, 5, distributions=VARIABLES, effort=1) for count in (2, 3))
    for one, other in zip(few, more, strict=False):
        assert one.values.equals(other.values)
    assert not few[0].values.equals(few[1].values)


def test_one_design_has_no_error_bar():
    with pytest.raises(InputError, match="at least 2"):
        replicated_designs(1, 10, 5, distributions=VARIABLES)
    with pytest.raises(InputError, match="at least two"):
        replicate_error(np.ones((1, 3)))
