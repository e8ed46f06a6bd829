"""Settings of a virtual campaign (YAML): what is tested, on which table, read by what, with which effect hidden."""

from pathlib import Path
from typing import Annotated

from pydantic import Field

from blockshake.dynamics.baseline import AUTO, Baseline, check_window
from blockshake.dynamics.load_motion import load_motion
from blockshake.effects.effect import Experiment
from blockshake.effects.registry import EFFECTS, with_effect
from blockshake.errors import InputError, faults_of
from blockshake.files import load_yaml
from blockshake.geometry.structure import load_structure
from blockshake.measurement.sensors.accelerometers import accelerometer_channels
from blockshake.measurement.sensors.instruments import Instruments, check_instruments
from blockshake.measurement.sensors.markers import RATE, driven_marker
from blockshake.simulation.limits import LONGEST_STEP, MOST_STEPS
from blockshake.simulation.models import ModelName, model_of, split_parameters
from blockshake.simulation.simulate import check_run
from blockshake.study.ensembles.intensity_ladder import IntensityLevels
from blockshake.validation import Count, Finite, NotNegative, Positive, Strict, validated
from blockshake.virtual.truth import hidden_effect

_FEWEST_READINGS = 40  # of a test
_Place = dict[str, str | tuple[str, str]]


class Intensities(IntensityLevels):
    """The ladder of strong tests of every motion, until a potential collapse."""

    largest_drift: Positive = Field(
        0.4, description="of a marker relative to the slab's, after which a motion's ladder ends [m]"
    )


class TableErrors(Strict):
    """How the table errs, as real ones do; the defaults follow the command exactly."""

    gain: Positive = Field(1.0, description="displacement along x over the command, far below the corner [1]")
    high: Finite = Field(0.0, description="by how much more or less that is far above the corner [1]")
    corner: Positive = Field(2.0, description="frequency between the two [Hz]")
    pitch: Finite = Field(0.0, description="static pitch by acceleration along x [rad s2/m]")


class Hidden(Strict):
    """The effect in the data; what is not said is drawn."""

    effect: str = Field(
        "drawn", description="name of an effect, `none`, or `drawn` by the seed from the registry"
    )
    values: dict[str, Finite] = Field({}, description="of its parameters")
    place: _Place | Annotated[tuple[_Place, ...], Field(min_length=1)] | None = Field(
        None, description="where, as in the verdict; of several the first that the structure has"
    )


class VirtualCampaign(Strict):
    """The whole file."""

    name: str
    seed: Count = Field(description="of all that is drawn")
    model: ModelName = "ls-dem"
    time_step: Annotated[Positive, Field(le=LONGEST_STEP)] | None = Field(
        None, description="the model's own by default [s]"
    )
    numerics: dict[str, float | str] = Field(
        {}, description="numerical parameters of the solver, by dotted name"
    )
    duration: Positive = Field(12.0, description="of a strong test [s]")
    motions: tuple[str, ...] = Field(("alkion", "basso-tirreno"), min_length=1)
    baseline: Baseline = AUTO
    intensities: Intensities = Intensities()
    table: TableErrors = TableErrors()
    misplacement: NotNegative = Field(
        3e-4, description="standard deviation of where a block is put, along x and y [m]"
    )
    survey_noise: NotNegative = Field(
        1e-4, description="of the survey of the blocks' places, and in rad of their turns [m]"
    )
    instruments: Instruments = Instruments()
    hidden: Hidden = Hidden()


def load_settings(path, structure=None):
    """Settings of a file, for tests of a structure, a shipped name or a file; None: it is not known yet.

    Raises
    ------
    InputError
        Unknown key, value out of range, a motion, an effect, a parameter or, in the structure, a place or a sensor that
        is not there.
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
    if len(set(stems)) < len(stems):
        raise InputError(path, "motions", "expected motions of different names")
    if settings.duration * RATE < _FEWEST_READINGS:
        raise InputError(path, "duration", f"expected at least {_FEWEST_READINGS / RATE:g} s")
    for motion in settings.motions:
        with faults_of(path, "motions"):
            read = load_motion(motion, settings.intensities.highest, settings.baseline)
        check_window(read, settings.duration, path, "duration")
    with faults_of(path, "numerics"):
        split_parameters(settings.numerics, settings.model)
    if structure is not None:
        _check_structure(settings, load_structure(structure), path)
    return settings


def _check_structure(settings, structure, path):
    """Refuse a structure without what the settings name, or that the model cannot simulate."""
    driven_marker(structure)
    motion = load_motion(settings.motions[0], baseline=settings.baseline)
    time_step = settings.time_step or model_of(settings.model).time_step
    steps = settings.duration / time_step
    if steps > MOST_STEPS:
        raise InputError(path, "duration", f"expected at most {MOST_STEPS:.0e} steps, not {steps:.2g}")
    with faults_of(path, "model"):
        check_run(structure, motion, settings.model, settings.numerics, time_step, settings.duration, RATE)
    with faults_of(path, "instruments"):
        check_instruments(settings.instruments, structure, accelerometer_channels(structure))
    with faults_of(path, "hidden"):
        effect = hidden_effect(settings.hidden, structure, settings.seed)
        if effect is not None:
            with_effect(Experiment(structure, motion, settings.instruments), **effect)
