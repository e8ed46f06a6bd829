"""Settings of the joint calibration in a configuration: which runs, and between which ends the parameters lie."""

from typing import Literal

import numpy as np
from pydantic import Field, model_validator

from blockshake.validation import Positive, Strict, Whole

FEWEST = 19  # samples with which a range of 95 % has an end: the largest excess of 19 stands for the 20th
RESTITUTION = "restitution"
STIFFNESS = "stiffness_factor"  # of k_n and k_s together, over those of the wave speed
HOLLOW = "hollow"  # of the faces of the structure's upright blocks, over their smallest edge


class Range(Strict):
    """Ends of a parameter about which nothing else is supposed."""

    lowest: Positive = Field(description="in the parameter's unit")
    highest: Positive = Field(description="in the parameter's unit")
    scale: Literal["linear", "log"] = Field("linear", description="on which values are drawn evenly")

    @model_validator(mode="after")
    def _rises(self):
        if self.highest <= self.lowest:
            raise ValueError("expected `highest` above `lowest`")
        return self

    def value(self, share):
        """Values that lie at shares, 0 to 1, of the way from the lowest to the highest."""
        share = np.asarray(share, dtype=float)
        if self.scale == "log":
            return self.lowest * (self.highest / self.lowest) ** share
        return self.lowest + (self.highest - self.lowest) * share

    def share(self, value):
        """Inverse of `value`."""
        value = np.asarray(value, dtype=float)
        if self.scale == "log":
            return np.log(value / self.lowest) / np.log(self.highest / self.lowest)
        return (value - self.lowest) / (self.highest - self.lowest)

    def stratum_medians(self, size):
        """Medians of ``size`` strata of equal probability, rising, shape (size,)."""
        return self.value((np.arange(size) + 0.5) / size)


FRICTION = Range(lowest=0.2, highest=1.0)
FRICTION_OF_STEEL = Range(lowest=0.1, highest=0.8)
OTHERS = {  # of contact springs: models without any have no use for them
    RESTITUTION: Range(lowest=0.05, highest=0.95),
    STIFFNESS: Range(lowest=0.03, highest=3.0, scale="log"),
    HOLLOW: Range(lowest=1e-5, highest=3e-3, scale="log"),
}


class CalibrationSettings(Strict):
    """Friction, restitution, stiffness and flatness of contacts by all open tests of some cases, by some models.

    With one parameter, the friction of concrete on concrete, this is the search of Zhou et al. (2023) for the mean
    whose envelope fits.
    """

    cases: dict[str, tuple[str, ...]] = Field(
        min_length=1, description="by model, one of the study's: names of cases with a measured test"
    )
    size: Whole = Field(
        40, ge=FEWEST, description="samples by which every test is simulated; fewer would give no range [1]"
    )
    tests: tuple[str, ...] | None = Field(
        None, min_length=1, description="names of the open tests that are simulated; by default all"
    )
    parameters: tuple[str, ...] | None = Field(
        None,
        min_length=1,
        description="those that are calibrated, the others as in the study; by default all that `ranges` may name",
    )
    linked: dict[str, str] = Field(
        {}, description="frictions that take the calibrated value of another parameter, by name"
    )
    ranges: dict[str, Range] = Field(
        {},
        description="by parameter: a friction of `ensemble.distributions`, `restitution`, `stiffness_factor`, of k_n "
        "and k_s over those of the wave speed, or `hollow` of the blocks' faces over their edge; by default friction "
        "0.2 to 1, of steel 0.1 to 0.8, restitution 0.05 to 0.95, stiffness 0.03 to 3, hollow 1e-5 to 3e-3",
    )

    def chosen(self, campaign):
        """Names of the open tests of a campaign that are simulated."""
        return [name for name in campaign.open if self.tests is None or name in self.tests]

    def steps(self, variables, model):
        """Mean number of steps of a sample by a `Model`, over that of the usual stiffness [1]."""
        springs = self.ranges_of(variables).get(STIFFNESS) if model.calibrated else None
        return float(np.sqrt(springs.stratum_medians(self.size)).mean()) if springs else 1.0

    def ranges_of(self, variables):
        """Ranges of all that is calibrated, by name: of every friction among the ``variables``, and of the others."""
        usual = {
            name: FRICTION_OF_STEEL if "steel" in name else FRICTION
            for name in variables
            if name.startswith("friction.")
        }
        spans = {**usual, **OTHERS, **self.ranges}
        return {name: spans[name] for name in self.parameters or spans if name not in self.linked}
