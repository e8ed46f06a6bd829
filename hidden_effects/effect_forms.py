"""Effects of the registry in another functional form than the registry's, as reality would have it.

A diagnosis that recognises its own formula proves nothing. Parameters and places are the registry's, so that an answer
can be held against them; what they do differs. None of these calls the registry's own equations.
"""

from dataclasses import replace

import numpy as np
from scipy.interpolate import CubicSpline
from scipy.signal import lfilter

from blockshake.dynamics.motion import CHANNELS
from blockshake.effects.places import blocks, joints, stated_joint

_SHARED = 0.2  # of what an effect does at its place, in its neighbours
_HIGHEST_RESTITUTION = 0.97
_VERTICAL_CORNER = 6.0  # Hz
_SKEW = 2e-5  # of the optical clock's rate


def _low_passed(values, step, corner):
    """One real pole at a corner frequency [Hz], by the bilinear rule, at rest before the start."""
    warped = np.tan(np.pi * corner * step)
    return lfilter([warped, warped], [1.0 + warped, warped - 1.0], values)


def _add_to_motion(experiment, channel, values):
    breaks = experiment.motion.table.breaks
    return experiment.with_motion(CHANNELS.index(channel), CubicSpline(breaks, values).c[::-1].T)


def _rows(experiment):
    breaks = experiment.motion.table.breaks
    return breaks, float(np.diff(breaks).min())


def _table_pitch(experiment, values, place):
    breaks, step = _rows(experiment)
    once = _low_passed(experiment.motion.evaluate(breaks, derivative=2)[:, 0], step, values["frequency"])
    follows = _low_passed(once, step, values["frequency"])
    stiffening = 0.03 * follows**3 / np.abs(follows).max() ** 2
    return _add_to_motion(experiment, "pitch_y", values["coefficient"] * (follows + stiffening))


def _vertical_motion(experiment, values, place):
    breaks, step = _rows(experiment)
    delayed = experiment.motion.evaluate(breaks - values["delay"])[:, 0]
    return _add_to_motion(
        experiment, "z", values["ratio"] * _low_passed(delayed - delayed[0], step, _VERTICAL_CORNER)
    )


def _clock_lag(experiment, values, place):
    return experiment.with_instruments(marker_lag=values["lag"])


def _marker_offset(experiment, values, place):
    height = values["height"]
    return experiment.with_instruments(marker_offset={place["marker"]: (0.3 * height, 0.0, height)})


def _sensor_gain(experiment, values, place):
    return experiment  # the readings themselves are changed: `distort`


def _sensor_drift(experiment, values, place):
    rate = values["rate"]
    return experiment.with_instruments(marker_creep={place["marker"]: (rate, 0.2 * rate, 0.0)})


def _sensor_saturation(experiment, values, place):
    return experiment  # the readings themselves are changed: `distort`


def with_stops(experiment, stops):
    """The same test with further stops."""
    present = [stopper.model_dump() for stopper in experiment.structure.file.stoppers]
    return experiment.with_parameters(stoppers=[*present, *stops])


def _stopper_contact(experiment, values, place):
    file = experiment.structure.file
    body = next(body for body in file.bodies if body.name == place["body"])
    length, _, height = file.shapes[body.shape].box
    side = 0.5 * length if place["axis"] == "+x" else -0.5 * length
    stops = [
        {
            "body": place["body"], "position": [side, 0.0, 0.5 * height], "axis": place["axis"],
            "gap": later * values["gap"], "stiffness": 0.5 * values["stiffness"],
        }
        for later in (1.0, 1.2)
    ]  # fmt: skip
    return with_stops(experiment, stops)


def _impact_restitution(experiment, values, place):
    file, increase = experiment.structure.file, values["increase"]
    return experiment.with_parameters(
        **{
            "restitution": min(file.restitution + increase, _HIGHEST_RESTITUTION),
            "nscd_restitution": min(file.nscd_restitution + increase, _HIGHEST_RESTITUTION),
        }
    )


def _reduced_bearing(experiment, values, place):
    file = experiment.structure.file
    free = [body for body in file.bodies if not body.driven]
    changed = {}
    for body, share in zip(free, np.linspace(1.2, 0.8, len(free)), strict=True):
        shape = file.shapes[body.shape]
        worn = {"box": list(shape.box), "chamfer": shape.chamfer + float(share) * values["inset"]}
        changed |= {f"shapes.{body.name}-worn": worn, f"bodies.{body.name}.shape": f"{body.name}-worn"}
    return experiment.with_parameters(**changed)


def _eccentricity(experiment, values, place):
    structure = experiment.structure
    names = [entry["body"] for entry in blocks(structure)]
    at = names.index(place["body"])
    neighbour = names[at + 1 if at + 1 < len(names) else at - 1]
    body = next(body for body in structure.file.bodies if body.name == place["body"])
    density = structure.file.materials[body.material].density
    own, other = (1.0 - _SHARED) * values["offset"], _SHARED * values["offset"]
    return experiment.with_parameters(
        **{
            f"bodies.{place['body']}.mass_offset": [own, 0.0, 0.0],
            f"bodies.{neighbour}.mass_offset": [other, 0.0, 0.0],
            f"bodies.{place['body']}.density": 1.03 * density,
        }
    )


def _block_mass(experiment, values, place):
    names = [entry["body"] for entry in blocks(experiment.structure)]
    at = names.index(place["body"])
    shares = {names[at]: (1.0 - _SHARED) * values["excess"], names[at - 1]: _SHARED * values["excess"]}
    changed = {}
    for body in experiment.structure.file.bodies:
        if body.name in shares:
            density = body.density or experiment.structure.file.materials[body.material].density
            changed[f"bodies.{body.name}.density"] = (1.0 + shares[body.name]) * density
    return experiment.with_parameters(**changed)


def _neighbours(experiment, place):
    """Joints that share a block with a joint."""
    own = set(place["joint"])
    driven = {body.name for body in experiment.structure.file.bodies if body.driven}
    everywhere = [entry["joint"] for entry in joints(experiment.structure)]
    return [joint for joint in everywhere if set(joint) != own and (set(joint) & own) - driven]


def _weak_joint(experiment, values, place):
    changed = {f"joints.{'.'.join(place['joint'])}.friction_factor": values["factor"]}
    for joint in _neighbours(experiment, place):
        changed[f"joints.{'.'.join(joint)}.friction_factor"] = 1.0 - _SHARED * (1.0 - values["factor"])
    return experiment.with_parameters(**changed)


def _rate_weakening_friction(experiment, values, place):
    # what sliding loses is lost in part at once and the rest over a longer scale
    drop = values["drop"]
    return _with_friction(experiment, -0.1 * drop, rate_drop=0.9 * drop, rate_scale=1.3 * values["scale"])


def _slip_weakening_friction(experiment, values, place):
    # a tenth of what slip loses is lost at once and the rest over a longer slip
    drop = values["drop"]
    return _with_friction(experiment, -0.1 * drop, slip_drop=0.9 * drop, slip_scale=1.3 * values["scale"])


def _friction_asymmetry(experiment, values, place):
    # what one side gains the other does not lose in full
    asymmetry = values["asymmetry"]
    return _with_friction(experiment, 0.1 * abs(asymmetry), asymmetry=asymmetry)


def _with_friction(experiment, gained, **law):
    """Every pair with its coefficient raised by the share ``gained`` and with these entries of its law."""
    changed = {}
    for entry in experiment.structure.file.friction:
        pair = f"friction.{'.'.join(entry.pair)}"
        changed[pair] = entry.coefficient * (1.0 + gained)
        changed |= {f"{pair}.{name}": value for name, value in law.items()}
    return experiment.with_parameters(**changed)


def _joint_compliance(experiment, values, place):
    own = stated_joint(experiment, place).compliance + values["compliance"]
    changed = {f"joints.{'.'.join(place['joint'])}.compliance": own}
    for joint in _neighbours(experiment, place):
        changed[f"joints.{'.'.join(joint)}.compliance"] = _SHARED * values["compliance"]
    return experiment.with_parameters(**changed)


def _base_compliance(experiment, values, place):
    structure = experiment.structure
    (index,) = np.flatnonzero(structure.driven)
    slab = structure.file.bodies[index]
    length, depth, height = structure.file.shapes[slab.shape].box
    weight = float(structure.mass.sum()) * 9.81
    # a structure may start with 1 mm of overlap: a long table under heavy blocks would sink farther
    length = min(length, float(np.sqrt(12.0 * 0.95e-3 / (weight * values["compliance"]))))
    layer = values["compliance"] * depth * length**3 / 12.0
    sink = weight * layer / (length * depth)
    mapping = structure.file.model_dump(mode="json")
    mapping["shapes"]["table"] = {"box": [length, depth, 0.1]}
    mapping["bodies"][index]["driven"] = False
    place = structure.centroid[index] + [0.0, 0.0, sink - 0.5 * height - 0.05]
    mapping["bodies"].append(
        {
            "name": "table",
            "shape": "table",
            "material": slab.material,
            "position": place.tolist(),
            "driven": True,
        }
    )
    # rough enough that nothing slides on it
    mapping["friction"].append({"pair": [slab.material, slab.material], "coefficient": 3.0})
    mapping["joints"].append({"bodies": ["table", slab.name], "compliance": layer})
    return replace(experiment, structure=structure.with_mapping(mapping))


# by name: what the form does to the solver next to the experiment
FORM_NUMERICS = {"impact-restitution": {"ls_dem.shear_damping_ratio": 0.02}}
# by name: what it does, and the change of an experiment
FORMS = {
    "table-pitch": ("acceleration through two real poles at the frequency, and 3 % of its cube", _table_pitch),
    "vertical-motion": ("the delayed motion through one real pole at 6 Hz", _vertical_motion),
    "clock-lag": ("the lag, and a clock 20 ppm slow", _clock_lag),
    "sensor-gain": ("error of the gain a tenth larger at the largest displacement", _sensor_gain),
    "marker-offset": ("marker off along the block's x too, by 0.3 of the height", _marker_offset),
    "sensor-drift": ("a fifth of the drift across the shaking too", _sensor_drift),
    "sensor-saturation": ("readings bend towards the end of the range", _sensor_saturation),
    "stopper-contact": ("two stops of half the stiffness, the second at 1.2 times the gap", _stopper_contact),
    "impact-restitution": (
        "the truth's own solver's restitution, at most 0.97, and in LS-DEM 2 % of critical damping along the joints",
        _impact_restitution,
    ),
    "reduced-bearing": ("chamfers from 1.2 times the inset at the bottom to 0.8 times at the top", _reduced_bearing),
    "eccentricity": ("a fifth of the offset in the neighbour instead, the block 3 % heavier", _eccentricity),
    "block-mass": ("a fifth of the excess in the neighbour instead", _block_mass),
    "weak-joint": ("a fifth of the loss in the neighbouring joints too", _weak_joint),
    "rate-weakening-friction": (
        "a tenth of the drop lost at any rate, the rest over 1.3 times the scale", _rate_weakening_friction
    ),
    "slip-weakening-friction": (
        "a tenth of the drop lost before any slip, the rest over 1.3 times the scale", _slip_weakening_friction
    ),
    "friction-asymmetry": ("the mean coefficient a tenth of the asymmetry larger", _friction_asymmetry),
    "joint-compliance": ("a fifth of the compliance in the neighbouring joints too", _joint_compliance),
    "base-compliance": ("a soft layer under the whole slab, whose vertical play counts too", _base_compliance),
}  # fmt: skip


def distort(time, displacement, markers, effect):
    """Readings of markers, (n_times, n_markers, 3) [m], with what an effect does to readings and no solver knows."""
    if effect["name"] == "sensor-gain":
        column = markers.index(effect["place"]["marker"])
        moved = displacement[:, column]
        largest = np.nanmax(np.abs(moved))
        error = effect["values"]["error"] * (1.0 + 0.1 * (moved / largest) ** 2)
        changed = displacement.copy()
        changed[:, column] = moved * (1.0 + error)
        return changed
    if effect["name"] == "sensor-saturation":
        column, end = markers.index(effect["place"]["marker"]), effect["values"]["range"]
        changed = displacement.copy()
        moved = np.clip(displacement[:, column] / end, -1.0, 1.0)
        changed[:, column] = end * (moved - 0.05 * moved**3) / 0.95
        return changed
    if effect["name"] == "clock-lag":
        known = np.isfinite(displacement).all(axis=(1, 2))
        changed = displacement.copy()
        changed[known] = CubicSpline(time[known], displacement[known])(time[known] * (1.0 - _SKEW))
        return changed
    return displacement
