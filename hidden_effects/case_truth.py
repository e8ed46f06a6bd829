"""Truth of a case, drawn by its seed: parameters, numerics, table, places, and the effect's size and place."""

import numpy as np
from outside_forces import OUTSIDE, draw_outside
from scipy.interpolate import CubicSpline
from scipy.signal import lfilter

from blockshake.effects.effect import Experiment
from blockshake.effects.places import joints
from blockshake.effects.registry import EFFECTS
from blockshake.measurement.sensors.instruments import Instruments
from blockshake.study.sampling.distributions import Lognormal

SIZES = {"small": (0.5, 0.8), "large": (1.0, 1.6)}  # of the visible one
_WIDER = 1.5  # times the usual scatter
_WIDER_SHARE = 0.2  # of the cases
# coefficients of variation of Zhou et al. (2023), Table 2
_FRICTION, _DENSITY, _MODULUS = 0.10, 0.04, 0.15
_STIFFNESS = {"ls_dem.normal_stiffness": 2.16e10, "ls_dem.shear_stiffness": 9.0e9}  # N/m3, at Table 2's means
_BLOCK, _JOINT = 0.025, 0.08  # of the density from block to block, of friction from joint to joint
_EFFECT, _PARAMETERS, _NUMERICS, _TABLE, _PLACES = range(5)  # streams of the seed
_SCATTER = 8


def true_causes(names, size, structure, tests, seed):
    """Causes that are hidden in a case: name, values, place, and size in units of the visible one.

    Parameters
    ----------
    names : sequence of str
        Of the registry or of `OUTSIDE`; none of a clean case.
    size : str
        Key of `SIZES`, of effects of the registry; what the prior does not hold of it is not drawn.
    structure : Structure
    tests : int
        Their number.
    seed : int

    Returns
    -------
    list of dict
    """
    causes = []
    for number, name in enumerate(names):
        generator = np.random.default_rng([seed, _EFFECT, number])
        if name in OUTSIDE:
            causes.append(draw_outside(name, structure, tests, generator))
        else:
            causes.append(_draw_effect(name, size, structure, generator))
    return causes


def _draw_effect(name, size, structure, generator):
    first, *others = EFFECTS[name].parameters
    step = first.visible - first.null
    end = first.upper if step > 0.0 else first.lower
    low, high = SIZES[size]
    share = generator.uniform(low, min(high, (end - first.null) / step))
    both = first.lower < first.null < first.upper
    sign = -1.0 if both and generator.random() < 0.5 else 1.0
    values = {first.name: float(first.null + sign * share * step)}
    values |= {item.name: float(generator.uniform(item.lower, item.upper)) for item in others}
    places = _places(name, structure)
    place = places[generator.integers(len(places))]
    return {"name": name, "values": values, "place": place, "size": float(sign * share)}


def _places(name, structure):
    """The registry's places; a marker is off on a block, since on a slab that does not turn it would be nothing."""
    places = EFFECTS[name].places(structure)
    if name != "marker-offset":
        return places
    driven = {body.name for body in structure.file.bodies if body.driven}
    turning = {marker.name for marker in structure.file.markers if marker.body not in driven}
    return [place for place in places if place["marker"] in turning]


def true_parameters(structure, seed):
    """Parameters by dotted name, contact stiffness with Young's modulus, and whether they scatter more than usual."""
    generator = np.random.default_rng([seed, _PARAMETERS])
    wider = bool(generator.random() < _WIDER_SHARE)
    factor = _WIDER if wider else 1.0
    file = structure.file

    def scattered(mean, cov):
        return float(Lognormal(mean=mean, cov=cov * factor).quantile(generator.random()))

    drawn = {
        f"friction.{'.'.join(item.pair)}": scattered(item.coefficient, _FRICTION) for item in file.friction
    }
    softer = scattered(1.0, _MODULUS)
    for name, material in file.materials.items():
        drawn[f"materials.{name}.density"] = scattered(material.density, _DENSITY)
        drawn[f"materials.{name}.youngs_modulus"] = material.youngs_modulus * softer
    drawn |= {name: usual * softer for name, usual in _STIFFNESS.items()}
    drawn["restitution"] = file.restitution * float(generator.uniform(1.0 - 0.2 * factor, 1.0 + 0.2 * factor))
    return drawn, wider


def true_numerics(seed):
    """Solver, time step and discretisation; a third of the cases by LS-DEM.

    None is what the nominal model draws: LS-DEM's nodes 0.15 to 0.3 m apart and 0.18 to 0.6 % of the breadth from the
    perimeter at 5e-5 s, and NSCD shrunk by up to 2 % at 5e-4 or 1e-3 s, finer in impacts.
    """
    generator = np.random.default_rng([seed, _NUMERICS])
    if generator.random() < 1.0 / 3.0:
        spacing = generator.uniform(0.11, 0.14) if generator.random() < 0.5 else generator.uniform(0.32, 0.38)
        inset, time_step = generator.uniform(0.0066, 0.009), generator.choice([2e-5, 4e-5])
        numerics = {"ls_dem.node_spacing": float(spacing), "ls_dem.perimeter_inset": float(inset)}
        return "ls-dem", float(time_step), numerics
    time_step = generator.choice([1.25e-4, 2.5e-4, 4e-4])
    return "nscd-rigid", float(time_step), {"nscd.shrink": float(generator.uniform(0.025, 0.035))}


def unusual_numerics(structure, seed):
    """Solver, time step, discretisation and restitution far from what the nominal model draws; half of them LS-DEM."""
    generator = np.random.default_rng([seed, _NUMERICS])
    if generator.random() < 0.5:
        spacing = generator.uniform(0.09, 0.12) if generator.random() < 0.5 else generator.uniform(0.36, 0.5)
        lost = generator.uniform(0.55, 0.75) if generator.random() < 0.5 else generator.uniform(1.25, 1.45)
        numerics = {
            "ls_dem.node_spacing": float(spacing), "ls_dem.perimeter_inset": float(generator.uniform(0.008, 0.012)),
        }  # fmt: skip
        time_step = float(generator.choice([3e-5, 8e-5]))
        return "ls-dem", time_step, numerics, {"restitution": structure.file.restitution * float(lost)}
    time_step = float(generator.choice([2e-4, 1.5e-3]))
    numerics = {"nscd.shrink": float(generator.uniform(0.025, 0.035))}
    return "nscd-rigid", time_step, numerics, {"nscd_restitution": float(generator.uniform(0.03, 0.1))}


def true_table(seed, errs=1.0):
    """How the table follows: its gain, how far its gain differs at high frequency, and from which frequency on.

    Within 3.5 % of the command, times a factor.
    """
    generator = np.random.default_rng([seed, _TABLE])
    return {
        "gain": float(1.0 + errs * np.clip(generator.normal(0.0, 0.01), -0.02, 0.02)),
        "high": errs * float(generator.uniform(-0.015, 0.015)),
        "corner": float(generator.uniform(1.5, 4.0)),
    }


def follow(motion, table):
    """The motion that the table makes of a commanded one.

    Notes
    -----
    ``H(f) = gain + high i f / (f_c + i f)`` on the displacement: a gain that drifts within 1.5 % of itself around the
    corner frequency, with the phase that goes with it.
    """
    breaks = motion.table.breaks
    displacement = motion.evaluate(breaks)[:, 0]
    warped = np.tan(np.pi * table["corner"] * np.diff(breaks).min())
    slow = lfilter([warped, warped], [1.0 + warped, warped - 1.0], displacement)
    change = (table["gain"] - 1.0) * displacement + table["high"] * (displacement - slow)
    return (
        Experiment(None, motion, Instruments()).with_motion(0, CubicSpline(breaks, change).c[::-1].T).motion
    )


def scattered_blocks(structure, seed):
    """Factors on friction by joint and on density by body, of a laboratory whose blocks are not alike.

    One density of all blocks with Table 2's scatter, and 2.5 % from block to block; friction with 8 % from joint to
    joint.
    """
    generator = np.random.default_rng([seed, _SCATTER])
    batch = np.exp(generator.normal(0.0, _DENSITY))
    density = {
        body.name: float(batch * np.exp(generator.normal(0.0, _BLOCK)))
        for body in structure.file.bodies
        if not body.driven
    }
    friction = {
        "/".join(place["joint"][::-1]): float(np.clip(generator.normal(1.0, _JOINT), 0.8, 1.2))
        for place in joints(structure)
    }
    return friction, density


def true_places(structure, seed, test):
    """Where the blocks of a test stand, as `placed` takes it: within 0.3 mm, turned by 0.2 mrad."""
    generator = np.random.default_rng([seed, _PLACES, test])
    free = ~structure.driven
    places = np.zeros((len(free), 3))
    places[free] = generator.normal(0.0, [3e-4, 3e-4, 2e-4], (free.sum(), 3))
    return places
