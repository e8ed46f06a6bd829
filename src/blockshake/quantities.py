"""Every parameter by its dotted name: unit, meaning and source."""

import re
from typing import NamedTuple


class Quantity(NamedTuple):
    """Definition of a parameter.

    ``name`` may hold capitals for the part that a structure names (MATERIAL, BODY); ``unit`` is SI; ``source`` is
    where the default or the definition comes from.
    """

    name: str
    unit: str
    meaning: str
    source: str


_PAPER = "Zhou et al. (2023)"
PHYSICAL = (
    Quantity("friction.MATERIAL.MATERIAL", "1", "Coulomb's coefficient of a pair", f"{_PAPER}, Table 2"),
    Quantity("friction.MATERIAL.MATERIAL.rate_drop", "1", "share of mu lost at high slip rate", "docs/method.md"),
    Quantity("friction.MATERIAL.MATERIAL.rate_scale", "m/s", "slip rate at which 63 % is lost", "docs/method.md"),
    Quantity("friction.MATERIAL.MATERIAL.slip_drop", "1", "share of mu lost after long slip", "docs/method.md"),
    Quantity("friction.MATERIAL.MATERIAL.slip_scale", "m", "slip after which 63 % is lost", "docs/method.md"),
    Quantity(
        "friction.MATERIAL.MATERIAL.asymmetry", "1",
        "share by which mu is larger for slip of a joint's second body along its first's +x", "docs/method.md",
    ),
    Quantity("joints.BODY.BODY.friction_factor", "1", "factor on mu of one joint", "docs/method.md"),
    Quantity("joints.BODY.BODY.compliance", "m3/N", "normal compliance of a joint's soft layer", "docs/method.md"),
    Quantity("materials.MATERIAL.density", "kg/m3", "mass density", f"{_PAPER}, Table 2"),
    Quantity("materials.MATERIAL.youngs_modulus", "Pa", "Young's modulus", f"{_PAPER}, Table 2"),
    Quantity("materials.MATERIAL.poisson_ratio", "1", "Poisson's ratio; G = E / (2 (1 + nu))", "structure file"),
    Quantity(
        "materials.MATERIAL.viscous_modulus", "Pa s", "viscous modulus; the rigid solvers do not use it",
        f"{_PAPER}, Table 2; unit by assumption",
    ),
    Quantity("restitution", "1", "restitution of LS-DEM's dashpot, 0 for critical", f"{_PAPER}, Eq. (3)"),
    Quantity("nscd_restitution", "1", "Newton's restitution of NSCD", f"{_PAPER}, section LMGC90"),
    Quantity("gravity", "m/s2", "gravity vector", "structure file"),
    Quantity("bodies.BODY.density", "kg/m3", "density of one body instead of its material's", "structure file"),
    Quantity(
        "bodies.BODY.mass_offset", "m", "mass centre seen from the shape's centroid, body frame", "docs/method.md"
    ),
    Quantity("bodies.BODY.inertia", "kg m2", "inertia about the mass centre, body frame", "docs/method.md"),
    Quantity("bodies.BODY.position", "m", "shape's centroid at the start", "structure file"),
    Quantity("bodies.BODY.orientation", "1", "unit quaternion w, x, y, z at the start", "structure file"),
    Quantity("bodies.BODY.velocity", "m/s", "velocity at the start", "structure file"),
    Quantity("bodies.BODY.angular_velocity", "rad/s", "angular velocity at the start", "structure file"),
    Quantity("bodies.BODY.offset", "m", "shift of a body laid `on` another, along x and y", "structure file"),
    Quantity("shapes.SHAPE.box", "m", "edge lengths of a box", "structure file"),
    Quantity("shapes.SHAPE.cylinder.diameter", "m", "diameter of a cylinder", "structure file"),
    Quantity("shapes.SHAPE.cylinder.height", "m", "height of a cylinder", "structure file"),
    Quantity("shapes.SHAPE.chamfer", "m", "leg of the 45-degree chamfer of a box", f"{_PAPER}, section LS-DEM"),
    Quantity("shapes.SHAPE.hollow", "m", "depth of the middle of each face below its rim", "docs/theory/rocking.md"),
    Quantity("stoppers.INDEX.gap", "m", "clearance of a stopper, counted from 0", "structure file"),
    Quantity("stoppers.INDEX.stiffness", "N/m", "stiffness of a stopper", "structure file"),
    Quantity("external_forces.INDEX.amplitude", "N", "force from outside, counted from 0", "structure file"),
    Quantity("external_forces.INDEX.stiffness", "N/m", "of a rope or spring from outside", "structure file"),
    Quantity("external_forces.INDEX.damping", "N s/m", "of a viscous drag from outside", "structure file"),
    Quantity("external_forces.INDEX.drag", "N", "of a dry drag from outside", "structure file"),
)  # fmt: skip
FACTOR, HEADING = "motion.scale", "motion.heading"
MOTION = {FACTOR: "1", HEADING: "rad"}
"""Units of what a sample may change of the motion that drives it: a factor, and a turn about z."""
_OF_VECTOR = r"(\.[xyz])?$"
_VECTORS = ("gravity", "mass_offset", "position", "offset", "velocity", "angular_velocity", "box")
_NO_NUMBERS = ("inertia", "orientation")  # whose parts do not change alone


def unit_of(name):
    """SI unit of a parameter of a structure by its dotted name, a part of a vector by its axis; None of no such one."""
    for quantity in PHYSICAL:
        pattern = re.sub("[A-Z]+", r"[^\\s./]+", quantity.name.replace(".", r"\."))
        if re.match(pattern + _OF_VECTOR, name):
            return quantity.unit
    return None


def unit_of_number(name):
    """The same of a parameter that is one number, as random variables are."""
    parts = name.split(".")
    whole = parts[:-1] if len(parts) > 1 and parts[-1] in "xyz" and parts[-2] in _VECTORS else parts
    is_part = len(whole) < len(parts)
    if set(_NO_NUMBERS) & set(parts) or (whole[-1] in _VECTORS) != is_part:
        return None
    return unit_of(name)


_DENSITIES = (100.0, 25000.0)
# Ends between which values of dry-stacked blocks lie, in a vector those of its parts: wide, and by judgement.
# `blockshake check` remarks values beyond.
USUAL = {
    "friction.MATERIAL.MATERIAL": (0.05, 1.5),
    "friction.MATERIAL.MATERIAL.rate_scale": (1e-5, 1.0),
    "friction.MATERIAL.MATERIAL.slip_scale": (1e-5, 1.0),
    "friction.MATERIAL.MATERIAL.asymmetry": (-0.5, 0.5),
    "joints.BODY.BODY.friction_factor": (0.1, 5.0),
    "joints.BODY.BODY.compliance": (0.0, 1e-7),
    "materials.MATERIAL.density": _DENSITIES,
    "materials.MATERIAL.youngs_modulus": (1e7, 1e12),
    "materials.MATERIAL.poisson_ratio": (0.0, 0.5),
    "materials.MATERIAL.viscous_modulus": (0.0, 1e11),
    "gravity": (-30.0, 30.0),
    "bodies.BODY.density": _DENSITIES,
    "bodies.BODY.velocity": (-10.0, 10.0),
    "bodies.BODY.angular_velocity": (-10.0, 10.0),
    "stoppers.INDEX.gap": (0.0, 1.0),
    "stoppers.INDEX.stiffness": (0.0, 1e12),
}
_DENSITY_SLIPS = (("g/cm3", 0.1, 15.0), ("kN/m3", 15.0, 100.0), ("g/m3", 1e5, 2.5e7))
# Units in which a value of a size, between two ends, was perhaps given in place of that of SI
PERHAPS = {
    "materials.MATERIAL.density": _DENSITY_SLIPS,
    "bodies.BODY.density": _DENSITY_SLIPS,
    "materials.MATERIAL.youngs_modulus": (("GPa", 1.0, 1e3), ("MPa", 1e3, 1e6)),
    "gravity": (("mm/s2", 9e3, 1e4), ("cm/s2", 9e2, 1e3)),
    "stoppers.INDEX.gap": (("mm", 1.0, 1e3),),
}
