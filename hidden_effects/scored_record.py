"""The track record with all its figures, as its file has it and its page shows it."""

from typing import Literal

from pydantic import ConfigDict, Field, model_validator

from blockshake.diagnosis.verdict.track_record import TrackRecord, met
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
    structure: str
    truth: str
    size: Literal["small", "large"] | None = None
    answer: Literal["none", "right", "wrong", "set_with", "set_without", "unknown", "combination"]
    causes: tuple[str, ...] = ()


class ScoredRecord(TrackRecord):
    """The whole file."""

    model_config = ConfigDict(extra="forbid")

    machine: str
    efforts: dict[str, str] = Field(description="by structure: effort of the diagnosis of its cases")
    seeds: str = Field(description="digest of the list of seeds, fixed before the run")
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


def load_scored_record(path):
    """`ScoredRecord` of a file; an `InputError` where it is missing, has an unknown key or contradicts itself."""
    return validated(ScoredRecord, load_json(path), path)


def write_scored_record(path, record):
    """Write a record as JSON."""
    write_json(path, record.model_dump(mode="json"))
