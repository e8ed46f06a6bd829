"""The one table of solvers: a model is one row. The report alone adds words to some, docs/theory/adding-a-solver.md."""

import importlib
import re
from dataclasses import dataclass
from typing import Literal, NamedTuple

from blockshake.errors import Argument, InputError


class Uncertain(NamedTuple):
    """A parameter, by its dotted name, that stands for what is not known of a model's numerics.

    It is drawn evenly between two ends, in its unit or, where ``relative``, over its usual value [1].
    """

    name: str
    lower: float
    upper: float
    relative: bool = False


class Perturbation(NamedTuple):
    """How the numerics of a model differ between the nominal models of a diagnosis.

    ``stream`` of the seeds: no two models have the same, and none ever gets another. ``uncertain``: in the order in
    which they are drawn. ``time_steps``: one of them is taken [s]. ``fixed``: values of the parameters that differ from
    their defaults in all of the nominal models, by dotted name.
    """

    stream: int
    uncertain: tuple[Uncertain, ...]
    time_steps: tuple[float, ...]
    fixed: dict


@dataclass(frozen=True)
class Model:
    """A model of the blocks' contact and motion.

    Notes
    -----
    The driver and the class are named, not imported: a job that runs one solver neither imports nor watches the other.
    """

    name: str  # as in ``--model`` and in a study's configuration
    label: str  # as reports print it
    prefix: str  # of the dotted names of its numerical parameters
    time_step: float  # default [s]
    # ``module:function`` that runs it: ``(structure, motion, parameters, record_times, time_step,
    # checkpoint=)`` to a `Trajectory`
    driver: str
    parameters: str  # ``module:class`` of its numerical parameters
    # ``module:function`` that refuses, of a structure and numerical parameters, what the driver would
    refusal: str
    # those of them that a wave test gives from the material, as its contact stiffness
    calibrated: tuple[str, ...] = ()
    # ``module:function`` that gives their defaults for a structure: ``(structure)`` to a dict
    own_stiffness: str | None = None
    # last parts of the names of parameters that the model has no use for
    without_effect: tuple[str, ...] = ()
    needed: tuple[str, ...] = ()  # properties of the materials of free blocks that are above 0
    rigid: bool = True  # its blocks do not deform
    # None leaves the model out of the null hypothesis of a diagnosis
    perturbation: Perturbation | None = None

    def solve(self, *arguments, **options):
        """Run the driver."""
        return _named(self.driver)(*arguments, **options)

    def refuse(self, structure, numerical):
        """Raise an `InputError` where the driver would refuse a structure with these numerical parameters."""
        _named(self.refusal)(structure, numerical)

    @property
    def schema(self):
        """Class of the numerical parameters."""
        return _named(self.parameters)

    @property
    def stiffness(self):
        """Dotted names of the contact stiffness that a wave test gives; empty where the model has none."""
        return tuple(f"{self.prefix}.{name}" for name in self.calibrated)

    def stiffness_of(self, structure):
        """Default contact stiffness for a structure, by dotted name; empty where the model has none."""
        values = _named(self.own_stiffness)(structure) if self.own_stiffness else {}
        return {f"{self.prefix}.{name}": value for name, value in values.items()}

    @property
    def modules(self):
        """Names of the modules that the driver, the parameters and the stiffness are in."""
        named = (self.driver, self.parameters, self.own_stiffness)
        return tuple(name.partition(":")[0] for name in named if name)

    def numerical_parameters(self):
        """Default, unit, meaning and source of every numerical parameter, by dotted name."""
        table = {}
        for name, field in self.schema.model_fields.items():
            meaning, source = field.description.rsplit("; ", 1)
            unit = re.search(r"\[(.*?)\]", meaning)
            words = " ".join(meaning.replace(unit.group(0), "").split()).replace(" ;", ";")
            table[f"{self.prefix}.{name}"] = (field.default, unit.group(1), words, source)
        return table


MODELS = {
    model.name: model
    for model in (
        Model(
            name="ls-dem",
            label="LS-DEM",
            prefix="ls_dem",
            time_step=1e-5,
            driver="blockshake.solvers.ls_dem.driver:simulate_ls_dem",
            parameters="blockshake.solvers.ls_dem.parameters:LsDemParameters",
            refusal="blockshake.solvers.ls_dem.surfaces:check_shapes",
            calibrated=("normal_stiffness", "shear_stiffness"),
            own_stiffness="blockshake.solvers.ls_dem.parameters:own_stiffness",
            without_effect=(
                "viscous_modulus",
                "nscd_restitution",
            ),  # rigid blocks, and restitution of its own
            # the layout of the nodes, and the restitution that stands for damping
            perturbation=Perturbation(
                stream=0,
                uncertain=(
                    Uncertain("ls_dem.node_spacing", 0.75, 1.5, relative=True),
                    Uncertain("ls_dem.perimeter_inset", 0.6, 2.0, relative=True),
                    Uncertain("restitution", 0.8, 1.2, relative=True),
                ),
                time_steps=(5e-5,),
                fixed={},
            ),
        ),
        Model(
            name="nscd-rigid",
            label="NSCD rigid",
            prefix="nscd",
            time_step=1e-3,
            driver="blockshake.solvers.nscd.driver:simulate_nscd",
            parameters="blockshake.solvers.nscd.parameters:NscdParameters",
            refusal="blockshake.solvers.nscd.contact.polyhedra:check_convex",
            # rigid, bearing on corners, and of a restitution of its own
            without_effect=("viscous_modulus", "youngs_modulus", "poisson_ratio", "hollow", "restitution"),
            # a closer time step where bodies meet, as studies should: docs/theory/nscd.md
            perturbation=Perturbation(
                stream=1,
                uncertain=(Uncertain("nscd.shrink", 0.0, 0.02),),
                time_steps=(5e-4, 1e-3),
                fixed={"nscd.impact_parts": 20},
            ),
        ),
        Model(
            name="nscd-elastic",
            label="NSCD elastic",
            prefix="nscd_deformable",
            time_step=1e-3,
            driver="blockshake.solvers.nscd_deformable.driver:simulate_elastic",
            parameters="blockshake.solvers.nscd.parameters:DeformableParameters",
            refusal="blockshake.solvers.nscd_deformable.elastic_bodies:check_boxes",
            without_effect=("viscous_modulus", "hollow", "restitution"),
            rigid=False,
        ),
        Model(
            name="nscd-viscoelastic",
            label="NSCD viscoelastic",
            prefix="nscd_deformable",
            time_step=1e-3,
            driver="blockshake.solvers.nscd_deformable.driver:simulate_viscoelastic",
            parameters="blockshake.solvers.nscd.parameters:DeformableParameters",
            refusal="blockshake.solvers.nscd_deformable.elastic_bodies:check_boxes",
            without_effect=("hollow", "restitution"),
            needed=("viscous_modulus",),  # without one it is the elastic model
            rigid=False,
        ),
    )
}
ModelName = Literal[tuple(MODELS)]
# name of a model of a study: its solver's alone, or with words after it, such as ls-dem-as-printed
NAME_IN_STUDY = re.compile(rf"({'|'.join(MODELS)})((?:-[a-z0-9]+){{0,8}})")
CALIBRATED = tuple(name for model in MODELS.values() for name in model.stiffness)
_INSTEAD = {"restitution": "nscd_restitution", "nscd_restitution": "restitution"}
_PREFIXES = tuple(f"{model.prefix}." for model in MODELS.values())


def model_of(name):
    """Row of a model.

    Raises
    ------
    InputError
        No such model.
    """
    if name not in MODELS:
        raise InputError(Argument("model"), "", f"expected one of {', '.join(MODELS)}, not '{name}'")
    return MODELS[name]


def solver_of(name):
    """Row of the solver by which the name of a study's model begins: of ``ls-dem-as-printed`` that of ``ls-dem``.

    Raises
    ------
    InputError
        The name begins with no solver.
    """
    named = NAME_IN_STUDY.fullmatch(name)
    if named is None:
        solvers = ", ".join(MODELS)
        raise InputError(
            "",
            f"study.models.{name}",
            f"expected one of {solvers}, or one of these and words such as ls-dem-coarse",
        )
    return MODELS[named[1]]


def ignored_by(name, models):
    """Models, among names of models, that have no use for a parameter, and what they have in its place.

    Parameters
    ----------
    name : str
        Dotted.
    models : list of str

    Returns
    -------
    dict of str to str
        By model the name of its own parameter, empty where it has none. A solver's parameter is ignored by none where
        one of the models is of that solver.
    """
    chosen = [model_of(model) for model in models]
    if name.startswith(_PREFIXES):
        if any(name.startswith(f"{model.prefix}.") for model in chosen):
            return {}
        last = name.partition(".")[2]
        return {
            model.name: f"{model.prefix}.{last}" if last in model.schema.model_fields else ""
            for model in chosen
        }
    last = name.split(".")[-1]
    return {model.name: _INSTEAD.get(last, "") for model in chosen if last in model.without_effect}


def part_parameters(parameters):
    """Parameters of the structure and those of any solver, as two mappings."""
    numerical = {name: value for name, value in parameters.items() if name.startswith(_PREFIXES)}
    return {name: value for name, value in parameters.items() if name not in numerical}, numerical


def split_parameters(parameters, name):
    """Physical parameters, for the structure, and numerical ones, for the solver, of a flat mapping.

    Raises
    ------
    InputError
        A numerical parameter that its solver does not have, or a bad value.
    """
    from blockshake.validation import validated  # here, so that the help of the command line stays quick

    chosen = model_of(name)
    physical, numerical = part_parameters(parameters)
    settings = {}
    for model in MODELS.values():
        prefix = f"{model.prefix}."
        values = {
            key.removeprefix(prefix): value for key, value in numerical.items() if key.startswith(prefix)
        }
        if not values and model is not chosen:
            continue
        fields = model.schema.model_fields
        if unknown := [key for key in values if key not in fields]:
            wrong = f"expected one of {prefix}{{{', '.join(fields)}}}"
            raise InputError(Argument("parameters"), f"{prefix}{unknown[0]}", wrong)
        settings[model.name] = validated(model.schema, values, Argument("parameters"), model.prefix)
    return physical, settings[chosen.name]


def _named(path):
    module, _, name = path.partition(":")
    return getattr(importlib.import_module(module), name)
