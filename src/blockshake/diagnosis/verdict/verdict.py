"""The verdict of a diagnosis, in a file whose form is fixed and versioned."""

from pathlib import Path
from typing import Literal

import numpy as np
from pydantic import Field, JsonValue, model_validator

from blockshake.diagnosis.answer.decision import Cause, Estimate, History, Measurement
from blockshake.diagnosis.verdict.grade import ESTABLISHED, NOT_JUDGED, NOTHING, ONE_OF, PROBABLE, UNKNOWN
from blockshake.files import load_json, write_json
from blockshake.statistics.resampling import limits_of
from blockshake.tables.shown import Shown
from blockshake.validation import Count, Finite, Fraction, Strict, validated

VERSION = 4
OF_A_GAIN = 0.9  # probability of the interval of a gain


class Contrast(Strict):
    """Gain against one rival with its 90 % interval; 1 is all that could be gained."""

    estimate: Finite
    lower: Finite
    upper: Finite

    @classmethod
    def cut_off(cls, estimate, lower, upper):
        """The gain from -1 to 1; an interval of few draws that misses its estimate is widened to it."""
        ends = {"estimate": estimate, "lower": min(lower, estimate), "upper": max(upper, estimate)}
        return cls(**{name: float(np.clip(value, -1.0, 1.0)) for name, value in ends.items()})

    @property
    def gains(self):
        """Whether anything is gained: the whole interval is above 0."""
        return self.lower > 0.0

    @classmethod
    def of_errors(cls, rival, extended):
        """Share of a rival's error that the extended model removes: both once, and then with tests drawn again."""
        values = (rival - extended) / np.maximum(rival, 1e-12)
        return cls.cut_off(values[0], *limits_of(values[1:], OF_A_GAIN))


NOTHING_TO_GAIN = Contrast(estimate=0.0, lower=-1.0, upper=1.0)


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
    select: Contrast | None = Field(
        None,
        description="on responses of the tests to select by, over the nominal model; none without such tests",
    )
    caveats: tuple[str, ...] = ()
    runs: Count = 0

    @property
    def proposes(self):
        """Whether the model with the causes is proposed: not where it gains nothing on the tests to select by."""
        return self.select is None or self.select.gains


class Misfit(Strict):
    """Largest chance of the readings without any cause, and the place of the largest departure."""

    p: Fraction
    where: str


class Outside(Strict):
    """The most probable form of a cause that no effect of the registry is."""

    form: str
    title: str = Field(description="in words")
    place: dict[str, JsonValue] = Field(
        description="{body: name, height: share of its own} or {joint: [lower, upper]}"
    )
    places: tuple[str, ...] = Field(description="in words, all that cannot be distinguished from it")
    size: dict[str, Estimate] = Field(description="by name of the size")
    starts: dict[str, Finite] = Field(description="by test, of a form that starts [s]")
    before: tuple[str, ...] = Field(
        (), description="tests in which it started then or earlier, before any joint opened"
    )


class Verdict(Shown, Strict):
    """The whole file; `Verdict` in docs/guide/contracts.md states what each field holds."""

    version: Literal[VERSION] = VERSION  # type: ignore[valid-type]
    decision: Literal["none", "named", "ambiguous", "combination", "unknown"]
    causes: tuple[str, ...]
    probabilities: dict[str, Fraction]
    parameters: dict[str, dict[str, Estimate]] = Field(default_factory=dict)
    location: dict[str, dict[str, str | tuple[str, str]]] = Field(default_factory=dict)
    misfit: Misfit
    excluded_above: dict[str, Finite] = Field(default_factory=dict)
    next_test: str | None = None
    gain: Gain | None = None
    runs: Count
    caveats: tuple[str, ...] = ()
    outside: Outside | None = None
    odds: dict[str, Finite] = Field(default_factory=dict)
    places: dict[str, tuple[str, ...]] = Field(default_factory=dict)
    limits: dict[str, dict[str, Finite]] = Field(default_factory=dict)
    word: Literal[ESTABLISHED, PROBABLE, ONE_OF, UNKNOWN, NOTHING, NOT_JUDGED]  # type: ignore[valid-type]
    missing: tuple[str, ...] = ()
    row_gain: Gain | None = None
    next_tests: tuple[Measurement, ...] = ()
    extension: tuple[Cause, ...] = Field(
        (),
        description="the most probable cause of every part, by which a study is extended; empty where they gain "
        "nothing on the tests to select by",
    )
    histories: tuple[History, ...] = Field((), description="sizes from test to test")
    structure: str = Field("", description="digest of what was tested, by its content")
    tests: dict[str, str] = Field(
        default_factory=dict, description="digests of the files that it was judged by"
    )

    def _words(self):
        outside = [self.outside.title] if self.outside else []
        return ", ".join([f"{self.word} ({self.decision})", *self.causes, *outside])

    def _rows(self):
        yield "cause", "probability", "size", "with 90 % limits"
        for cause, probability in self.probabilities.items():
            sizes = self.parameters.get(cause, {}).items()
            words = [f"{name} {one.estimate:.3g} {one.unit}" for name, one in sizes]
            limits = [f"{one.lower:.3g} to {one.upper:.3g}" for _, one in sizes]
            yield cause, f"{probability:.3g}", "; ".join(words), "; ".join(limits)

    @model_validator(mode="after")
    def _consistent(self):
        count = len(self.causes)
        allowed = {
            "none": count == 0,
            "named": count == 1,
            "ambiguous": count > 1 or (count == 1 and self.outside is not None),
            "combination": count > 1 or (count == 1 and self.outside is not None),
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
