"""Settings of the fragility in a configuration."""

from pydantic import Field

from blockshake.simulation.models import ModelName
from blockshake.validation import Strict, Whole


class FragilitySettings(Strict):
    """Samples that climb the ladder, each until its potential collapse."""

    model: ModelName = Field("nscd-rigid", description="solver that climbs, one of the study's")
    cases: tuple[str, ...] = Field(min_length=1, description="names of cases of the study")
    size: Whole = Field(
        20, ge=3, description="samples that climb: the first rows of the design, no more than there are [1]"
    )
