"""The configuration of a study: every key, its type and its limits, checked before the first job."""

import re
from pathlib import Path
from typing import Annotated, Any, Literal

from pydantic import (
    BeforeValidator,
    ConfigDict,
    Discriminator,
    Field,
    StringConstraints,
    Tag,
    field_validator,
    model_validator,
)

from blockshake.dynamics.baseline import AUTO, Baseline
from blockshake.dynamics.record_set import Intensity, is_record_set
from blockshake.errors import InputError, faults_of
from blockshake.files import load_yaml
from blockshake.measurement.sensors.markers import RATE
from blockshake.simulation.models import solver_of
from blockshake.statistics.intervals import SURE_FROM
from blockshake.study.analyses import ANALYSES
from blockshake.study.calibration.settings import CalibrationSettings
from blockshake.study.config_checks import check_named
from blockshake.study.ensembles.case_input import COMMANDED, MEASURED
from blockshake.study.ensembles.intensity_ladder import IntensityLevels
from blockshake.study.limit_states.settings import LimitState
from blockshake.study.sampling.distributions import (
    LINKED,
    TABLE_2,
    Distribution,
    known_as,
    load_distributions,
)
from blockshake.study.sampling.latin_hypercube import LARGEST_SIZE, SMALLEST_SIZE
from blockshake.study.sampling.sample_table import load_design
from blockshake.validation import Count, Positive, Strict, Whole, validated


def _links(ensemble):
    """Links of Table 2 to the variables that an ensemble samples."""
    return {
        name: source for name, source in LINKED.items() if source in ensemble.get("distributions", TABLE_2)
    }


def _as_text(given):
    """The text of a date, which YAML reads as a number where it is a year."""
    return str(given) if isinstance(given, int) and not isinstance(given, bool) else given


def _share(given):
    """A share of a text such as ``2 %``."""
    if isinstance(given, str) and (found := re.fullmatch(r"\s*([\d.]+)\s*%\s*", given)):
        return float(found[1]) / 100.0
    return given


Accuracy = Annotated[Positive | None, BeforeValidator(_share)]


class Until(Strict):
    """Half the width of 95 % limits, of all cases and models, from which on a study does not grow."""

    collapse_probability: Accuracy = Field(None, description="of the probability of a collapse [1]")
    limit_states: Accuracy = Field(None, description="of the probability of every limit state [1]")
    median_drift: Accuracy = Field(
        None, description="of the median of each case's largest displacement, over that median [1]"
    )

    @model_validator(mode="before")
    @classmethod
    def _with_words(cls, given):
        """A key of two words is written with a blank too."""
        if isinstance(given, dict):
            return {key.replace(" ", "_") if isinstance(key, str) else key: one for key, one in given.items()}
        return given

    @model_validator(mode="after")
    def _is_stated(self):
        if not any(self.model_dump().values()):
            raise ValueError(f"expected one of {', '.join(type(self).model_fields)}")
        return self


class Ensemble(Strict):
    """The samples: how many, of which variables, how correlated; or a table of own ones."""

    model_config = ConfigDict(json_schema_extra=lambda schema: schema["required"].remove("size"))

    table: str | None = Field(
        None,
        description="CSV of own samples, a row each, columns the dotted names of the variables: in place of `size`, "
        "`distributions` and `correlation`",
    )
    size: Whole = Field(
        ge=SMALLEST_SIZE,
        le=LARGEST_SIZE,
        description="samples; without `batch` another size is another design: all samples change [1]",
    )
    batch: Whole | None = Field(
        None,
        ge=SMALLEST_SIZE,
        description="size of the first Latin hypercube and of every addition to it, of which `size` is a multiple: "
        "samples and runs of a smaller size are kept; none: one hypercube [1]",
    )
    until: Until | None = Field(
        None,
        description="accuracy from which on no `batch` is added, with `size` the largest; none: all of `size`",
    )
    seed: Count = Field(description="of the design [1]")
    distributions: dict[str, Distribution] = Field(
        TABLE_2,
        description="random variables by dotted name, as `blockshake parameters` lists them; Table 2's by default",
    )
    correlation: str | None = Field(
        None, description="CSV of the target correlation; none means uncorrelated"
    )
    linked: dict[str, str] = Field(
        default_factory=_links,
        description="parameters that take another's sampled value, by dotted names; Table 2's by default",
    )

    @model_validator(mode="before")
    @classmethod
    def _of_table(cls, given):
        if not isinstance(given, dict) or not isinstance(given.get("table"), str):
            return given
        with faults_of("", "ensemble.table"):
            values = load_design(given["table"])
            columns = {
                name: {"distribution": "empirical", "values": sorted(column.tolist())}
                for name, column in values.items()
            }
            tabled = {"size": len(values), "distributions": load_distributions(columns, given["table"])}
        for key in ("size", "distributions", "correlation"):
            said = given.get(key)  # a report prints what the table gave
            if key == "distributions" and said is not None:
                said = load_distributions(said, "ensemble")
            if said not in (None, tabled.get(key)):
                raise InputError("", f"ensemble.{key}", "expected no such key with `table`, which tells it")
        return given | tabled

    @model_validator(mode="after")
    def _grows(self):
        if self.until is not None and self.batch is None:
            raise ValueError("expected `batch`, by which samples are added, with `until`")
        if self.batch is not None and (self.table or self.size % self.batch):
            raise ValueError("expected `batch` next to a `size` that is a multiple of it, and no table")
        return self

    @field_validator("distributions", mode="before")
    @classmethod
    def _known_variables(cls, mapping):
        if isinstance(mapping, dict) and all(hasattr(one, "stratum_medians") for one in mapping.values()):
            return mapping
        return load_distributions(mapping, "ensemble")


class ModelSettings(Strict):
    """One model of the study: a solver with settings."""

    time_step: Positive = Field(description="of the integration [s]")
    parameters: dict[str, float | int | str | bool] = Field(
        {}, description="of the solver, the same in all samples, by dotted name"
    )


class Measured(Strict):
    """The measured test that a case is compared with."""

    campaign: str = Field(description="folder of a campaign of the same structure, by its content")
    test: str = Field(description="name of the test in it, not a sealed one")


def _defaults_follow(schema):
    """Take the keys whose defaults follow from other keys off those that a JSON schema requires."""
    schema["required"] = [key for key in schema["required"] if key not in ("name", "input")]


class StudyCase(Strict):
    """One structure under one motion."""

    model_config = ConfigDict(json_schema_extra=_defaults_follow)

    name: str = Field(
        description="names the case in the report and in paths; by default the name of the structure's file. Two cases "
        "of one structure, under two motions say, need names"
    )
    structure: str = Field(description="shipped name or file")
    motion: str = Field(
        description="shipped name or file; or a folder of records, or a CSV table of them: each sample draws one"
    )
    scale: Positive = Field(1.0, description="multiplies the motion [1]")
    intensity: Intensity | None = Field(
        None,
        description="how strong the motions are stated to be and, with `levels`, scaled to be, before `scale`; by "
        "default the peak ground acceleration where the samples draw records: docs/guide/records.md",
    )
    baseline: Baseline = AUTO
    duration: Positive = Field(description="simulated time [s]")
    samples: dict[str, Count] = Field(
        {},
        description="fewer samples than the ensemble's, at least 1, by model: the first rows of the design. With fewer "
        "than three the case has no distances, widths or scores of that model, and with fewer than six no limits of "
        "them and no replicate",
    )
    measured: Measured | None = Field(None, description="none: compared with no test")
    input: Literal[MEASURED, COMMANDED] = Field(
        description="motion that drives the models: the slab's in the measured test, each sample by its own draw of "
        "it, or the commanded one; by default the measured one where there is any. Reasons: decision 9",
    )

    @model_validator(mode="before")
    @classmethod
    def _with_defaults(cls, given):
        if not isinstance(given, dict):
            return given
        motion = given.get("motion")
        return {
            "name": Path(str(given.get("structure", ""))).stem,
            "input": MEASURED if given.get("measured") else COMMANDED,
            "intensity": {} if isinstance(motion, str) and is_record_set(motion) else None,
        } | given

    @model_validator(mode="after")
    def _has_input(self):
        if self.input == MEASURED and self.measured is None:
            raise ValueError(f"expected input: {COMMANDED}, as there is no measured test")
        if self.intensity is not None and self.measured is not None:
            raise ValueError("expected no `measured` with records or `intensity`: no test had these motions")
        return self


class Ladder(IntensityLevels):
    """The intensities that samples climb, and the drift that counts as a potential collapse."""

    largest_drift: (
        Annotated[
            Annotated[Positive, Tag("(number)")] | Annotated[dict[str, Positive], Tag("(by name)")],
            Discriminator(lambda given: "(by name)" if isinstance(given, dict) else "(number)"),
        ]
        | None
    ) = Field(
        None,
        description="displacement of a block relative to the slab that counts as a potential collapse, of all blocks; "
        "or by block, and slip by joint, `{block-1: 0.2, block-1/block-2: 0.1}`; by default half of each block's own "
        "smaller horizontal width [m]",
    )


class FragilitySettings(Strict):
    """Samples that climb the ladder, each until its potential collapse."""

    model: str = Field("nscd-rigid", description="model that climbs, one of the study's")
    cases: tuple[str, ...] = Field(min_length=1, description="names of cases of the study")
    size: Whole = Field(
        20, ge=3, description="samples that climb: the first rows of the design, no more than there are [1]"
    )


class ExtensionSettings(Strict):
    """An effect that a diagnosis found, as `blockshake extend-study` writes it: its effect is given by pairs of
    cases."""

    cases: dict[str, str] = Field(
        min_length=1,
        description="by the name of a case whose structure states an `extension`, that of the same case without",
    )
    named_by: tuple[str, ...] = Field(
        (),
        description="those of the former whose measured test the cause was named by: no test of a prediction",
    )


class Diagnosis(Strict):
    """Which measured campaigns are diagnosed, and how thoroughly."""

    campaigns: tuple[str, ...] = Field((), description="folders of the campaigns")
    effort: Literal["quick", "standard", "deep"] = Field(
        "standard", description="how many tests are simulated: docs/guide/diagnosis.md"
    )


class StudyConfig(Strict):
    """The whole file."""

    name: str = Field(
        pattern=r"^[a-z0-9-]+$",
        max_length=100,
        description="names results/NAME, logs/NAME and reports/NAME.html; lower case, digits, hyphens",
    )
    description: Annotated[str, StringConstraints(strip_whitespace=True)] = Field(
        description="one sentence for the report"
    )
    project: str = Field("", description="for the head of the report, as `author` and `date`")
    author: str = Field("", description="who answers for the study")
    date: Annotated[str, BeforeValidator(_as_text)] = Field(
        "", description="of the report; it is yours to state, since the same results give the same bytes"
    )
    output_rate: Positive = Field(
        RATE, description="of the histories; the default is that of the paper's optical system [Hz]"
    )
    samples_per_job: Whole = Field(
        10, ge=1, description="samples in one job; a killed job resumes at the sample, whatever this is [1]"
    )
    models: dict[str, ModelSettings] = Field(
        min_length=1,
        description="by name: a solver's, or a solver's with words of yours after it, such as `ls-dem-as-printed`. "
        "Models of one solver run the same samples, and the report states how each differs from that of the plain name",
    )
    structure: dict[str, Any] | None = Field(
        None,
        description="keys of a structure file; a case takes them whose `structure` names this file itself",
    )
    cases: tuple[StudyCase, ...] = Field(min_length=1)
    ensemble: Ensemble
    ladder: Ladder = Ladder()
    fragility: FragilitySettings | None = Field(None, description="none: no sample climbs the ladder")
    limits: dict[str, LimitState] = Field(
        {}, description="limit states of yours by name, such as `statue tips: {body: statue, tilt: 5 deg}`"
    )
    calibration: CalibrationSettings | None = Field(
        None, description="none: friction, restitution and contact stiffness are taken as they are"
    )
    extension: ExtensionSettings | None = Field(
        None, description="none: no case has a cause more than another"
    )
    diagnosis: Diagnosis = Field(Diagnosis(), description="none: no campaign is diagnosed")

    @model_validator(mode="after")
    def _names_that_are_known(self):
        """Models of solvers, and frictions by the names of the distributions, whose materials may be in other order."""
        for name in self.models:
            solver_of(name)
        known = self.ensemble.distributions

        def known_name(name):
            return known_as(name, known) or name

        linked = {target: known_name(source) for target, source in self.ensemble.linked.items()}
        changes = {"ensemble": self.ensemble.model_copy(update={"linked": linked})}
        if (settings := self.calibration) is not None:
            ranges = {known_name(name): span for name, span in settings.ranges.items()}
            if len(ranges) < len(settings.ranges):
                raise InputError("", "study.calibration.ranges", "expected every pair once")
            named = {
                "ranges": ranges,
                "linked": {known_name(name): known_name(source) for name, source in settings.linked.items()},
            }
            if settings.parameters is not None:
                named["parameters"] = tuple(map(known_name, settings.parameters))
            changes["calibration"] = settings.model_copy(update=named)
        return self.model_copy(update=changes)

    def case(self, name):
        """The case of this name."""
        return next(case for case in self.cases if case.name == name)

    def nominal(self, case):
        """The case without the cause that a `StudyCase` has, or the case itself."""
        pairs = self.extension.cases if self.extension else {}
        return next((one for one in self.cases if one.name == pairs.get(case.name)), case)

    def named_motions(self):
        """Key, name and baseline of every case's motion or set of records."""
        return [(f"cases.{index}", case.motion, case.baseline) for index, case in enumerate(self.cases)]

    def samples(self, model, case):
        """Number of samples of a case by a model."""
        return min(self.case(case).samples.get(model, self.ensemble.size), self.ensemble.size)

    def has_replicate(self, model, case):
        """Whether the first sample of a case by a model is run again at half the step, for the floor of numerics."""
        return self.samples(model, case) >= SURE_FROM


def load_config(path):
    """Configuration from a YAML file, checked with all that it names.

    Raises
    ------
    InputError
        Unknown key, missing file, wrong structure or motion, a sample size below 10 and the like.
    """
    config = check_config(load_yaml(path), path)
    named = {Path(case.structure).resolve() for case in config.cases}
    if config.structure is not None and Path(path).resolve() not in named:
        raise InputError(path, "structure", "expected a case whose `structure` names this file")
    return config


def check_config(mapping, where):
    """Configuration from a mapping, checked with all that it names; ``where`` is its file."""
    config = validated(StudyConfig, mapping, where)
    structures = check_named(config, where)
    for analysis in ANALYSES:
        settings = getattr(config, analysis.settings) if analysis.settings else None
        if settings is not None:
            analysis.check(settings, config, structures, where)
    return config
