"""Latin hypercube designs with controlled correlation, and designs of own samples."""

import contextlib
from collections.abc import Mapping
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import numpy as np
import pandas as pd
import scipy

from blockshake.errors import InputError
from blockshake.files import AnyPath, content_digest, load_json
from blockshake.study.sampling.correlation_control import arrange
from blockshake.study.sampling.correlation_target import check_correlation, load_correlation
from blockshake.study.sampling.distributions import TABLE_2, known_as, load_distributions
from blockshake.study.sampling.sample_table import load_design

SMALLEST_SIZE, LARGEST_SIZE = 10, 1_000_000  # samples; the largest take 2 GB
DEFAULT_EFFORT = 8


@dataclass(frozen=True, repr=False)
class SampleDesign:
    """Values of the random variables for every sample, and how well they correlate."""

    # pandas.DataFrame, shape (size, n_variables); one row a sample, columns the dotted names, SI
    values: pd.DataFrame
    # target, correlation: pandas.DataFrame, shape (n_variables, n_variables); correlation requested and
    # reached
    target: pd.DataFrame
    correlation: pd.DataFrame
    kind: str  # ``pearson``: of the physical values; ``spearman``: of their ranks
    # ``median`` or ``mean``: which value stands for each stratum; ``own``: the samples are those of a table
    stratum: str
    # seed, effort: as given to `draw_samples`
    seed: int
    effort: int

    def __repr__(self) -> str:
        size, count = self.values.shape
        return (
            f"<SampleDesign {size} samples of {count} variables, rms correlation error {self.rms_error:.2e}>"
        )

    def _repr_html_(self) -> str:
        return self.values.to_html(max_rows=10)

    @property
    def rms_error(self) -> float:
        """Root mean square over the pairs of variables of correlation reached minus target [1]."""
        return float(np.sqrt(np.mean(self._errors() ** 2)))

    @property
    def largest_error(self) -> float:
        """Largest absolute correlation reached minus target among the pairs of variables [1]."""
        return float(np.max(np.abs(self._errors())))

    def _errors(self):
        error = self.correlation.to_numpy() - self.target.to_numpy()
        pairs = error[np.triu_indices(len(error), k=1)]
        return pairs if pairs.size else np.zeros(1)

    def summary(self) -> dict[str, Any]:
        """Figures to report, as JSON-like values; ``cov`` gives every sample the probability 1/size."""
        mean, deviation = self.values.mean(), self.values.std(ddof=0)
        return {
            "size": len(self.values),
            "seed": self.seed,
            "effort": self.effort,
            "stratum": self.stratum,
            "correlation_kind": self.kind,
            "rms_correlation_error": self.rms_error,
            "largest_correlation_error": self.largest_error,
            "mean": {name: float(value) for name, value in mean.items()},
            "cov": {name: float(value) for name, value in (deviation / mean).items()},
            "correlation": self.correlation.to_numpy().tolist(),
            "target_correlation": self.target.to_numpy().tolist(),
        }


def drawn_design(settings, source, folder):
    """Values of a design: those that `draw_samples` has left in a folder of results, or drawn anew, which is the same.

    Parameters
    ----------
    settings : dict
        ``ensemble`` of the configuration.
    source : str
        Digest of what draws them.
    folder : str or path
        Folder of the study's results, where ``design.json`` states what ``design.csv`` was drawn from.
    """
    folder = Path(folder)
    with contextlib.suppress(InputError):
        if load_json(folder / "design.json").get("drawn_from") == content_digest(settings, source):
            return load_design(folder / "design.csv")
    return draw_design(settings).values


def draw_samples(
    size: int = 50,
    seed: int = 1,
    distributions: Mapping[str, Any] = TABLE_2,
    correlation: pd.DataFrame | AnyPath | None = None,
    stratum: str = "median",
    kind: str = "pearson",
    effort: int = DEFAULT_EFFORT,
    batch: int | None = None,
) -> SampleDesign:
    """Latin hypercube samples of the random variables, their correlation brought to a target.

    Parameters
    ----------
    size : int
        Samples, 10 to a million; as many strata of equal probability, each hit once by each variable.
    seed : int
        Not negative; same seed, same values.
    distributions : dict of str to Lognormal, Tabulated, Discrete, OfScipy or dict
        By dotted name, also in the notation of a study, see `load_distributions`; Table 2 of Zhou et al. (2023) by
        default.
    correlation : pandas.DataFrame, str or path, optional
        Square target with names as index and columns, of some or all variables, or its file; those not named,
        and all by default, are uncorrelated. The materials of a pair may be in either order.
    stratum : str
        ``median``: the value of a stratum is its median, so that the marginals are exact quantiles
        and the coefficient of variation falls short, by 1.3 to 1.5 % for 50 samples of Table 2;
        ``mean``: its mean, so that the mean is exact and the variation falls 0.3 % short.
    kind : str
        ``pearson``: the correlation is of the physical values; ``spearman``: of their ranks.
    effort : int
        Rounds of annealing; more never gives a larger error.
    batch : int, optional
        Size of the first design and of every addition, of which ``size`` is a multiple: the first samples are those of
        any smaller multiple, to the bit. By default the whole is one hypercube, and another size another design.

    Returns
    -------
    SampleDesign

    Raises
    ------
    InputError
        Too few or too many samples, an unknown word, a wrong distribution, a target with unknown names or that is no
        correlation matrix.

    Examples
    --------
    >>> import blockshake
    >>> uncertain = {"restitution": {"distribution": "uniform", "loc": 0.3, "scale": 0.4}}
    >>> blockshake.draw_samples(10, distributions=uncertain).values["restitution"].round(2).tolist()
    [0.48, 0.56, 0.36, 0.44, 0.68, 0.64, 0.4, 0.32, 0.52, 0.6]

    Notes
    -----
    McKay, Beckman and Conover (1979) for the strata, Vorechovsky and Novak (2009) for the
    correlation. A log-normal target near -1, or near 1 between variables of unlike variation, can
    lie beyond what any pairing reaches: the error then stays and is reported.

    A design that grows is a chain of Latin hypercubes of one size. The first has the medians of its strata. In each
    pair of additions every stratum gets a value on either side of these, nearer and farther by the sequence of van der
    Corput (1935), the side by chance and the other in the other addition. The correlation is controlled in every
    addition.
    """
    _check_options(size, seed, stratum, kind, effort)
    batch = size if batch is None else batch
    _check_options(batch, seed, stratum, kind, effort)
    if size % batch or (size > batch and stratum != "median"):
        raise InputError("sampling", "batch", f"expected medians, and a size that is a multiple of {batch}")
    if not isinstance(distributions, dict) or not all(
        hasattr(one, "stratum_medians") for one in distributions.values()
    ):
        distributions = load_distributions(distributions, "sampling")
    names = list(distributions)
    target = complete_correlation(correlation, names)
    parts = []
    for number in range(size // batch):
        variables = distributions.values()
        if number == 0:
            strata = [getattr(variable, f"stratum_{stratum}s")(batch) for variable in variables]
        else:
            inside = _places(batch, number, len(names), seed)
            chances = (np.arange(batch) + inside) / batch
            strata = [variable.quantile(chance) for variable, chance in zip(variables, chances, strict=True)]
        columns = np.column_stack(strata)
        order = arrange(_correlated(columns, kind), target, [seed, number] if number else seed, effort)
        parts.append(np.take_along_axis(columns, order, axis=0))
    values = np.concatenate(parts)
    reached = np.atleast_2d(np.corrcoef(_correlated(values, kind), rowvar=False))
    return SampleDesign(
        values=pd.DataFrame(values, columns=names, index=pd.RangeIndex(size, name="sample")),
        target=pd.DataFrame(target, index=names, columns=names),
        correlation=pd.DataFrame(reached, index=names, columns=names),
        kind=kind,
        stratum=stratum,
        seed=int(seed),
        effort=int(effort),
    )


def _places(size, number, n_variables, seed):
    """Places within its strata of an addition's values, float64 (n_variables, size) in (0, 1); 0 is the first design.

    Additions 1 and 2, 3 and 4 and so on are pairs.
    """
    pair, second = (number + 1) // 2, number % 2 == 0
    digits = np.array([int(one) for one in f"{pair:b}"[::-1]])
    off = 0.5 * float(digits @ 0.5 ** np.arange(1, len(digits) + 1))  # 1/4, 1/8, 3/8, ...
    bits = np.random.PCG64(np.random.SeedSequence([seed, pair], spawn_key=(2,)))
    above = (bits.random_raw(n_variables * size).reshape(n_variables, size) >> np.uint64(63)).astype(bool)
    return np.where(above != second, 0.5 + off, 0.5 - off)


def _correlated(values, kind):
    """Values that the correlation is of: the sampled ones, or their ranks from 0, equal ones at their mean rank."""
    return values if kind == "pearson" else scipy.stats.rankdata(values, axis=0) - 1.0


def _check_options(size, seed, stratum, kind, effort):
    for key, value, least in (("size", size, SMALLEST_SIZE), ("seed", seed, 0), ("effort", effort, 1)):
        if isinstance(value, bool) or not isinstance(value, (int, np.integer)) or value < least:
            raise InputError("sampling", key, f"expected a whole number of at least {least}, not {value!r}")
    if size > LARGEST_SIZE:
        raise InputError("sampling", "size", f"expected at most {LARGEST_SIZE} samples, not {size}")
    words_of = {"stratum": (stratum, ("median", "mean")), "kind": (kind, ("pearson", "spearman"))}
    for key, (value, words) in words_of.items():
        if value not in words:
            raise InputError("sampling", key, f"expected one of {', '.join(words)}, not {value!r}")


def complete_correlation(correlation, names):
    """Target correlation of all variables, square: what is given, and zero for the rest.

    Parameters
    ----------
    correlation : pandas.DataFrame, str, path or None
        Square, names as index and columns; or its file.
    names : list of str
        All variables, in order.

    Raises
    ------
    InputError
        An unknown name, a parameter named twice, or no positive definite correlation matrix.
    """
    if correlation is None:
        return np.eye(len(names))
    if not isinstance(correlation, pd.DataFrame):
        correlation = load_correlation(correlation)
    where = correlation.attrs.get("source", "correlation")
    given = [str(name) for name in correlation.columns]
    variables = [known_as(name, names) for name in given]
    if None in variables:
        unknown = given[variables.index(None)]
        raise InputError(where, unknown, f"expected one of the random variables: {', '.join(names)}")
    if [str(name) for name in correlation.index] != given or len(set(variables)) < len(variables):
        raise InputError(
            where, "", "expected a square matrix, the same names, each once, in rows and columns"
        )
    matrix = correlation.to_numpy(dtype=float)
    check_correlation(matrix, given, where)
    places = [names.index(name) for name in variables]
    target = np.eye(len(names))
    target[np.ix_(places, places)] = (matrix + matrix.T) / 2.0
    np.fill_diagonal(target, 1.0)
    return target


def draw_design(ensemble):
    """`SampleDesign` of a configuration's ensemble: its own table, or a mapping with arguments of `draw_samples`.

    Own samples stay in their order; the correlation that they have is their target.
    """
    if ensemble.get("table"):
        values = load_design(ensemble["table"])
        reached = pd.DataFrame(
            np.atleast_2d(np.corrcoef(values, rowvar=False)), values.columns, values.columns
        )
        return SampleDesign(values, reached, reached, "pearson", "own", int(ensemble["seed"]), 0)
    given = (ensemble[key] for key in ("size", "seed", "distributions", "correlation"))
    return draw_samples(*given, batch=ensemble.get("batch"))
