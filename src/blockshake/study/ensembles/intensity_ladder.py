"""Levels of a ladder of intensities, as a configuration names them."""

import numpy as np
from pydantic import Field, model_validator

from blockshake.validation import Positive, Strict

_MOST = 1000  # scales of a ladder


class IntensityLevels(Strict):
    """Scales of a motion from the first to the highest, evenly; Zhou et al. (2023): 50 %, + 25 %."""

    first: Positive = Field(0.5, description="scale of the first test [1]")
    increment: Positive = Field(0.25, description="from one scale to the next [1]")
    highest: Positive = Field(4.0, description="where the ladder ends [1]")

    @model_validator(mode="after")
    def _rises(self):
        if self.highest < self.first:
            raise ValueError("expected `highest` not below `first`")
        if self.highest - self.first > _MOST * self.increment:
            raise ValueError(f"expected at most {_MOST} scales")
        return self

    @property
    def scales(self):
        """Scales from the first to the highest, float64 array [1]."""
        count = int(np.floor((self.highest - self.first) / self.increment + 1e-9)) + 1
        return np.round(self.first + self.increment * np.arange(count), 12)
