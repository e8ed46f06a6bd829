"""The track record with all its figures, as its file has it and its page shows it."""

from typing import Literal

from pydantic import ConfigDict, Field, model_validator

from blockshake.diagnosis.verdict.track_record import WHOLE, TrackRecord, met
from blockshake.diagnosis.verdict.verdict import Contrast
from blockshake.files import load_json, write_json
from blockshake.validation import Count, Finite, Strict, validated


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
        return None if self.lower is None else met(self.estimate, self.goal, self.side)

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
    laboratory: str = "home"
    strength: str | None = None
    structure: str
    truth: str
    unseen: bool = Field(False, description="a cause from outside that moves no marker")
    size: Literal["small", "large"] | None = None
    answer: Literal["none", "right", "wrong", "set_with", "set_without", "unknown", "combination"]
    causes: tuple[str, ...] = ()


class GainedCase(Strict):
    """Gains of one case over the nominal model, by rigid contact dynamics; None where nothing is there to gain."""

    name: str
    laboratory: str
    truth: str
    size: Literal["small", "large"] | None = None
    answer: str
    proposed: bool = Field(description="whether the verdict proposes an extension")
    rows: Contrast | None = Field(None, description="gain on the forces, over the recalibrated model")
    found: Contrast | None = Field(None, description="gain of the extension on the responses")
    oracle: Contrast | None = Field(None, description="gain of the true causes on them")


class ScoredRecord(TrackRecord):
    """The whole file."""

    model_config = ConfigDict(extra="forbid")

    machine: str
    seeds: str = Field(description="digest of the list of seeds, fixed before the run")
    medians: dict[str, Median]
    confusion: tuple[Row, ...]
    gains: tuple[GainedCase, ...] = ()
    failed: tuple[str, ...] = Field((), description="cases that could not be made or diagnosed")
    cases: tuple[JudgedCase, ...]

    @property
    def counted(self):
        """Number of cases in words, and which part of the list they are."""
        part = "" if self.part == WHOLE else f", {self.part} of each stratum"
        failed = f"; {len(self.failed)} more could not be made or diagnosed" if self.failed else ""
        return f"{len(self.cases)} campaigns{part}{failed}"

    @model_validator(mode="after")
    def _consistent(self):
        counted = sum(row.answers.n for row in self.confusion)
        if counted != len(self.cases):
            raise ValueError(f"expected {len(self.cases)} cases in the confusion matrix, found {counted}")
        return self


def load_scored_record(path):
    """`ScoredRecord` of a file; an `InputError` where it is missing, has an unknown key or contradicts itself."""
    return validated(ScoredRecord, load_json(path), path)


def write_scored_record(path, record):
    """Write a record as JSON."""
    write_json(path, record.model_dump(mode="json"))
