"""Sobol indices, and Shapley effects of inputs that depend on each other, by a surrogate of the runs at hand."""

import warnings

import numpy as np
import scipy
import xarray as xr
from scipy.special import ndtri

from blockshake.dynamics.system import FALLEN
from blockshake.statistics.intervals import CONFIDENCE
from blockshake.store import load_made
from blockshake.study.ensembles.ensemble import describe
from blockshake.study.ensembles.envelope import BOUNDS, counted_samples
from blockshake.study.ensembles.levels import by_level

LARGEST = "largest displacement"  # of any marker along x relative to the slab

SUFFICES = (
    0.7  # of the variance that a surrogate predicts of runs that it does not know, from which on it tells
)
_FEWEST_RUNS = 20  # runs
_FEATURES = 500  # of a draw of the surrogate
_SURROGATE_DRAWS = 40  # of the surrogate, for the intervals
_SOBOL_POINTS = 1024  # of the Sobol indices, a power of 2
_ORDERS = 3000  # of the inputs, for the Shapley effects
_INNER_POINTS = 3  # points of a conditional variance: the least that Song, Nelson and Staum find best
_EVERY_FIFTH = 5  # every fifth run
_NOISE_RANGE = (1e-8, 1.0)  # of the variance of an output
_LENGTH_RANGE = (0.1, 100.0)  # in standard deviations of an input


_DESCRIBED = {
    "shapley": ("Shapley effect, share of the variance", "1"),
    "first": ("first-order Sobol index of independent inputs", "1"),
    "total": ("total Sobol index of independent inputs", "1"),
    "left_out": ("share of the variance that the surrogate predicts of runs left out one by one", "1"),
    "held_out": ("share of the variance that it predicts of every fifth run by the others", "1"),
    "used": ("runs used", "1"),
}


def indices_of_case(samples, sensitivity, limits, seed, levels):
    """`indices` of the largest displacement and of every limit state's measure, to the variables that can matter.

    Parameters
    ----------
    samples, sensitivity : path
        Files from `sample_figures` and from `sensitivity`, whose controls are left out.
    limits : path or None
        File from `limit_states_of_case`, where the study has limit states.
    seed : int
        The design.
    levels : dict of int to float
        From `levels_of`.

    Returns
    -------
    xarray.Dataset
        Entries of `indices` by ``output`` and, but for the two shares and ``used(output)``, by ``parameter``; along
        ``level`` where there are any.

    Notes
    -----
    Failed samples are left out. One that fell has at least the largest displacement of those that stood, which a
    surrogate cannot follow where many fell: its shares say so.
    """
    counted, measured = counted_samples(load_made(samples)), load_made(sensitivity)
    found = load_made(limits).sel(sample=counted["sample"].values) if limits else None
    measured = measured.isel(level=0) if levels else measured  # a control is one at every level
    return by_level(
        levels, lambda of: _indices_of(of(counted), measured, None if found is None else of(found), seed)
    )


def _indices_of(counted, measured, found, seed):
    names = [str(name) for name in measured["parameter"].values[measured["control"].values == 0]]
    inputs = counted["parameter_value"].sel(parameter=names).transpose("sample", "parameter").to_numpy()
    peak = counted["peak"].sel(frame="slab", drop=True).max("marker").to_numpy()
    fell = np.isin(counted["status"].values, FALLEN)
    outputs = {LARGEST: np.where(fell, np.fmax(peak, np.max(peak[~fell], initial=0.0)), peak)}
    if found is not None:
        outputs |= {str(name): found["value"].sel(limit=name).to_numpy() for name in found["limit"].values}
    parts = []
    for output in outputs.values():
        known = np.isfinite(output)
        made = indices(inputs[known], output[known], seed)
        dims = {0: (), 1: ("parameter",), 2: ("bound", "parameter")}
        variables = {name: (dims[np.ndim(values)], values) for name, values in made.items()}
        parts.append(xr.Dataset(variables | {"used": ((), int(known.sum()))}))
    result = xr.concat(parts, dim=xr.Variable("output", list(outputs)))
    result = result.assign_coords(parameter=names, bound=list(BOUNDS))
    describe(result, _DESCRIBED)
    return result.assign_attrs(title="indices of a study by a surrogate", confidence=CONFIDENCE)


class Surrogate:
    """A Gaussian process through the runs, in normal scores of the inputs.

    ``scores`` (n_runs, n_inputs), ``output`` (n_runs,); ``kernel`` of scikit-learn, fitted where it is None.
    """

    def __init__(self, scores, output, kernel=None):
        from sklearn.gaussian_process import GaussianProcessRegressor
        from sklearn.gaussian_process.kernels import RBF, ConstantKernel, WhiteKernel

        self.mean, self.deviation = float(output.mean()), float(output.std())
        self.scores, known = scores, (output - self.mean) / self.deviation
        optimizer = "fmin_l_bfgs_b" if kernel is None else None
        kernel = kernel or ConstantKernel(1.0) * RBF(np.ones(scores.shape[1]), _LENGTH_RANGE) + WhiteKernel(
            1e-2, _NOISE_RANGE
        )
        with (
            warnings.catch_warnings()
        ):  # of a length at an end of its range: an input without effect, or a step
            warnings.simplefilter("ignore")
            process = GaussianProcessRegressor(kernel, alpha=0.0, optimizer=optimizer).fit(scores, known)
        self.kernel, self.known = process.kernel_, known
        self.smooth, self.noise = process.kernel_.k1, float(process.kernel_.k2.noise_level)
        self.inverse = np.linalg.inv(process.kernel_(scores))

    def predicted(self, scores):
        """Output at scores (n, n_inputs), float64 (n,)."""
        return self.mean + self.deviation * self.smooth(scores, self.scores) @ (self.inverse @ self.known)

    def left_out(self):
        """Output of every run by the others alone, at the same kernel (Rasmussen and Williams 2006, Eq. 5.12)."""
        off = (self.inverse @ self.known) / np.diag(self.inverse)
        return self.mean + self.deviation * (self.known - off)

    def draws(self, generator):
        """Function of scores (n, n_inputs) that gives the mean of the process and draws of it, (1 + draws, n).

        Notes
        -----
        Draws of the prior by random Fourier features, brought to the runs (Wilson et al. 2020, Eq. 13).
        """
        n_inputs, variance = self.scores.shape[1], float(self.smooth.k1.constant_value)
        waves = generator.standard_normal((n_inputs, _FEATURES)) / np.reshape(
            self.smooth.k2.length_scale, (-1, 1)
        )
        phase = generator.uniform(0.0, 2.0 * np.pi, _FEATURES)
        weights = generator.standard_normal((_FEATURES, _SURROGATE_DRAWS))
        weights = np.concatenate([np.zeros((_FEATURES, 1)), weights], axis=1)

        def prior(scores):
            return np.sqrt(2.0 * variance / _FEATURES) * np.cos(scores @ waves + phase) @ weights

        errors = np.sqrt(self.noise) * generator.standard_normal((len(self.known), 1 + _SURROGATE_DRAWS))
        errors[:, 0] = 0.0
        pull = self.inverse @ (self.known[:, None] - prior(self.scores) - errors)
        return lambda scores: (prior(scores) + self.smooth(scores, self.scores) @ pull).T


def normal_scores(inputs):
    """Normal scores of the ranks of each input, equal values at their mean rank: float64, shape of ``inputs``."""
    return ndtri((scipy.stats.rankdata(inputs, axis=0) - 0.5) / len(inputs))


def share_predicted(output, predicted):
    """Share of an output's variance that a prediction explains, Q^2 [1]; below 0 where the mean is better."""
    return 1.0 - float(((output - predicted) ** 2).sum() / ((output - output.mean()) ** 2).sum())


def indices(inputs, output, seed):
    """First-order and total Sobol indices, and Shapley effects, of one output, by a surrogate of runs that are there.

    Parameters
    ----------
    inputs : float64 array, shape (n_runs, n_inputs)
        Sampled values, in any dependence that ranks tell.
    output : float64 array, shape (n_runs,)
    seed : int

    Returns
    -------
    dict of str to float or float64 array
        ``left_out`` and ``held_out``, shares of the variance predicted of runs left out one by one, and of every
        fifth run by the others [1]. ``shapley``, ``first`` and ``total`` (n_inputs,), each with limits of 95 %,
        ``NAME_interval`` (2, n_inputs), of the surrogate's error, and of the Shapley effects of their sampling too;
        all within 0 and 1, as the truth is. NaN where one of the shares is below `SUFFICES`, the runs are fewer than
        20 or the output does not vary. `first` and `total` take the inputs as independent: they are NaN where a rank
        correlation is beyond that of chance.

    Notes
    -----
    The surrogate is a Gaussian process with a length for each input, of scikit-learn; its draws make the intervals (Le
    Gratiet, Cannamela and Iooss 2014). Sobol indices are those of `scipy.stats.sobol_indices`; Shapley effects (Owen
    2014) by random orders (Song, Nelson and Staum 2016, algorithm 1), their conditional draws from a Gaussian copula of
    the ranks. The Shapley effects of all inputs sum to 1.
    """
    n_runs, n_inputs = inputs.shape
    names = ("shapley", "first", "total")
    empty = {name: np.full(n_inputs, np.nan) for name in names}
    empty |= {f"{name}_interval": np.full((2, n_inputs), np.nan) for name in names}
    none = {"left_out": np.nan, "held_out": np.nan, **empty}
    if n_runs < _FEWEST_RUNS or not n_inputs or not output.std() > 1e-9 * max(abs(output.mean()), 1e-300):
        return none
    scores, generator = normal_scores(inputs), np.random.default_rng(seed)
    surrogate = Surrogate(scores, output)
    held = np.arange(n_runs) % _EVERY_FIFTH == 0
    other = Surrogate(scores[~held], output[~held])
    found = none | {
        "left_out": share_predicted(output, surrogate.left_out()),
        "held_out": share_predicted(output[held], other.predicted(scores[held])),
    }
    if min(found["left_out"], found["held_out"]) < SUFFICES:
        return found
    draws = surrogate.draws(generator)
    correlation = np.atleast_2d(np.corrcoef(scores, rowvar=False))
    chance = ndtri(1.0 - 0.025 / max(n_inputs * (n_inputs - 1) / 2, 1)) / np.sqrt(n_runs)
    effects, error = shapley_effects(draws, correlation, generator)
    made = {"shapley": effects}
    if np.abs(correlation - np.eye(n_inputs)).max() < chance:
        sobol = scipy.stats.sobol_indices(
            func=lambda points: draws(points.T),
            n=_SOBOL_POINTS,
            dists=[scipy.stats.norm()] * n_inputs,
            rng=generator,
        )
        made |= {"first": sobol.first_order, "total": sobol.total_order}
    for name, values in made.items():
        # the spread of the draws, around the value of the mean; all draws share the points of the sampling
        spread = np.hypot(values[1:].std(axis=0), error if name == "shapley" else 0.0)
        found[name] = np.clip(values[0], 0.0, 1.0)
        found[f"{name}_interval"] = np.clip(values[0] + np.array([[-1.96], [1.96]]) * spread, 0.0, 1.0)
    found["shapley"] /= found["shapley"].sum()
    return found


def shapley_effects(function, correlation, generator):
    """Shapley effects of normal inputs on functions of them.

    Parameters
    ----------
    function : callable
        Takes scores (n, n_inputs), returns values (n_functions, n).
    correlation : float64 array, shape (n_inputs, n_inputs)
        Correlation of the inputs, which have unit variance.
    generator : numpy.random.Generator

    Returns
    -------
    effects : float64 array, shape (n_functions, n_inputs)
        Shares of the variance [1].
    error : float64 array, shape (n_inputs,)
        Standard error of those of the first function by the sampling [1].
    """
    n_inputs = len(correlation)
    root, precision = np.linalg.cholesky(correlation), np.linalg.inv(correlation)
    orders = np.argsort(generator.random((_ORDERS, n_inputs)), axis=1)
    outer = generator.standard_normal((_ORDERS, n_inputs - 1, n_inputs)) @ root.T
    points = np.repeat(outer[:, :, None], _INNER_POINTS, axis=2)
    noise = generator.standard_normal(points.shape)
    for order, at, drawn in zip(orders, points, noise, strict=True):
        for count in range(1, n_inputs):
            inside, fixed = order[:count], order[count:]
            # x_J given the rest: mean -P_JJ^-1 P_JK x_K, covariance P_JJ^-1
            own = np.linalg.cholesky(precision[np.ix_(inside, inside)])
            pull = precision[np.ix_(inside, fixed)] @ at[count - 1, 0, fixed]
            mean = -np.linalg.solve(own.T, np.linalg.solve(own, pull))
            at[count - 1][:, inside] = mean + np.linalg.solve(own.T, drawn[count - 1][:, inside].T).T
    values = function(points.reshape(-1, n_inputs)).reshape(-1, _ORDERS, n_inputs - 1, _INNER_POINTS)
    apart = function(generator.standard_normal((4 * _ORDERS, n_inputs)) @ root.T)
    total = apart.var(axis=1, ddof=1)
    left = np.zeros((len(values), _ORDERS, n_inputs + 1))
    left[..., 1:-1], left[..., -1] = values.var(axis=-1, ddof=1), total[:, None]
    # gain of every input, wherever it stands in an order
    gains = np.take_along_axis(np.diff(left, axis=-1), np.argsort(orders, axis=1)[None], axis=-1)
    effects = gains.mean(axis=1) / total[:, None]
    by_orders = gains[0].std(axis=0, ddof=1) / np.sqrt(_ORDERS) / total[0]
    # the total variance is sampled too, and divides all but what an input gains as the last of an order
    of_total = ((apart[0] - apart[0].mean()) ** 2).std() / np.sqrt(apart.shape[1]) / total[0]
    return effects, np.hypot(by_orders, np.abs(effects[0] - 1.0 / n_inputs) * of_total)
