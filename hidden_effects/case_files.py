"""The plans of the cases, and the places of their campaigns, truths and verdicts."""

import re
from collections import Counter
from pathlib import Path
from typing import Annotated, Literal

from case_plan import STRENGTHS
from make_case import LABORATORIES
from outside_forces import OUTSIDE
from pydantic import Field, model_validator

from blockshake.diagnosis.verdict.track_record import WHOLE
from blockshake.effects.registry import EFFECTS
from blockshake.errors import InputError
from blockshake.files import file_digest, load_yaml
from blockshake.validation import NotNegative, Strict, validated

ROOT = Path(__file__).parents[1]
SEEDS = Path(__file__).parent / "seeds.yaml"
CALIBRATION_SEEDS = Path(__file__).parent / "calibration-seeds.yaml"
OPEN_SEEDS = Path(__file__).parent / "open-seeds.yaml"
SMALL_SEEDS = Path(__file__).parent / "small-seeds.yaml"
TRACK_RECORD = ROOT / "data" / "track-record" / "hidden-effects.json"
PAGE = ROOT / "docs" / "results" / "hidden-effects.md"
README = ROOT / "README.md"
Seed = Annotated[int, Field(strict=True, ge=0)]


class PlannedCase(Strict):
    """A case to be made; its name states nothing of what is hidden."""

    name: str
    seed: Seed
    structure: str = "two-blocks"
    laboratory: Literal[*LABORATORIES] = "home"
    strength: Literal[*STRENGTHS] | None = Field(None, description="None: the tests of `case_plan.PLAN`")
    causes: tuple[Literal[*EFFECTS, *OUTSIDE], ...] = Field(
        (), max_length=2, description="none: a clean case"
    )
    size: Literal["small", "large"] | None = Field(None, description="of effects of the registry")
    gain: Literal["rows", "responses"] | None = Field(
        None, description="to be measured, on sealed tests: on the forces alone, or on the responses too"
    )
    hollow: NotNegative = Field(0.0, description="depth of the true blocks' faces, of LS-DEM [m]")

    @property
    def stratum(self):
        """Laboratory and kind: a part of a list keeps the shares of both."""
        kind = ("clean", "single", "pair")[len(self.causes)]
        return self.laboratory, kind if self.size or kind == "clean" else f"{kind} outside"

    @model_validator(mode="after")
    def _sized(self):
        if (self.size is not None) != any(name in EFFECTS for name in self.causes):
            raise ValueError("expected a size of an effect of the registry, and of nothing else")
        return self


class Plan(Strict):
    """Cases of a file of seeds, such as ``seeds.yaml``."""

    digest: str = Field(description="of the file")
    cases: tuple[PlannedCase, ...]

    part: str = Field(WHOLE, description="of the cases of the file")

    def chosen(self, part=WHOLE, laboratory=None):
        """The plan with a part of its cases, or of one laboratory.

        ``1/4`` is of every stratum the first of each four cases, ``3/4`` the first three, ``2-2/4`` the second.
        """
        match = re.fullmatch(r"(?:(\d+)-)?(\d+)/(\d+)", part)
        first, last, every = (int(number or 1) for number in match.groups()) if match else (1, 0, 0)
        if not 0 < first <= last <= every:
            raise InputError("share", part, "expected a share of the cases such as 1/4, or 2-2/4")
        met, cases = Counter(), []
        for case in self.cases:
            if laboratory in (None, case.laboratory):
                if first <= met[case.stratum] % every + 1 <= last:
                    cases.append(case)
                met[case.stratum] += 1
        return self.model_copy(update={"cases": tuple(cases), "part": part})


def load_plan(path=SEEDS):
    """The plan of a file of seeds."""
    return validated(Plan, {**load_yaml(path), "digest": file_digest(path)}, path)


def campaign_of(results, name):
    """Folder of a case's campaign, which the diagnosis is given."""
    return Path(results) / name / "campaign"


def truth_of(results, name):
    """File of a case's truth, which the diagnosis is not given."""
    return Path(results) / name / "truth" / "truth.json"


def failure_of(results, name):
    """File of the reason for which a case could not be made or diagnosed."""
    return Path(results) / name / "failure.json"


def verdict_of(results, name):
    """File of the verdict on a case."""
    return Path(results) / name / "verdict" / "verdict.json"
