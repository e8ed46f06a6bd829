"""Noise of readings as the smoothing kernel leaves it: its variance, and its correlation from instant to instant."""

from typing import NamedTuple

import numpy as np
from scipy.special import erfc, erfcx


class Colour(NamedTuple):
    """Noise of a sort of readings, of the same memory, through a Gaussian kernel."""

    twice: (
        bool  # whether the kernel takes the second derivative, as of markers, or a mean, as of accelerometers
    )
    memory: float  # correlation time of the readings' noise [s]; 0: white

    def correlation(self, apart, width):
        """Correlation of two smoothed values ``apart`` in time (any shape) [s]; ``width`` is the kernel's [s]."""
        return self._covariance(np.abs(apart), width) / self._covariance(np.zeros(1), width)

    def variance(self, width):
        """Variance of a smoothed value, of coloured noise of variance 1."""
        return float(self._covariance(np.zeros(1), width)[0])

    def _covariance(self, apart, width):
        """Autocovariance of the smoothed noise, up to a factor where it is white.

        With the kernel's own autocorrelation g, a Gaussian of the width ``s = sqrt(2) w``, white noise has g or, under
        the second derivative, its fourth derivative. Noise with the autocorrelation ``exp(-|t| / T)`` has their
        convolution k, and, as ``k'' = k / T^2 - 2 g / T``, the fourth derivative ``k / T^4 - 2 g / T^3 - 2 g'' / T``.
        """
        spread, time = np.sqrt(2.0) * width, self.memory
        u = apart / spread
        bell = np.exp(-0.5 * u**2)
        if not time:
            return bell * (u**4 - 6.0 * u**2 + 3.0 if self.twice else 1.0)
        share = spread / time
        # what came before and what comes after, the latter scaled: no power overflows
        before = np.exp(0.5 * share**2 - share * u) * erfc((share - u) / np.sqrt(2.0))
        smoothed = 0.5 * (before + bell * erfcx((share + u) / np.sqrt(2.0)))
        if not self.twice:
            return smoothed
        density = bell / (np.sqrt(2.0 * np.pi) * spread)
        second = (u**2 - 1.0) / spread**2 * density
        return smoothed / time**4 - 2.0 * density / time**3 - 2.0 * second / time
