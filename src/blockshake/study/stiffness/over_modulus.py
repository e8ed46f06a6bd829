"""Calibrated stiffness of the samples over a modulus: whether it is one number, and whether density adds to it."""

from typing import NamedTuple

import scipy

ONE_NUMBER = 1e-3  # relative spread below which a ratio counts as one number in all samples
_LEVEL = 0.05  # chance at or below which a correlation is shown


class OverModulus(NamedTuple):
    """Stiffness over modulus in the samples: mean [1/m], largest over smallest less 1, and correlation of both [1]."""

    mean: float
    spread: float
    correlation: float

    @property
    def is_one_number(self):
        """Whether stiffness follows from the modulus alone."""
        return self.spread < ONE_NUMBER


def over_modulus(stiffness, modulus):
    """`OverModulus` of float64 arrays, shape (n_samples,): stiffness per area [N/m3] and modulus [Pa]."""
    ratio = stiffness / modulus
    return OverModulus(
        float(ratio.mean()),
        float(ratio.max() / ratio.min() - 1.0),
        float(scipy.stats.pearsonr(stiffness, modulus).statistic),
    )


def grows_with_density(stiffness, modulus, density):
    """Whether stiffness at an equal modulus rises with the density [kg/m3] beyond chance, by Spearman's correlation.

    Arrays as of `over_modulus`. A ratio that is one number does not.
    """
    if over_modulus(stiffness, modulus).is_one_number:
        return False
    correlation = scipy.stats.spearmanr(stiffness / modulus, density)
    return bool(correlation.statistic > 0.0 and correlation.pvalue <= _LEVEL)
