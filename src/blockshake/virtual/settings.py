"""Settings of a virtual campaign (YAML): what is tested, on which table, read by what, with which effect hidden."""

from pathlib import Path
from typing import Annotated

from pydantic import Field, model_validator

from blockshake.dynamics.baseline import AUTO, Baseline
from blockshake.effects.registry import EFFECTS
from blockshake.errors import InputError
from blockshake.files import load_yaml
from blockshake.measurement.sensors.instruments import Instruments
from blockshake.simulation.models import ModelName
from blockshake.validation import Finite, NotNegative, Positive, Strict, validated
from blockshake.virtual.table import Table


class Intensities(Strict):
    """The ladder of strong tests of every motion; Zhou et al. (2023): 50 %, + 25 % until a potential collapse."""

    first: Positive = Field(0.5, description="scale of the first test [1]")
    increment: Annotated[float, Field(ge=0.01, allow_inf_nan=False)] = Field(0.25, description="[1]")
    highest: Positive = Field(4.0, description="[1]")
    largest_drift: Positive = Field(
        0.4, description="of a marker relative to the slab's, after which a motion's ladder ends [m]"
    )

    @model_validator(mode="after")
    def _rising(self):
        if self.first > self.highest:
            raise ValueError("expected first <= highest")
        return self


class Sine(Strict):
    """A test of low amplitude before the first strong one and after each: the slab's acceleration along x."""

    frequency: Positive = Field(description="[Hz]")
    acceleration: Positive = Field(description="amplitude [m/s2]")
    duration: Positive = Field(4.0, description="of which the first and last fifth swell and fade [s]")


class Hidden(Strict):
    """The effect in the data; what is not said is drawn."""

    effect: str = Field(
        "drawn", description="name of an effect, `none`, or `drawn` by the seed from the registry"
    )
    values: dict[str, Finite] = Field({}, description="of its parameters")
    place: dict[str, str | tuple[str, str]] | None = Field(None, description="where, as in the verdict")


class VirtualCampaign(Strict):
    """The whole file."""

    name: str
    seed: int = Field(ge=0, description="of all that is drawn")
    model: ModelName = "ls-dem"
    time_step: Positive | None = Field(None, description="the model's own by default [s]")
    numerics: dict[str, float | str] = Field(
        {}, description="numerical parameters of the solver, by dotted name"
    )
    duration: Positive = Field(12.0, description="of a strong test [s]")
    motions: tuple[str, ...] = Field(("alkion", "basso-tirreno"), min_length=1)
    baseline: Baseline = AUTO
    intensities: Intensities = Intensities()
    sine: Sine | None = None
    table: Table = Table()
    restored: bool = Field(
        True, description="the stack is put back before a test; otherwise it starts as the last left it"
    )
    misplacement: NotNegative = Field(
        3e-4, description="standard deviation of where a block is put, along x and y [m]"
    )
    survey_noise: NotNegative = Field(
        1e-4, description="of the survey of the blocks' places, and in rad of their turns [m]"
    )
    instruments: Instruments = Instruments()
    hidden: Hidden = Hidden()


def load_settings(path):
    """Settings of a file.

    Raises
    ------
    InputError
        Unknown key, value out of range, an effect or a parameter that the registry lacks.
    """
    settings = validated(VirtualCampaign, load_yaml(path), path)
    hidden = settings.hidden
    if hidden.effect not in ("drawn", "none", *EFFECTS):
        raise InputError(path, "hidden.effect", f"expected drawn, none or one of {', '.join(EFFECTS)}")
    if hidden.effect in ("drawn", "none") and (hidden.values or hidden.place):
        raise InputError(path, "hidden", "expected values and place of a named effect only")
    known = [item.name for item in EFFECTS[hidden.effect].parameters] if hidden.effect in EFFECTS else []
    for name in hidden.values:
        if name not in known:
            raise InputError(path, f"hidden.values.{name}", f"expected one of {', '.join(known)}")
    stems = [Path(motion).stem for motion in settings.motions]
    if len(set(stems)) < len(stems) or (settings.sine and "sine" in stems):
        raise InputError(
            path, "motions", "expected motions of different names, none called sine beside `sine`"
        )
    return settings
