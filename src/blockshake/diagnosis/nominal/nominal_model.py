"""The nominal model with its uncertainty: parameters, numerics, input, starting places, sensors."""

from dataclasses import dataclass, replace

import numpy as np

from blockshake.simulation.models import MODELS as SOLVERS
from blockshake.simulation.models import model_of
from blockshake.study.calibration.settings import HOLLOW, OTHERS
from blockshake.study.sampling.distributions import TABLE_2, Lognormal

MODELS = tuple(name for name, model in SOLVERS.items() if model.perturbation is not None)
# coefficients of variation of Table 2's concrete, about the values of the structure file
_FRICTION, _DENSITY, _MODULUS = (
    TABLE_2[name].cov
    for name in (
        "friction.concrete.concrete",
        "materials.concrete.density",
        "materials.concrete.youngs_modulus",
    )
)
_PLACE_SPREAD = 3e-4  # m, standard deviation of where a block stands, along x and y
_YAW_SPREAD = 2e-4  # rad, of how it is turned about z
_AMPLITUDE_SPREAD = 0.01  # of the motion's amplitude: how well a table follows
_FAST_SPREAD = 0.01  # of what is faster than its mean over some 0.1 s, in addition
# readings: noise over the stated one (standard deviation of its logarithm), its memory, shares lost and wrong, at most
_LOUDER, _MEMORY, _LOST, _WRONG = 0.1, 0.7, 0.03, 0.02
# twins: less than sensors resolve
_TWIN_PLACED = 2e-4  # m, standard deviation of where a twin's block stands, along x and y
_TWIN_TURNED = 1e-4  # rad, of how it is turned about z
_TWIN_AMPLITUDE = 1e-3  # of the motion: how well a measured base motion is known


@dataclass(frozen=True)
class Draw:
    """One nominal model."""

    model: str  # one of `MODELS`
    time_step: float  # [s]
    parameters: dict  # str to float; of the structure and of the solver, by dotted name
    amplitude: float  # of the motion over the commanded one [1]
    fast: float  # of what is faster in it than some 0.1 s, over the commanded one, less 1 [1]
    # str to float; ``louder``, over the stated noise [1], and the entries ``noise_memory``,
    # ``marker_dropouts`` and ``marker_outliers`` of `Instruments`
    noise: dict
    # float64 (n_bodies, 3); off the structure file: along x and y [m], turned about z [rad]
    places: np.ndarray
    seed: int  # of the sensors' noise


def draw_nominal(structure, model, number):
    """`Draw` of a nominal model, the same for the same `Structure`, name of the model and number.

    Notes
    -----
    Parameters are drawn independently with the scatter of Table 2 of Zhou et al. (2023) about the values of the
    structure file; contact stiffness goes with Young's modulus, about that of the structure's own blocks. The
    discretisation is uncertain too, since no measurement states which one is right: each model's `Perturbation` has its
    parameters. A diagnosis with one fixed discretisation calls every other one an effect; so does one with white noise
    alone, once readings have a memory, gaps and outliers.

    Nobody knows how flat faces are. Models that have a use for it draw the hollow of the blocks, one share of the
    smallest edge for all, with the prior of the calibration; a hollow that the structure file states is kept.
    """
    generator = np.random.default_rng([number, model_of(model).perturbation.stream])
    file = structure.file

    def scattered(mean, cov):
        return float(Lognormal(mean=mean, cov=cov).quantile(generator.random()))

    drawn = {
        f"friction.{'.'.join(entry.pair)}": scattered(entry.coefficient, _FRICTION)
        for entry in file.friction
        if entry.coefficient > 0.0
    }
    for name, material in file.materials.items():
        drawn[f"materials.{name}.density"] = scattered(material.density, _DENSITY)
    softer = scattered(1.0, _MODULUS)
    for name, material in file.materials.items():
        drawn[f"materials.{name}.youngs_modulus"] = material.youngs_modulus * softer
    numerics, time_step = _perturbed(generator, model_of(model), softer, structure)
    places = np.zeros((len(file.bodies), 3))
    free = np.array([not body.driven for body in file.bodies])
    places[free] = generator.normal(0.0, [_PLACE_SPREAD, _PLACE_SPREAD, _YAW_SPREAD], (free.sum(), 3))
    draw = Draw(
        model=model,
        time_step=time_step,
        parameters=drawn | numerics,
        amplitude=float(generator.normal(1.0, _AMPLITUDE_SPREAD)),
        fast=float(generator.normal(0.0, _FAST_SPREAD)),
        noise={
            "louder": float(np.exp(generator.normal(0.0, _LOUDER))),
            "noise_memory": float(generator.uniform(0.0, _MEMORY)),
            "marker_dropouts": float(generator.uniform(0.0, _LOST)),
            "marker_outliers": float(generator.uniform(0.0, _WRONG)),
        },
        places=places,
        seed=int(generator.integers(2**31)),
    )
    return replace(draw, parameters=draw.parameters | _hollows(generator, model_of(model), file))


def draw_twin(structure, model, number):
    """`Draw` of a twin of nominal draw 0, by its number from 1; twin 0 is draw 0.

    Blocks of each stand 0.2 mm and 0.1 mrad elsewhere and the base moves 0.1 % differently (standard deviations); the
    first also has half the time step. Its sensors have the noise of draw 0: twins are apart by what they do alone.
    """
    draw = draw_nominal(structure, model, 0)
    if number == 0:
        return draw
    generator, free = np.random.default_rng([number, *model.encode()]), ~structure.driven
    moved = np.zeros_like(draw.places)
    moved[free] = generator.normal(0.0, [_TWIN_PLACED, _TWIN_PLACED, _TWIN_TURNED], (free.sum(), 3))
    return replace(
        draw,
        places=draw.places + moved,
        amplitude=draw.amplitude * (1.0 + generator.normal(0.0, _TWIN_AMPLITUDE)),
        time_step=draw.time_step / (2.0 if number == 1 else 1.0),
    )


def _hollows(generator, model, file):
    """Depths of the faces of all boxes that can move and state none [m], by dotted name; empty without a use."""
    if HOLLOW in model.without_effect:
        return {}
    share = float(OTHERS[HOLLOW].value(generator.random()))
    moved = {body.shape for body in file.bodies if not body.driven}
    return {
        f"shapes.{name}.hollow": share * min(shape.box)
        for name, shape in file.shapes.items()
        if name in moved and shape.box is not None and not shape.hollow
    }


def _perturbed(generator, model, softer, structure):
    """Numerical parameters and time step [s] of a nominal model, drawn in the order of the table of models."""
    usual = {name: default for name, (default, *_) in model.numerical_parameters().items()}
    usual |= {"restitution": structure.file.restitution, **model.stiffness_of(structure)}
    numerics = {name: usual[name] * softer for name in model.stiffness} | model.perturbation.fixed
    for parameter in model.perturbation.uncertain:
        drawn = float(generator.uniform(parameter.lower, parameter.upper))
        numerics[parameter.name] = usual[parameter.name] * drawn if parameter.relative else drawn
    steps = model.perturbation.time_steps
    return numerics, steps[0] if len(steps) == 1 else float(generator.choice(steps))
