"""Random variables of the study by dotted parameter name, of any distribution; Table 2 by default."""

import re
from typing import Annotated, Literal

import numpy as np
import scipy
from pydantic import ConfigDict, Field, ValidationError, field_validator, model_validator
from scipy.special import ndtr, ndtri

from blockshake.errors import InputError, faults_of
from blockshake.geometry.schema import EXTENSION
from blockshake.quantities import MOTION, unit_of, unit_of_number
from blockshake.simulation.models import MODELS, part_parameters
from blockshake.study.sampling.sample_table import load_design
from blockshake.validation import Finite, Positive, Strict, validated

_WORD = r"[^\s./]+"
_OF_PAIR = re.compile(rf"(friction|joints)\.({_WORD})\.({_WORD})(.*)")
_FINE = 64  # points of a stratum whose mean is taken


class _ByQuantiles(Strict):
    """A variable whose ``quantile(probability)`` is known."""

    @property
    def median(self):
        """Value with half the probability below it."""
        return float(self.quantile(0.5))

    def stratum_medians(self, size):
        """Medians of ``size`` strata of equal probability, rising, shape (size,)."""
        return self.quantile((np.arange(size) + 0.5) / size)

    def stratum_means(self, size):
        """Means of the variable within ``size`` strata of equal probability, rising, shape (size,)."""
        return self._points(size).mean(axis=1)

    def _points(self, size):
        return self.quantile((np.arange(size * _FINE) + 0.5) / (size * _FINE)).reshape(size, _FINE)


class Lognormal(_ByQuantiles):
    """A positive variable whose logarithm is normal, given by its mean and coefficient of variation.

    The two parameters of the logarithm follow exactly: variance ``ln(1 + cov^2)`` and mean ``ln(mean) - variance / 2``.
    """

    distribution: Literal["lognormal"] = Field(
        "lognormal", description="the usual kind; others are in docs/guide/sampling.md"
    )
    mean: Positive = Field(description="mean of the variable itself, SI")
    cov: Positive = Field(description="standard deviation over mean [1]")

    @property
    def log_deviation(self):
        """Standard deviation of the logarithm [1]."""
        return float(np.sqrt(np.log1p(self.cov**2)))

    @property
    def median(self):
        """Value with half the probability below it."""
        return float(self.mean / np.sqrt(1.0 + self.cov**2))

    def quantile(self, probability):
        """Values with the probabilities ``probability`` (float or array, in (0, 1)) below them."""
        return self.median * np.exp(self.log_deviation * ndtri(probability))

    def density(self, value):
        """Probability density at positive values, in one over the variable's unit."""
        score = np.log(np.asarray(value) / self.median) / self.log_deviation
        return np.exp(-0.5 * score**2) / (np.sqrt(2.0 * np.pi) * self.log_deviation * np.asarray(value))

    def stratum_means(self, size):
        """Means of the variable within ``size`` strata of equal probability, rising, shape (size,).

        Notes
        -----
        The first moment of a log-normal variable up to a score ``z`` of its logarithm is
        ``mean * Phi(z - log_deviation)``, so that the average of these values is the mean exactly.
        """
        edges = ndtri(np.arange(size + 1) / size)
        return size * self.mean * np.diff(ndtr(edges - self.log_deviation))


class Tabulated(_ByQuantiles):
    """A variable of any shape, such as a posterior, by its quantiles; straight between them."""

    distribution: Literal["tabulated"] = Field(description="quantiles")
    values: Annotated[tuple[Finite, ...], Field(min_length=2)] = Field(
        description="quantiles at even steps of the probability from 0 to 1, rising, SI"
    )

    @field_validator("values")
    @classmethod
    def _rising(cls, values):
        if not (np.diff(values) > 0.0).all():
            raise ValueError("expected values that rise")
        return values

    @property
    def mean(self):
        """Mean of the variable."""
        return float(np.mean(0.5 * np.add(self.values[1:], self.values[:-1])))

    @property
    def cov(self):
        """Standard deviation over the size of the mean [1], from the fine points of ten strata."""
        return float(self._points(10).std() / abs(self.mean)) if self.mean else np.inf

    def quantile(self, probability):
        """Values with the probabilities ``probability`` (float or array, in [0, 1]) below them."""
        return np.interp(probability, np.linspace(0.0, 1.0, len(self.values)), self.values)

    def density(self, value):
        """Probability density, in one over the variable's unit."""
        parts = 1.0 / (np.diff(self.values) * (len(self.values) - 1))
        part = np.searchsorted(self.values, value, side="right")
        return np.concatenate([[0.0], parts, [0.0]])[part]


class Discrete(_ByQuantiles):
    """A variable of some values: with probabilities, or those of a table, of which each is as likely as another."""

    distribution: Literal["discrete", "empirical"] = Field(
        description="values with probabilities, or of a table"
    )
    values: Annotated[tuple[Finite, ...], Field(min_length=2)] = Field(description="not falling, SI")
    probabilities: tuple[Positive, ...] | None = Field(
        None, description="of the values, sum 1; equal by default [1]"
    )

    @model_validator(mode="after")
    def _fits(self):
        if (np.diff(self.values) < 0.0).any() or self.values[0] == self.values[-1]:
            raise ValueError("expected values that rise")
        shares = self.probabilities
        if shares and (
            len(shares) != len(self.values) or not np.isclose(sum(shares), 1.0, rtol=0.0, atol=1e-6)
        ):
            raise ValueError("expected a probability for each value, and a sum of 1")
        return self

    @property
    def _shares(self):
        return np.array(self.probabilities or np.full(len(self.values), 1.0 / len(self.values)))

    @property
    def mean(self):
        """Mean of the variable."""
        return float(self._shares @ self.values)

    @property
    def cov(self):
        """Standard deviation over the size of the mean [1]."""
        variance = self._shares @ (np.array(self.values) - self.mean) ** 2
        return float(np.sqrt(variance) / abs(self.mean)) if self.mean else np.inf

    def quantile(self, probability):
        """Smallest values with at least the probabilities ``probability`` (float or array, in (0, 1)) up to them."""
        place = np.searchsorted(np.cumsum(self._shares) + 1e-9, probability)
        return np.array(self.values)[np.minimum(place, len(self.values) - 1)]

    def density(self, value):
        """NaN: there is no density."""
        return np.full(np.shape(value), np.nan)


class OfScipy(_ByQuantiles):
    """A continuous variable by its name in `scipy.stats`, whose other keys are its shape parameters there.

    ``mean`` and ``cov`` may stand in place of ``loc`` and ``scale``, which they then tell.
    """

    model_config = ConfigDict(extra="allow", frozen=True)
    __pydantic_extra__: dict[str, Finite] = Field(init=False)
    distribution: str = Field(description="name in scipy.stats; `normal` is its norm")
    loc: Finite = Field(0.0, description="as in scipy.stats, SI")
    scale: Positive = Field(1.0, description="as in scipy.stats, SI")

    @model_validator(mode="before")
    @classmethod
    def _by_moments(cls, given):
        moments = [given.get(name) for name in ("mean", "cov")]
        if {"loc", "scale"} & set(given) or not all(isinstance(one, (int, float)) for one in moments):
            return given
        rest = {name: value for name, value in given.items() if name not in ("mean", "cov")}
        try:
            standard = cls.model_validate(rest)._frozen
        except ValidationError:  # reported once the whole is validated
            return rest
        scale = moments[1] * abs(moments[0]) / float(standard.std())
        return rest | {"loc": moments[0] - scale * float(standard.mean()), "scale": scale}

    @model_validator(mode="after")
    def _is_known(self):
        if not isinstance(self._known, scipy.stats.rv_continuous):
            expected = "expected lognormal, tabulated, discrete, empirical, or the name of a continuous distribution "
            expected += f"of scipy.stats such as norm, uniform, truncnorm, not {self.distribution}"
            raise InputError("", "variable.distribution", expected)
        names = [name.strip() for name in (self._known.shapes or "").split(",") if name.strip()]
        for name in sorted(set(names) ^ set(self.model_extra)):
            expected = f"expected the keys {', '.join([*names, 'loc', 'scale'])}, as scipy.stats.{self._known.name} has"
            raise InputError("", f"variable.{name}", expected)
        if not np.isfinite([self.median, self.mean, self._frozen.std()]).all():
            raise ValueError(f"expected parameters by which {self.distribution} has a mean and a variance")
        return self

    @property
    def _known(self):
        return getattr(scipy.stats, _OTHER_NAMES.get(self.distribution, self.distribution), None)

    @property
    def _frozen(self):
        return self._known(**self.model_extra, loc=self.loc, scale=self.scale)

    @property
    def mean(self):
        """Mean of the variable."""
        return float(self._frozen.mean())

    @property
    def cov(self):
        """Standard deviation over the size of the mean [1]."""
        return float(self._frozen.std() / abs(self.mean)) if self.mean else np.inf

    def quantile(self, probability):
        """Values with the probabilities ``probability`` (float or array, in (0, 1)) below them."""
        return self._frozen.ppf(probability)

    def density(self, value):
        """Probability density, in one over the variable's unit."""
        return self._frozen.pdf(value)


_OTHER_NAMES = {"normal": "norm"}
Distribution = Lognormal | Tabulated | Discrete | OfScipy
_KINDS = {"lognormal": Lognormal, "tabulated": Tabulated, "discrete": Discrete, "empirical": Discrete}


def known_as(name, names):
    """Name among ``names`` of the parameter that a dotted name stands for, materials of a pair in either order.

    None where there is no such parameter among them.
    """
    return next((known for known in names if _identity(known) == _identity(name)), None)


def _identity(name):
    """The same for all names of one parameter."""
    match = _OF_PAIR.fullmatch(str(name))
    return (match[1], *sorted(match.group(2, 3)), match[4]) if match else name


TABLE_2 = {
    "friction.concrete.concrete": Lognormal(mean=0.75, cov=0.10),
    "friction.concrete.foundation": Lognormal(mean=0.75, cov=0.10),
    "friction.concrete.steel": Lognormal(mean=0.30, cov=0.10),
    "materials.concrete.density": Lognormal(mean=2400.0, cov=0.04),
    "materials.concrete.youngs_modulus": Lognormal(mean=3.45e10, cov=0.15),
    "materials.concrete.viscous_modulus": Lognormal(mean=1.5e8, cov=0.15),
    "materials.steel.density": Lognormal(mean=7700.0, cov=0.01),
    "materials.steel.youngs_modulus": Lognormal(mean=2.1e11, cov=0.03),
    "materials.steel.viscous_modulus": Lognormal(mean=2.1e9, cov=0.03),
}
"""Zhou et al. (2023), Table 2, by the dotted names of the structure file."""
LINKED = {
    "materials.foundation.youngs_modulus": "materials.concrete.youngs_modulus",
    "friction.steel.foundation": "friction.concrete.steel",
    "friction.steel.steel": "friction.concrete.steel",
}
"""Parameters that take the value of one of Table 2: the slab is of the blocks' concrete; steel slides alike on all."""


def load_distributions(mapping, where):
    """Random variables from the part of a config that lists them.

    Parameters
    ----------
    mapping : dict of str to dict, or None
        ``{name: {distribution: lognormal, mean: ..., cov: ...}}``, the keys of `Tabulated`, of `Discrete` (of an
        empirical one in place of ``values`` also ``file``, a CSV table, and ``column``, by default the variable's name)
        or of `OfScipy`; names are those of every number that ``--set`` takes, a part of a vector by its axis, such as
        ``friction.MATERIAL.MATERIAL`` or ``bodies.BODY.mass_offset.x``, ``motion.scale`` and ``motion.heading``, and
        of structures that state an extension ``extension.NAME``. It replaces Table 2 as a whole: what it does not name
        is not random. None means Table 2.
    where : str
        File or option to name in an error.

    Returns
    -------
    dict of str to Lognormal, Tabulated, Discrete or OfScipy
        In the order of the mapping.

    Raises
    ------
    InputError
        Unknown name or key, a friction pair given twice, a mean or COV that is not positive.
    """
    if mapping is None:
        return dict(TABLE_2)
    if not isinstance(mapping, dict) or not mapping:
        raise InputError(where, "distributions", "expected a mapping of parameter names to distributions")
    variables = {}
    for name, entry in mapping.items():
        if _unit(str(name)) is None:
            raise InputError(
                where,
                f"distributions.{name}",
                "unknown parameter; expected motion.scale, motion.heading, extension.NAME or a number that "
                "`blockshake parameters` lists, a part of a vector by its axis such as bodies.BODY.mass_offset.x",
            )
        if twin := known_as(name, variables):
            raise InputError(where, f"distributions.{name}", f"expected every pair once; it is {twin} too")
        said = entry.get("distribution", "lognormal") if isinstance(entry, dict) else "lognormal"
        if said == "empirical" and "file" in entry:
            entry = _of_table(name, entry, where)
        variables[name] = validated(
            _KINDS.get(said, OfScipy) if isinstance(said, str) else Lognormal,
            entry,
            where,
            f"distributions.{name}",
        )
    return variables


def _of_table(name, entry, where):
    """Entry of an empirical variable with the values of its column."""
    given = dict(entry)
    path, column = given.pop("file"), given.pop("column", name)
    with faults_of(where, f"distributions.{name}.file"):
        values = load_design(path)
    if column not in values:
        expected = f"expected one of the columns of {path}: {', '.join(values)}"
        raise InputError(where, f"distributions.{name}.column", expected)
    return given | {"values": sorted(values[column].tolist())}


def _unit(name):
    """Unit of a parameter that may be random; None of no such one."""
    if name.startswith(EXTENSION):
        return unit_of(name.removeprefix(EXTENSION))
    if part_parameters({name: 0.0})[1]:
        return _unit_of_solver(name)
    return MOTION.get(name) or unit_of_number(name)


def _unit_of_solver(name):
    """Unit of a solver's parameter that is a number and no count; None of another."""
    for model in MODELS.values():
        default, unit, *_ = model.numerical_parameters().get(name, ("", None))
        if isinstance(default, float) or name in model.stiffness:
            return unit
    return None


def parameter_unit(name):
    """Unit of a sampled or derived parameter of a design by its dotted name, such as ``kg/m3``.

    Raises
    ------
    InputError
        No parameter that a design can hold.
    """
    if unit := _unit(name):
        return unit
    raise InputError("design", name, "expected a number of the structure, of the motion or of a solver")


def draw_true_parameters(seed, means):
    """One independent draw of variables of Table 2 by dotted name, SI: the hidden truth of a virtual test.

    Parameters
    ----------
    seed : int
    means : dict of str to float
        Mean of every variable that is drawn; the coefficients of variation are Table 2's.
    """
    bits = np.random.PCG64(np.random.SeedSequence(seed, spawn_key=(1,))).random_raw(len(TABLE_2))
    chances = ((bits >> np.uint64(11)) + 0.5) * 2.0**-53
    return {
        name: float(Lognormal(mean=means[name], cov=distribution.cov).quantile(chance))
        for (name, distribution), chance in zip(TABLE_2.items(), chances, strict=True)
        if name in means
    }
