"""The part of a verdict that is scored: what any program may write of a campaign, with this one's own verdicts."""

from pathlib import Path
from typing import Literal

from pydantic import BaseModel, ConfigDict, Field, JsonValue, model_validator

from blockshake.diagnosis.verdict.verdict import Gain
from blockshake.files import load_json
from blockshake.validation import Finite, validated


class Part(BaseModel):
    """A part of the file; keys that are not scored are passed over."""

    model_config = ConfigDict(extra="ignore", frozen=True)


class Interval(Part):
    """Ends of an interval of 90 %."""

    lower: Finite
    upper: Finite


class LoadShape(Part):
    """A cause that no effect of the registry is."""

    form: str = Field(
        description="push, blow, rope, drag, spring-and-damper, dry-drag, spring-once, loose-weight or changed-edge"
    )
    places: tuple[str, ...] = Field((), description="blocks on which it may act")
    starts: dict[str, Finite] = Field(default_factory=dict, description="by test, of a form that starts [s]")
    before: tuple[str, ...] = Field((), description="tests in which it started then or earlier")


class Answer(Part):
    """An answer on one campaign; all but ``decision`` and ``causes`` may be left out."""

    decision: Literal["none", "named", "ambiguous", "combination", "unknown"]
    causes: tuple[str, ...] = Field((), description="effects of the registry")
    outside: LoadShape | None = Field(None, description="a cause that no effect of the registry is")
    parameters: dict[str, dict[str, Interval]] = Field(
        default_factory=dict, description="by effect and parameter"
    )
    location: dict[str, dict[str, JsonValue]] = Field(
        default_factory=dict, description="by effect: {body: name}, {joint: [lower, upper]} or {marker: name}"
    )
    places: dict[str, tuple[str, ...]] = Field(
        default_factory=dict, description="by effect, all places that cannot be distinguished from it"
    )
    odds: dict[str, Finite] = Field(
        default_factory=dict, description="by cause: 0 of the most probable of each part, as a logarithm"
    )
    limits: dict[str, dict[str, Finite]] = Field(
        default_factory=dict, description="by effect and place: size from which it would have been detected"
    )
    gain: Gain | None = None
    row_gain: Gain | None = None

    @model_validator(mode="after")
    def _consistent(self):
        if self.decision in ("none", "unknown") and self.causes:
            raise ValueError(f"expected no causes for '{self.decision}', found {', '.join(self.causes)}")
        if self.decision == "named" and len(self.causes) != 1:
            raise ValueError(f"expected one cause for 'named', found {len(self.causes)}")
        return self


def load_answer(path):
    """`Answer` of a file.

    Raises
    ------
    InputError
        Missing, not JSON, an unknown decision, or causes that contradict the decision.
    """
    return validated(Answer, load_json(path), Path(path))
