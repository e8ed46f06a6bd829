"""The track record of the procedure: how often it was right on tests whose truth was known."""

from pathlib import Path
from typing import Literal

from pydantic import ConfigDict, Field, model_validator

from blockshake.files import load_json
from blockshake.sources import script_sources, source_digest
from blockshake.validation import Count, Fraction, Strict, validated

VERSION = 2
WHOLE = "1/1"


class Share(Strict):
    """A share of cases with its interval and goal.

    The interval of 95 % is Clopper and Pearson's (1934): exact, never too narrow, 0 to 1 without cases.
    """

    meaning: str
    hits: Count
    n: Count
    lower: Fraction
    upper: Fraction
    goal: Fraction | None = None
    side: Literal["at most", "at least"] = "at least"

    @property
    def estimate(self):
        """Share of the cases [1]; None without any."""
        return self.hits / self.n if self.n else None

    @property
    def met(self):
        """Whether the goal is met; None without a goal or without cases."""
        return met(self.estimate, self.goal, self.side)

    @model_validator(mode="after")
    def _consistent(self):
        if self.hits > self.n:
            raise ValueError(f"expected hits <= n, found {self.hits} of {self.n}")
        if self.n and not self.lower <= self.hits / self.n <= self.upper:
            raise ValueError("expected lower <= hits / n <= upper")
        return self


class TrackRecord(Strict):
    """The part of a track record that a report tells; its file has more, for the page of the figures."""

    model_config = ConfigDict(extra="ignore")

    version: Literal[VERSION] = VERSION
    date: str = Field(description="day of the scoring, year-month-day")
    commit: str = Field(description="of the sources that were tried")
    procedure: str = Field(description="digest of the sources that decided")
    part: str = Field(WHOLE, description="of the list of cases that was judged")
    shares: dict[str, Share]
    laboratories: dict[str, dict[str, Share]] = Field(description="the same figures by laboratory")
    abroad: dict[str, Share] = Field(
        default_factory=dict, description="of all laboratories but the own one, `home`"
    )

    @property
    def worst(self):
        """Laboratory and share of every figure with a goal, by name, in the laboratory where it is worst.

        The later of two equals counts: it stands farther from home.
        """
        found = {}
        for name, pooled in self.shares.items():
            own = [(one, shares[name]) for one, shares in self.laboratories.items() if shares[name].n]
            if pooled.goal is not None and own:
                sign = 1.0 if pooled.side == "at most" else -1.0
                found[name] = max(reversed(own), key=lambda entry: sign * entry[1].estimate)
        return found

    @model_validator(mode="after")
    def _of_the_same_figures(self):
        for one, shares in self.laboratories.items():
            if shares.keys() != self.shares.keys():
                raise ValueError(f"expected the same figures of the laboratory {one} as of all")
        return self


def procedure_digest():
    """Digest of the sources that decide today; a record of another is of an earlier program."""
    return source_digest(*sorted({*script_sources("decide"), *script_sources("simulate_clean")}))


def load_track_record(path):
    """`TrackRecord` of a file.

    Parameters
    ----------
    path : str or path
        ``data/track-record/hidden-effects.json``, which the long tests of hidden effects write.

    Raises
    ------
    InputError
        Missing, not JSON, another version, or figures that contradict each other.
    """
    return validated(TrackRecord, load_json(path), Path(path))


def met(estimate, goal, side):
    """Whether a figure is on the right side of its goal; None without either."""
    if estimate is None or goal is None:
        return None
    return estimate <= goal if side == "at most" else estimate >= goal
