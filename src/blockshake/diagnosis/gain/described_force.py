"""A force from outside that the laws describe, added to the model as an empirical force."""

from dataclasses import replace

import numpy as np
from scipy.special import ndtri

from blockshake.geometry.rotations import rotation_matrices

_NORMAL_90 = 1.645


def members_with_force(outside, draws, structure):
    """Nominal models with the described force, its amplitudes filling their interval evenly in probability.

    Parameters
    ----------
    outside : OutsideForce
    draws : list of Draw
        Nominal ones, a member each.
    structure : Structure

    Returns
    -------
    list of (Draw, list of dict)
        As `simulated_test` is given them; the force is a parameter of the structure, no effect of the registry.
    """
    strata = ndtri((np.arange(len(draws)) + 0.5) / len(draws))
    spread = 0.5 * (outside.upper - outside.lower) / _NORMAL_90
    order = np.random.default_rng(len(draws)).permutation(len(draws))
    amplitudes = outside.amplitude + spread * strata[order]
    return [
        (replace(draw, parameters=draw.parameters | as_parameters(outside, float(amplitude), structure)), [])
        for draw, amplitude in zip(draws, amplitudes, strict=True)
    ]


def as_parameters(outside, amplitude, structure):
    """The described force as entries of a structure file.

    Parameters
    ----------
    outside : OutsideForce
    amplitude : float
        In the unit of its law.
    structure : Structure

    Returns
    -------
    dict
        Times and gaps are medians over the tests that show the force.
    """
    name, tests = outside.bodies[0], list(outside.tests.values())
    body = structure.body_names.index(name)
    turn = rotation_matrices(structure.orientation[body])
    above = structure.mass_offset[body] + outside.height * turn[2]
    place = {"body": name, "position": above.tolist()}
    if outside.law == "spring":
        stop = {
            **place,
            "axis": "+x" if _median(tests, "side") > 0.0 else "-x",
            "gap": _median(tests, "gap"),
            "stiffness": max(amplitude, 0.0),
        }
        return {"stoppers": [stop]}
    if outside.law in ("damper", "proportional"):
        # fitted as force over motion: the model counts both against the motion
        own = {"damping" if outside.law == "damper" else "stiffness": -amplitude}
    else:
        own = {name: _median(tests, name) for name in ("start", "end") if name in tests[0]}
        own["amplitude"] = amplitude
    return {"external_forces": [{**place, **own}]}


def _median(tests, name):
    return float(np.median([test[name] for test in tests]))
