"""The nominal model with all that is uncertain in it: parameters, numerics, input, starting places."""

from dataclasses import dataclass

import numpy as np

from blockshake.geometry.structure import load_structure
from blockshake.solvers.ls_dem.parameters import LsDemParameters
from blockshake.study.distributions import Lognormal

MODELS = ("ls-dem", "nscd-rigid")
# Zhou et al. (2023), Table 2, concrete: coefficients of variation about what the structure file states
_FRICTION, _DENSITY, _MODULUS = 0.10, 0.04, 0.15
_PLACED = 3e-4  # m, standard deviation of where a block stands, along x and y
_TURNED = 2e-4  # rad, of how it is turned about z
_TABLE = 0.01  # of the motion's amplitude: how well a table follows
_FAST = 0.01  # of what is faster than its mean over some 0.1 s, beside that
# readings: noise over the stated one (standard deviation of its logarithm), its memory, shares lost and wrong, at most
_LOUDER, _MEMORY, _LOST, _WRONG = 0.1, 0.7, 0.03, 0.02


@dataclass(frozen=True)
class Draw:
    """One nominal model.

    Attributes
    ----------
    model : str
        One of `MODELS`.
    time_step : float
        [s]
    parameters : dict of str to float
        Of the structure and of the solver, by dotted name.
    amplitude : float
        Of the motion over the commanded one [1].
    fast : float
        Of what is faster in it than some 0.1 s, over the commanded one, less 1 [1].
    noise : dict of str to float
        ``louder``, over the stated noise [1], and the entries ``noise_memory``, ``marker_dropouts`` and
        ``marker_outliers`` of `Instruments`.
    places : float64 array, shape (n_bodies, 3)
        Off the structure file: along x and y [m], turned about z [rad].
    seed : int
        Of the sensors' noise.
    """

    model: str
    time_step: float
    parameters: dict
    amplitude: float
    fast: float
    noise: dict
    places: np.ndarray
    seed: int


def draw_nominal(structure, model, number):
    """A nominal model, the same for the same structure, model and number.

    Parameters
    ----------
    structure : str or path
    model : str
    number : int

    Returns
    -------
    Draw

    Notes
    -----
    Parameters are drawn independently with the scatter of Table 2 of Zhou et al. (2023) about what the structure file
    states; contact stiffness goes with Young's modulus, as wave-speed matching has it. The discretisation is
    uncertain like they are, since nothing measured says which is right: in LS-DEM the layout of nodes and
    the restitution that stands for damping, in NSCD the time step and the shrink of contact areas. A diagnosis with one
    fixed discretisation calls every other one an effect; so does one with white noise alone, once readings have a
    memory, gaps and outliers.
    """
    generator = np.random.default_rng([number, MODELS.index(model)])
    file = load_structure(structure).file

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
    numerics, time_step = _NUMERICS[model](generator, softer, file)
    places = np.zeros((len(file.bodies), 3))
    free = np.array([not body.driven for body in file.bodies])
    places[free] = generator.normal(0.0, [_PLACED, _PLACED, _TURNED], (free.sum(), 3))
    return Draw(
        model=model,
        time_step=time_step,
        parameters=drawn | numerics,
        amplitude=float(generator.normal(1.0, _TABLE)),
        fast=float(generator.normal(0.0, _FAST)),
        noise={
            "louder": float(np.exp(generator.normal(0.0, _LOUDER))),
            "noise_memory": float(generator.uniform(0.0, _MEMORY)),
            "marker_dropouts": float(generator.uniform(0.0, _LOST)),
            "marker_outliers": float(generator.uniform(0.0, _WRONG)),
        },
        places=places,
        seed=int(generator.integers(2**31)),
    )


def _ls_dem(generator, softer, file):
    usual = LsDemParameters()
    numerics = {
        "ls_dem.normal_stiffness": usual.normal_stiffness * softer,
        "ls_dem.shear_stiffness": usual.shear_stiffness * softer,
        "ls_dem.node_spacing": usual.node_spacing * float(generator.uniform(0.75, 1.5)),
        "ls_dem.perimeter_inset": usual.perimeter_inset * float(generator.uniform(0.4, 2.0)),
        "restitution": file.restitution * float(generator.uniform(0.8, 1.2)),
    }
    return numerics, 5e-5


def _nscd(generator, softer, file):
    # a closer time step where bodies meet, as studies should: docs/nscd.md
    numerics = {"nscd.impact_parts": 20, "nscd.shrink": float(generator.uniform(0.0, 0.02))}
    return numerics, float(generator.choice([5e-4, 1e-3]))


_NUMERICS = {"ls-dem": _ls_dem, "nscd-rigid": _nscd}
