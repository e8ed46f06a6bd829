"""The file of a synthetic motion (YAML): its keys, types and limits; whatever else is an error."""

from itertools import pairwise
from typing import Annotated, Literal

from pydantic import Field, model_validator

from blockshake.files import load_yaml
from blockshake.validation import Count, Positive, Strict, validated

_MOST_STEPS = 200_000  # a quarter of an hour at 200 Hz; each round of matching walks through all
InnerFraction = Annotated[Positive, Field(lt=1)]


class Ordinate(Strict):
    """One point of the target response spectrum."""

    period: Positive = Field(description="[s]")
    acceleration: Positive = Field(description="pseudo-acceleration at 5 % damping [m/s2]")
    published: bool = Field(False, description="from a publication; otherwise inferred")


class Source(Strict):
    """Point source that gives the Fourier spectrum its first shape."""

    moment_magnitude: Annotated[Positive, Field(lt=10)]
    epicentral_distance: Positive = Field(description="[m]; stated for the record, the model does not use it")
    stress_drop: Positive = Field(description="[Pa]")
    shear_wave_velocity: Positive = Field(description="at the source [m/s]")
    kappa: Positive = Field(description="high-frequency decay exp(-pi kappa f) [s]")


class Envelope(Strict):
    """Saragoni-Hart window of the noise."""

    significant_duration: Positive = Field(description="between 5 and 95 % of the window's energy [s]")
    peak: InnerFraction = Field(description="time of the peak as a share of the window's length [1]")
    level: InnerFraction = Field(description="height at the window's end as a share of the peak [1]")


class SyntheticMotion(Strict):
    """The whole file."""

    name: str
    synthetic: Literal[True]
    description: str
    seed: Count
    time_step: Positive = Field(description="[s]")
    duration: Positive = Field(description="[s]")
    peak_acceleration: Positive = Field(description="of the finished record, exact [m/s2]")
    high_pass_frequency: Positive = Field(description="corner below which the motion has nothing [Hz]")
    source: Source
    envelope: Envelope
    target_spectrum: tuple[Ordinate, ...] = Field(min_length=2)

    @model_validator(mode="after")
    def _consistent(self):
        periods = [ordinate.period for ordinate in self.target_spectrum]
        if any(later <= earlier for earlier, later in pairwise(periods)):
            raise ValueError("expected target_spectrum in order of rising period")
        if not 100.0 <= self.duration / self.time_step <= _MOST_STEPS:
            raise ValueError(f"expected a duration of 100 to {_MOST_STEPS} time steps")
        if self.high_pass_frequency * self.duration < 0.1:
            raise ValueError("expected high_pass_frequency of a period of at most ten durations")
        return self


def load_synthetic(path):
    """Checked parameters of a synthetic motion.

    Raises
    ------
    InputError
        Missing file, unknown or missing key, value of the wrong type or out of range.
    """
    return validated(SyntheticMotion, load_yaml(path), path)
