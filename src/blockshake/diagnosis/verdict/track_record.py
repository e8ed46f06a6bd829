"""The track record of the procedure: how often it was right on tests whose truth was known."""

from pathlib import Path
from typing import Literal

from pydantic import Field, model_validator

from blockshake.files import load_json, write_json
from blockshake.sources import script_sources, source_digest
from blockshake.validation import Count, Finite, Fraction, Strict, validated

VERSION = 1


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
        return _met(self.estimate, self.goal, self.side)

    @model_validator(mode="after")
    def _consistent(self):
        if self.hits > self.n:
            raise ValueError(f"expected hits <= n, found {self.hits} of {self.n}")
        if self.n and not self.lower <= self.hits / self.n <= self.upper:
            raise ValueError("expected lower <= hits / n <= upper")
        return self


class Median(Strict):
    """A median over cases with its interval of 95 % from order statistics, where there are cases enough."""

    meaning: str
    n: Count
    estimate: Finite | None
    lower: Finite | None = None
    upper: Finite | None = None
    goal: Finite | None = None
    side: Literal["at most", "at least"] = "at least"

    @property
    def met(self):
        """Whether the goal is met; None without a goal or without cases enough for an interval."""
        return None if self.lower is None else _met(self.estimate, self.goal, self.side)

    @model_validator(mode="after")
    def _consistent(self):
        if (self.estimate is None) != (self.n == 0):
            raise ValueError("expected a median where there are cases, and none without")
        if (self.lower is None) != (self.upper is None):
            raise ValueError("expected both ends of the interval, or neither")
        if self.lower is not None and not self.lower <= self.estimate <= self.upper:
            raise ValueError("expected lower <= estimate <= upper")
        return self


class Answers(Strict):
    """Numbers of cases of one kind, by answer."""

    none: Count = Field(0, description="no effect")
    right: Count = Field(0, description="one name, the truth's")
    wrong: Count = Field(0, description="one name, another")
    set_with: Count = Field(0, description="a set that holds the truth")
    set_without: Count = Field(0, description="a set that does not")
    unknown: Count = Field(0, description="an effect that no known one explains")
    combination: Count = Field(0, description="several effects at once")

    @property
    def n(self):
        """Number of cases."""
        return sum(self.model_dump().values())


class Row(Strict):
    """A row of the confusion matrix: a truth and the answers to it."""

    truth: str = Field(description="name of an effect, or none")
    size: Literal["small", "large"] | None = None
    answers: Answers


class JudgedCase(Strict):
    """One case and its answer."""

    name: str
    seed: Count
    structure: str
    truth: str
    size: Literal["small", "large"] | None = None
    answer: Literal["none", "right", "wrong", "set_with", "set_without", "unknown", "combination"]
    causes: tuple[str, ...] = ()


class TrackRecord(Strict):
    """The whole file."""

    version: Literal[VERSION] = VERSION
    date: str = Field(description="day of the scoring, year-month-day")
    commit: str = Field(description="of the sources that were tried")
    procedure: str = Field(description="digest of the sources that decided")
    machine: str
    efforts: dict[str, str] = Field(description="by structure: effort of the diagnosis of its cases")
    seeds: str = Field(description="digest of the list of seeds, fixed before the run")
    shares: dict[str, Share]
    medians: dict[str, Median]
    confusion: tuple[Row, ...]
    cases: tuple[JudgedCase, ...]

    @property
    def counted(self):
        """Numbers of diagnoses and of campaigns in words: some are diagnosed again without their effect on the list."""
        return f"{len(self.cases)} diagnoses of {len({case.name for case in self.cases})} campaigns"

    @model_validator(mode="after")
    def _consistent(self):
        counted = sum(row.answers.n for row in self.confusion)
        if counted != len(self.cases):
            raise ValueError(f"expected {len(self.cases)} cases in the confusion matrix, found {counted}")
        return self


def procedure_digest():
    """Digest of the sources that decide today; a record of another is of an earlier program."""
    return source_digest(*script_sources("decide"))


def load_track_record(path):
    """`TrackRecord` of a file.

    Parameters
    ----------
    path : str or path
        ``data/track-record/hidden-effects.json``, which the long tests of hidden effects write.

    Raises
    ------
    InputError
        Missing, not JSON, another version, an unknown key, or figures that contradict each other.
    """
    return validated(TrackRecord, load_json(path), Path(path))


def write_track_record(path, record):
    """Write a track record as JSON."""
    write_json(path, record.model_dump(mode="json"))


def _met(estimate, goal, side):
    if estimate is None or goal is None:
        return None
    return estimate <= goal if side == "at most" else estimate >= goal
