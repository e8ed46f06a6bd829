"""The verdict of a diagnosis, in a file whose form is fixed and versioned."""

from pathlib import Path
from typing import Literal

from pydantic import Field, model_validator

from blockshake.diagnosis.laws.findings import OutsideForce
from blockshake.diagnosis.verdict.ladder import ESTABLISHED, NOTHING, ONE_OF, PROBABLE, UNKNOWN
from blockshake.files import load_json, write_json
from blockshake.validation import Finite, Fraction, Strict, validated

VERSION = 2


class Estimate(Strict):
    """A parameter of a named effect with its 90 % interval."""

    estimate: Finite
    lower: Finite
    upper: Finite
    unit: str

    @model_validator(mode="after")
    def _ordered(self):
        if not self.lower <= self.estimate <= self.upper:
            raise ValueError("expected lower <= estimate <= upper")
        return self


class Contrast(Strict):
    """Gain against one rival with its 90 % interval; 1 is all that could be gained."""

    estimate: Finite
    lower: Finite
    upper: Finite


class Gain(Strict):
    """Gain on sealed tests of the extended model against its rivals."""

    recalibrated: Contrast
    nominal: Contrast
    discrepancy: Contrast
    placebo: Contrast | None = Field(None, description="none where the cause has no other place")


class MeasuredGain(Strict):
    """The file ``gain.json``: gain on the sealed tests, on responses and laws, caveats, and simulated tests."""

    gain: Gain | None
    laws: Contrast | None = None
    caveats: tuple[str, ...]
    runs: int


class Misfit(Strict):
    """Chance of the tests by any nominal model, and the place of the largest misfit."""

    p: Fraction
    where: str


class BrokenLaw(Strict):
    """A law of the joints that the tests break, see ``docs/diagnosis.md``."""

    name: str
    unit: str
    measured: dict[str, Finite] = Field(description="by test, in the unit")
    departures: dict[str, Finite] = Field(description="by test, in standard deviations of the nominal model")


class Verdict(Strict):
    """The whole file."""

    version: Literal[VERSION] = VERSION
    decision: Literal["none", "named", "ambiguous", "combination", "unknown"]
    causes: tuple[str, ...] = Field(description="names of the registry: the set that is not excluded")
    probabilities: dict[str, Fraction] = Field(description="by name, conformal p value of each candidate")
    parameters: dict[str, dict[str, Estimate]] = Field({}, description="by cause and parameter")
    location: dict[str, dict[str, str | tuple[str, str]]] = Field(
        {},
        description="by cause, {joint: [lower body, upper body]}, {body: name}, {marker: name} or {channel: name}",
    )
    misfit: Misfit
    excluded_above: dict[str, Finite] = Field(
        {}, description="by name, size above which the tests would have shown it, in its own unit"
    )
    next_test: str | None = Field(None, description="the measurement that would decide")
    gain: Gain | None = Field(None, description="none before the sealed tests are opened")
    runs: int = Field(ge=0, description="simulated tests")
    caveats: tuple[str, ...] = ()
    laws: tuple[BrokenLaw, ...] = Field((), description="laws of the joints that the tests break")
    outside: OutsideForce | None = Field(
        None, description="force from outside that accounts for them where no effect of the registry does"
    )
    word: Literal[ESTABLISHED, PROBABLE, ONE_OF, UNKNOWN, NOTHING] = Field(
        description="rung of the ladder of words: how strong a statement is made"
    )
    missing: tuple[str, ...] = Field((), description="what a probable cause lacks to be called established")
    law_gain: Contrast | None = Field(
        None,
        description="against the recalibrated model, on the laws of the joints that the open tests break",
    )

    @model_validator(mode="after")
    def _consistent(self):
        count = len(self.causes)
        allowed = {
            "none": count == 0,
            "named": count == 1,
            "ambiguous": count > 1,
            "combination": count > 1,
            "unknown": count == 0,
        }
        if not allowed[self.decision]:
            raise ValueError(f"expected another number of causes than {count} for '{self.decision}'")
        if bool(self.missing) != (self.word == PROBABLE):
            raise ValueError("expected what is missing of a probable cause, and of nothing else")
        return self


def write_verdict(path, verdict):
    """Write a verdict as JSON, keys in the order of the contract."""
    write_json(path, verdict.model_dump(mode="json"))


def load_verdict(path):
    """Verdict of a file.

    Raises
    ------
    InputError
        Not JSON, another version, an unknown key, or a decision that its causes contradict.
    """
    return validated(Verdict, load_json(path), Path(path))
