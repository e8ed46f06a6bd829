"""The verdict of a diagnosis, in a file whose form is fixed and versioned."""

from pathlib import Path
from typing import Literal

from pydantic import Field, JsonValue, model_validator

from blockshake.diagnosis.answer.decision import Estimate
from blockshake.diagnosis.verdict.ladder import ESTABLISHED, NOTHING, ONE_OF, PROBABLE, UNKNOWN
from blockshake.files import load_json, write_json
from blockshake.validation import Count, Finite, Fraction, Strict, validated

VERSION = 3
OF_A_GAIN = 0.9  # probability of the interval of a gain


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
    """The file ``gain.json``: gain on the sealed tests, on rows and on responses, caveats, and simulated tests."""

    rows: Gain | None = None
    gain: Gain | None = None
    caveats: tuple[str, ...] = ()
    runs: Count = 0


class Misfit(Strict):
    """Largest chance of the readings without any cause, and the place of the largest departure."""

    p: Fraction
    where: str


class Outside(Strict):
    """The likeliest form of a cause that no effect of the registry is."""

    form: str
    title: str = Field(description="in words")
    place: dict[str, JsonValue] = Field(
        description="{body: name, height: over the body's own} or {joint: [lower, upper]}"
    )
    places: tuple[str, ...] = Field(description="in words, all that cannot be told from it")
    size: dict[str, Estimate] = Field(description="by name of the size")
    starts: dict[str, Finite] = Field(description="by test, of a form that starts [s]")


class Verdict(Strict):
    """The whole file."""

    version: Literal[VERSION] = VERSION
    decision: Literal["none", "named", "ambiguous", "combination", "unknown"]
    causes: tuple[str, ...] = Field(description="names of the registry: the set that is not excluded")
    probabilities: dict[str, Fraction] = Field(description="by name, among all rivals and none, coarsened")
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
    runs: Count = Field(description="simulated tests")
    caveats: tuple[str, ...] = ()
    outside: Outside | None = Field(
        None, description="form from outside that is not excluded, beside the causes or where there are none"
    )
    odds: dict[str, Finite] = Field(
        {},
        description="by cause or form: logarithm of the odds of the likeliest in its part of the readings over it",
    )
    places: dict[str, tuple[str, ...]] = Field({}, description="by cause: places that cannot be told apart")
    limits: dict[str, dict[str, Finite]] = Field(
        {}, description="by effect and place: size from which it would have been seen, in its own unit"
    )
    word: Literal[ESTABLISHED, PROBABLE, ONE_OF, UNKNOWN, NOTHING] = Field(
        description="rung of the ladder of words: how strong a statement is made"
    )
    missing: tuple[str, ...] = Field((), description="what a probable cause lacks to be called established")
    row_gain: Gain | None = Field(
        None,
        description="share of the sealed tests' unexplained forces that the causes explain at their frozen sizes",
    )

    @model_validator(mode="after")
    def _consistent(self):
        count = len(self.causes)
        allowed = {
            "none": count == 0,
            "named": count == 1,
            "ambiguous": count > 1 or (count == 1 and self.outside is not None),
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


def load_gain(path):
    """`MeasuredGain` of a file."""
    return validated(MeasuredGain, load_json(path), Path(path))
