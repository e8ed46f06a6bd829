"""The tests of a case: motions, scales and roles, and how far a block may tilt in them."""

import numpy as np

HOME = "home"
DURATION = 6.0  # s
PLAN = (
    ("alkion", 1.0, "fit"),
    ("alkion", 2.5, "fit"),
    ("basso-tirreno", 2.0, "select"),
    ("alkion", 3.0, "sealed"),
    ("basso-tirreno", 2.5, "sealed"),
)
# on the scales of the plan, so that blocks rock and do not topple
STRONGER = {"single-block": 2.2, "trilithon": 1.15, "six-block-wall": 0.9}
# motion, share of its `ONSET` at a strength, role: a quiet test first
STRONG_PLAN = (
    ("alkion", 0.7, "fit"),
    ("alkion", 1.0, "fit"),
    ("basso-tirreno", 1.0, "fit"),
    ("alkion", 1.05, "select"),
    ("alkion", 1.1, "sealed"),
    ("basso-tirreno", 1.05, "sealed"),
)
# scale of alkion and of basso-tirreno at which joints begin to open, or to slide, in clean runs by MuJoCo
ONSET = {
    "single-block": (4.6, 3.2),
    "two-blocks": (2.3, 1.7),
    "three-blocks": (1.8, 1.25),
    "four-blocks": (1.75, 1.25),
    "sliding-blocks": (1.6, 1.2),
    "bridged-walls": (1.85, 1.45),
    "trilithon": (2.4, 1.9),
    "six-block-wall": (1.7, 1.2),
    "configuration-1": (1.6, 1.1),
    "configuration-2": (1.2, 0.85),
    "configuration-3": (1.25, 0.95),
    "configuration-4": (1.25, 0.95),
}
# by strength: scale over the onset, and largest tilt over the angle at which the whole would overturn about an edge
STRENGTHS = {"weak": (1.12, 0.15), "middle": (1.3, 0.3), "strong": (1.6, 0.5)}
_SCALES = (0.92, 1.08)  # on the scales, drawn test by test; in `PLAN` those of two tests never meet
_STREAM = 6


def planned_tests(structure_name, seed, sealed, strength=None):
    """Motion, scale and role of every test of a case, with the sealed ones or without."""
    plan = PLAN if strength is None else STRONG_PLAN
    drawn = np.random.default_rng([seed, _STREAM]).uniform(*_SCALES, len(plan))
    if strength is None:
        factors = dict.fromkeys(("alkion", "basso-tirreno"), STRONGER.get(structure_name, 1.0))
    else:
        onset = ONSET[structure_name]
        factors = dict(
            zip(("alkion", "basso-tirreno"), np.array(onset) * STRENGTHS[strength][0], strict=True)
        )
    return [
        (motion, round(float(scale * factor * factors[motion]), 3 if strength else 2), role)
        for (motion, scale, role), factor in zip(plan, drawn, strict=True)
        if sealed or role != "sealed"
    ]


def name_of_test(motion, scale):
    """Name of a planned test, such as ``alkion-250``."""
    return f"{motion}-{round(100 * scale):03d}"


def overturning_angle(structure):
    """Angle at which the whole structure would overturn about an edge of its lowest blocks [rad]."""
    free = ~structure.driven
    height = np.average(structure.centroid[free, 2], weights=structure.mass[free])
    blocks = [body for body in structure.file.bodies if not body.driven]
    lowest = min(blocks, key=lambda body: body.position[2])
    shape = structure.file.shapes[lowest.shape]
    return float(np.arctan((0.5 * shape.box[0] - (shape.chamfer or 0.0)) / height))


def most_tilt(structure, strength):
    """Largest tilt of a block in a test [rad]; without a strength there is none."""
    return np.inf if strength is None else STRENGTHS[strength][1] * overturning_angle(structure)
