"""Random variables of the study: log-normal, by dotted parameter name, Table 2 by default."""

import re
from typing import Literal

import numpy as np
from pydantic import Field
from scipy.special import ndtr, ndtri

from blockshake.errors import InputError
from blockshake.quantities import PHYSICAL
from blockshake.simulation.models import CALIBRATED
from blockshake.validation import Positive, Strict, validated

_PROPERTIES = {
    quantity.name.rsplit(".", 1)[1]: quantity.unit
    for quantity in PHYSICAL
    if quantity.name.startswith("materials.MATERIAL.")
}
_WORD = r"[^\s./]+"
_NAME = re.compile(
    rf"friction\.({_WORD})\.({_WORD})|materials\.{_WORD}\.(?:{'|'.join(_PROPERTIES)})|shapes\.{_WORD}\.hollow"
)


class Lognormal(Strict):
    """A positive variable whose logarithm is normal, given by its mean and coefficient of variation.

    The two parameters of the logarithm follow exactly: variance ``ln(1 + cov^2)`` and mean ``ln(mean) - variance / 2``.
    """

    distribution: Literal["lognormal"] = Field("lognormal", description="the one kind there is")
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

    def stratum_medians(self, size):
        """Medians of ``size`` strata of equal probability, rising, shape (size,)."""
        return self.quantile((np.arange(size) + 0.5) / size)

    def stratum_means(self, size):
        """Means of the variable within ``size`` strata of equal probability, rising, shape (size,).

        Notes
        -----
        The first moment of a log-normal variable up to a score ``z`` of its logarithm is
        ``mean * Phi(z - log_deviation)``, so that the average of these values is the mean exactly.
        """
        edges = ndtri(np.arange(size + 1) / size)
        return size * self.mean * np.diff(ndtr(edges - self.log_deviation))


def known_as(name, names):
    """Name among ``names`` of the parameter that a dotted name stands for, materials of a pair in either order.

    None where there is no such parameter among them.
    """
    return next((known for known in names if _identity(known) == _identity(name)), None)


def _identity(name):
    """The same for all names of one parameter."""
    match = _NAME.fullmatch(str(name))
    return tuple(sorted(match.group(1, 2))) if match and match.group(1) else name


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
        ``{name: {distribution: lognormal, mean: ..., cov: ...}}``, names as
        ``friction.MATERIAL.MATERIAL``, ``materials.MATERIAL.PROPERTY`` or ``shapes.SHAPE.hollow``. It replaces
        Table 2 as a whole: what it does not name is not random. None means Table 2.
    where : str
        File or option to name in an error.

    Returns
    -------
    dict of str to Lognormal
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
        if _NAME.fullmatch(str(name)) is None:
            raise InputError(
                where,
                f"distributions.{name}",
                "unknown parameter; expected friction.MATERIAL.MATERIAL, shapes.SHAPE.hollow or "
                f"materials.MATERIAL.PROPERTY with one of the properties {', '.join(_PROPERTIES)}",
            )
        if twin := known_as(name, variables):
            raise InputError(where, f"distributions.{name}", f"expected every pair once; it is {twin} too")
        variables[name] = validated(Lognormal, entry, where, f"distributions.{name}")
    return variables


def parameter_unit(name):
    """Unit of a sampled or derived parameter of a design by its dotted name, such as ``kg/m3``.

    Raises
    ------
    InputError
        No parameter that a design can hold.
    """
    if _NAME.fullmatch(name):
        kind, _, key = name.split(".")
        return {"friction": "1", "shapes": "m"}.get(kind) or _PROPERTIES[key]
    if name in CALIBRATED:
        return "N/m3"
    raise InputError(
        "design", name, "expected a friction coefficient, a material's property, a hollow or a stiffness"
    )


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
