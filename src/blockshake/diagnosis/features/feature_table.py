"""The table of features: unit, formula, source, scale of the transform, and value of a feature that is not defined."""

from typing import NamedTuple

BANDS = ((0.3, 1.0), (1.0, 2.0), (2.0, 4.0), (4.0, 8.0), (8.0, 16.0))  # Hz


class Feature(NamedTuple):
    """One kind of feature.

    Attributes
    ----------
    unit : str
    scale : float
        Of the signed logarithm, in the unit; 0 leaves the value as it is.
    formula : str
    source : str
        Literature, equation, or effect of the registry that the feature serves.
    censored : str
        Value where the feature cannot be told.
    """

    unit: str
    scale: float
    formula: str
    source: str
    censored: str = "never"


_QUIET = "in the quiet phase, on acceleration, velocity and displacement of the base and a constant"
_LINEAR = "linear response before the onset; error: Andrews and Monahan (1992)"
_FEW = "0, with fewer than 40 quiet readings"
_NO_ROCKING = "0, without rocking beyond 5 sigma to that side at 10 readings"

# of a joint; the name goes behind ``jointJ.``, J counts from 1 as the structure file lists upper bodies
JOINT_FEATURES = {
    "slip.quiet.acceleration": Feature("s2", 1e-4, f"slope of the slip {_QUIET}", _LINEAR, _FEW),
    "slip.quiet.displacement": Feature("1", 0.01, f"slope of the slip {_QUIET}", _LINEAR, _FEW),
    "rotation.quiet.acceleration": Feature("rad s2/m", 1e-4, f"slope of the rotation {_QUIET}", _LINEAR, _FEW),
    "slip.onset": Feature(
        "m/s2", 0.0, "largest |acceleration| of the base until |slip| first exceeds 5 sigma",
        "sliding starts at mu g: Coulomb friction", "peak of the test"
    ),
    "rotation.onset+": Feature(
        "m/s2", 0.0, "largest acceleration of the base towards -x until the rotation first exceeds +5 sigma",
        "rocking starts at the slenderness times g: Housner (1963)",
        "peak of the test to that side",
    ),
    "rotation.onset-": Feature(
        "m/s2", 0.0, "the same towards +x and -5 sigma", "rocking starts at the slenderness times g: Housner (1963)",
        "peak of the test to that side",
    ),
    "slip.peak+": Feature("m", 1e-3, "largest slip, at least 0", "weak-joint"),
    "slip.peak-": Feature("m", 1e-3, "smallest slip, at most 0", "weak-joint"),
    "rotation.peak+": Feature("rad", 1e-3, "largest rotation, at least 0", "impact-restitution"),
    "rotation.peak-": Feature("rad", 1e-3, "smallest rotation, at most 0", "impact-restitution"),
    "slip.residual": Feature("m", 1e-3, "mean slip of the last 0.5 s", "weak-joint", "last known slip, run cut short"),
    "rotation.residual": Feature(
        "rad", 1e-3, "mean rotation of the last 0.5 s", "reduced-bearing", "last known, run cut short",
    ),
    "slip.asymmetry": Feature("1", 0.0, "(max + min) / (max - min)", "eccentricity", "0, without slip beyond 5 sigma"),
    "rotation.asymmetry": Feature(
        "1", 0.0, "(max + min) / (max - min)", "eccentricity", "0, without rotation beyond 5 sigma",
    ),
    "pivot+": Feature(
        "m", 0.0, "slope of the opening over positive rotations: from the joint's centre to the edge it rocks on",
        "rigid rocking, opening = b sin(rotation); reduced-bearing", _NO_ROCKING,
    ),
    "pivot-": Feature("m", 0.0, "the same over minus negative rotations", "as pivot+", _NO_ROCKING),
    "slip.rotation": Feature(
        "m", 0.01, "slope of slip - opening tan(rotation / 2) over the rotation, while rocking; zero for rigid rocking",
        "marker-offset: the marker reads its offset times the rotation",
        "0, with fewer than 20 readings or over less than 20 sigma",
    ),
    "slip.path": Feature(
        "m", 1e-3, "sum of all |steps| of the slip larger than 8 sigma", "weak-joint, rate-weakening-friction",
    ),
    "slip.growth": Feature(
        "1", 0.0, "exponent of |step| in the |acceleration| that drives it, Theil-Sen", "rate-weakening-friction",
        "0, with fewer than 4 steps",
    ),
    "turning": Feature(
        "m/s2", 1.0, "second derivative of the upper body's displacement at its 3 farthest turning points, median",
        "stopper-contact: a stopper turns a block with its stiffness", "0, without a turn of 8 sigma",
    ),
}  # fmt: skip

# of a joint whose upper body carries an accelerometer along x
SPIKE_FEATURES = {
    "spike.largest": Feature(
        "m/s2", 1.0, "largest deviation of the upper body's accelerometer from its running median over 0.1 s",
        "stopper-contact"
    ),
    "spike.scatter": Feature(
        "1", 0.0, "standard deviation over mean of |displacement| at the 5 largest spikes",
        "stopper-contact: a stopper hits at its gap",
        "1, displacement within 5 sigma",
    ),
}  # fmt: skip

_WHOLE = "over the whole test, on acceleration, velocity and displacement of the base and a constant"

BASE_FEATURES = {
    "base.pitch.acceleration": Feature(
        "rad s2/m", 1e-4, f"slope of the base's pitch {_WHOLE}", "table-pitch"
    ),
    "base.pitch.velocity": Feature("rad s/m", 1e-3, f"slope of the base's pitch {_WHOLE}", "table-pitch"),
    "base.yaw.acceleration": Feature(
        "rad s2/m", 1e-4, f"slope of the base's yaw {_WHOLE}", "rotation of the table about z"
    ),
}

BASE_MOTION_FEATURES = {
    "base.vertical.acceleration": Feature(
        "s2", 1e-4, f"slope of the base's vertical displacement {_WHOLE}", "vertical-motion"
    ),
    "base.vertical.displacement": Feature(
        "1", 0.01, f"slope of the base's vertical displacement {_WHOLE}", "vertical-motion"
    ),
    "base.vertical.peak": Feature(
        "m", 1e-3, "largest |vertical displacement| of the base", "vertical-motion"
    ),
    "base.lateral.displacement": Feature(
        "1", 0.01, f"slope of the base's lateral displacement {_WHOLE}", "motion of the table along y"
    ),
}

_TAIL = "of the top body's rotation while the base rests"

TOP_FEATURES = {
    "onset.time": Feature("s", 0.0, "first onset of any joint", "as slip.onset and rotation.onset", "end of the test"),
    "top.displacement.peak+": Feature(
        "m", 1e-3, "largest displacement against the base, at least 0",
        "displacement of the top block: Zhou et al. (2023)",
    ),
    "top.displacement.peak-": Feature(
        "m", 1e-3, "smallest displacement against the base, at most 0",
        "displacement of the top block: Zhou et al. (2023)",
    ),
    "top.lateral.peak": Feature("m", 1e-3, "largest |displacement along y| against the base", "eccentricity"),
    "top.yaw.peak": Feature("rad", 1e-3, "largest |yaw| against the base", "eccentricity"),
    "top.swing": Feature(
        "s", 0.0, "time for which the rotation stays beyond a quarter of its largest magnitude, around it",
        "half a period at that amplitude: Housner (1963), eq. 7", "0, without rotation beyond 5 sigma",
    ),
    "top.period": Feature(
        "s", 0.0, f"twice the median time from turn to turn {_TAIL}",
        "period falls with the amplitude: Housner (1963)", "0, fewer than 3 turns",
    ),
    "top.half_cycles": Feature(
        "1", 1.0, f"number of half-cycles {_TAIL}", "impact-restitution", "0, fewer than 3 turns",
    ),
    "top.decrement": Feature(
        "1", 0.0, f"median ln(swing / next) {_TAIL}", "impact-restitution", "0, fewer than 3 turns",
    ),
    "top.correlation": Feature(
        "1", 0.0, "largest correlation of the top's displacement with the lowest body's while shaken strongly",
        "joint-compliance",
        "0, either within 5 sigma",
    ),
    "top.delay": Feature(
        "s", 0.01, "lag at which it is reached, positive where the top is later", "joint-compliance", "0, as above",
    ),
} | {
    f"top.band{number}": Feature(
        "1", 0.0, f"ln(1 + mean square of the top's displacement at {low:g} to {high:g} Hz over the noise's)",
        "joint-compliance"
    )
    for number, (low, high) in enumerate(BANDS, start=1)
}  # fmt: skip


def kind(name):
    """Entry of the table for a feature's full name, such as ``joint2.pivot+``."""
    head, _, tail = name.partition(".")
    for table in (JOINT_FEATURES, SPIKE_FEATURES) if head.startswith("joint") else ():
        if tail in table:
            return table[tail]
    return (BASE_FEATURES | BASE_MOTION_FEATURES | TOP_FEATURES)[name]
