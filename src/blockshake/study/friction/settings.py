"""Settings of the friction calibration in a configuration."""

import numpy as np
from pydantic import Field

from blockshake.simulation.models import ModelName
from blockshake.study.sampling.latin_hypercube import SMALLEST_SIZE
from blockshake.validation import Positive, Strict, Whole


class FrictionSearch(Strict):
    """The search of the mean coefficient of friction that fits the measured tests."""

    model: ModelName = Field("nscd-rigid", description="solver of the ensembles, one of the study's")
    cases: tuple[str, ...] = Field(min_length=1, description="names of the cases, each searched by itself")
    variables: tuple[str, ...] = Field(
        min_length=1, description="coefficients searched together, by dotted name"
    )
    lowest: Positive = Field(0.3, description="Zhou et al. (2023), section friction calibration [1]")
    highest: Positive = Field(0.8, description="the same [1]")
    step: Positive = Field(0.1, description="distance of the first candidates [1]")
    finest: Positive = Field(0.025, description="how near the ends of the accepted range are located [1]")
    size: Whole = Field(50, ge=SMALLEST_SIZE, description="samples of an ensemble [1]")
    replicates: Whole = Field(3, ge=2, description="independent designs, for error bars [1]")

    @property
    def runs(self):
        """Simulated samples of a case at most: the first candidates, and halves at both ends of what is accepted."""
        first = round((self.highest - self.lowest) / self.step) + 1
        halves = max(0, int(np.ceil(np.log2(self.step / self.finest) - 1e-9)))
        return (first + 2 * halves) * self.size * self.replicates
