"""The plan of the cases, and the places of their campaigns, truths and verdicts."""

from dataclasses import dataclass
from pathlib import Path
from typing import Annotated, Literal

from outside_forces import OUTSIDE
from pydantic import Field, model_validator

from blockshake.diagnosis.libraries.plan import result_name
from blockshake.effects.registry import EFFECTS
from blockshake.files import file_digest, load_yaml
from blockshake.validation import Strict, validated

ROOT = Path(__file__).parents[1]
SEEDS = Path(__file__).parent / "seeds.yaml"
SMALL_SEEDS = Path(__file__).parent / "small-seeds.yaml"
TRACK_RECORD = ROOT / "data" / "track-record" / "hidden-effects.json"
PAGE = ROOT / "docs" / "hidden-effects.md"
Seed = Annotated[int, Field(strict=True, ge=0)]


class PlannedCase(Strict):
    """A case to be made; its name says nothing of what is hidden."""

    name: str
    seed: Seed
    structure: str = "two-blocks"
    truth: str
    size: Literal["small", "large"] | None = None
    sealed: bool = Field(False, description="whether it has sealed tests, on which a gain is measured")

    @model_validator(mode="after")
    def _known(self):
        if self.truth not in ("none", *EFFECTS, *OUTSIDE) or (self.size is not None) != (
            self.truth in EFFECTS
        ):
            raise ValueError("expected none, a cause from outside, or an effect with its size")
        return self


class PlanFile(Strict):
    """The file ``seeds.yaml``."""

    efforts: dict[str, Literal["quick", "standard", "deep"]] = Field(
        {"two-blocks": "standard"}, description="by structure: effort of the diagnosis of its cases"
    )
    cases: tuple[PlannedCase, ...]
    removed: tuple[str, ...] = Field(
        description="cases that are diagnosed again without their effect among the candidates"
    )


@dataclass(frozen=True)
class Plan:
    """Cases of the long tests.

    Attributes
    ----------
    efforts : dict of str to str
        By structure.
    cases : tuple of PlannedCase
    removed : tuple of str
    digest : str
        Of the file.
    """

    efforts: dict
    cases: tuple
    removed: tuple
    digest: str


def load_plan(path=SEEDS):
    """The plan of the long tests."""
    file = validated(PlanFile, load_yaml(path), path)
    return Plan(file.efforts, file.cases, file.removed, file_digest(path))


def campaign_of(results, name):
    """Folder of a case's campaign, which the diagnosis is given."""
    return Path(results) / "campaigns" / name


def truth_of(results, name):
    """Folder of a case's truth, which the diagnosis is not given."""
    return Path(results) / "truths" / name


def verdict_of(results, name, without=None):
    """File of the verdict on a case, with all candidates or with one effect left out."""
    result = result_name(campaign_of(results, name), () if without is None else (without,))
    return ROOT / "results" / "diagnosis" / result / "verdict.json"
