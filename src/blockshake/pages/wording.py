"""Words and numbers as a report prints them: names of models and parameters, digits."""

import numpy as np

from blockshake.geometry.schema import AXES
from blockshake.simulation.models import MODELS, NAME_IN_STUDY

CUBED = "\N{SUPERSCRIPT THREE}"
SQUARED = "\N{SUPERSCRIPT TWO}"
MICRO = "\N{MICRO SIGN}"
MISSING = "none"  # where a file holds no number
SHOWN_QUANTILES = (0.05, 0.5, 0.95)
_PROPERTIES = {
    "density": "density",
    "youngs_modulus": "Young's modulus",
    "viscous_modulus": "viscous modulus",
    "poisson_ratio": "Poisson's ratio",
}
_NAMES = {
    "ls_dem.normal_stiffness": "normal stiffness k_n",
    "ls_dem.shear_stiffness": "shear stiffness k_s",
    "restitution": "restitution C_res",
    "nscd_restitution": "Newton's restitution",
    "motion.scale": "factor of the motion",
    "motion.heading": "heading of the motion",
    "hollow": "hollow of the faces over their edge",
    "stiffness_factor": "factor of contact stiffness",
}


def model_label(model):
    """Name in print of a solver, and of a study's model: ``LS-DEM as printed`` of ``ls-dem-as-printed``."""
    named = NAME_IN_STUDY.fullmatch(model)
    return f"{MODELS[named[1]].label}{named[2].replace('-', ' ')}" if named else model


def parameter_label(name):
    """A parameter's dotted name in words, such as ``friction, concrete on steel``."""
    if name in _NAMES:
        return _NAMES[name]
    kind, *rest = name.split(".")
    if kind == "extension":  # a part of a vector has its axis at the end
        places, key = (rest[1:-2], " ".join(rest[-2:])) if rest[-1] in AXES else (rest[1:-1], rest[-1])
        return f"cause: {key.replace('_', ' ')} of {' and '.join(places)}"
    if kind in ("friction", "joints"):
        words = ["friction", *rest[2:]] if kind == "friction" else rest[2:]
        return f"{' '.join(words).replace('_', ' ')}, {rest[0]} on {rest[1]}"
    if kind in ("materials", "shapes", "bodies"):
        return f"{_PROPERTIES.get(rest[1], ' '.join(rest[1:]).replace('_', ' '))} of {rest[0]}"
    return " ".join(name.split(".")).replace("_", " ")


def number(value, digits=3):
    """A number with so many significant digits, a whole number below a million with all, or `MISSING`."""
    value = float(value)
    if not np.isfinite(value):
        return MISSING
    if value.is_integer() and abs(value) < 1e6:
        return f"{value:.0f}"
    magnitude = int(np.floor(np.log10(abs(value))))
    if -3 <= magnitude < 6:
        return f"{value:.{max(digits - 1 - magnitude, 0)}f}"
    return f"{value:.{digits - 1}e}"


def given(value):
    """A number that somebody chose, with the digits it was given."""
    return f"{float(value):g}"


def millimetres(value):
    """A length [m] in mm to 0.1 mm."""
    # adding zero makes a minus zero of the rounding a zero
    return f"{round(1e3 * float(value), 1) + 0.0:.1f}" if np.isfinite(value) else MISSING


def millimetre_range(values):
    """Smallest and largest of some lengths [m] in mm, such as ``50 to 400``, to 0.1; NaN is none of them."""
    ends = {round(1000.0 * float(end), 1) for end in (np.nanmin(values), np.nanmax(values))}
    return " to ".join(f"{end:g}" for end in sorted(ends))


def percent(value):
    """A share in percent to 0.1."""
    return f"{100.0 * float(value):.1f}" if np.isfinite(value) else MISSING


def quantile_percent(probability):
    """Name of a quantile: ``95 %``."""
    return f"{100.0 * probability:g} %"


def limited(found, name, show=number):
    """Number of a Dataset with its limits in ``NAME_interval(bound)``, ``3.0 [2.5, 3.4]``; alone where it has none."""
    value, limits = float(found[name]), found[f"{name}_interval"].sel(bound=["lower", "upper"]).to_numpy()
    if np.isnan(value) or np.isnan(limits).any():
        return show(value) if np.isfinite(value) else MISSING
    return f"{show(value)} [{', '.join(show(one) if np.isfinite(one) else 'no limit' for one in limits)}]"


def share_words(count, total):
    """Some of a number: ``3 of 5``.

    >>> share_words(3, 5), share_words(5, 5), share_words(0, 5)
    ('3 of 5', 'all 5', 'none of 5')
    """
    return {total: f"all {total}", 0: f"none of {total}"}.get(count, f"{count} of {total}")


def count_words(count, noun):
    """A number of things: ``2 models``.

    >>> count_words(1, "model"), count_words(0, "model")
    ('1 model', '0 models')
    """
    return f"{count} {noun}" if count == 1 else f"{count} {noun}s"


def time_words(seconds):
    """A time that work takes, at least a second: ``45 s``.

    >>> time_words(0.2), time_words(45.0), time_words(600.0), time_words(2e4)
    ('1 s', '45 s', '10 min', '5.6 h')
    """
    if seconds < 90.0:
        return f"{max(seconds, 1.0):.0f} s"
    return f"{seconds / 60.0:.0f} min" if seconds < 7200.0 else f"{seconds / 3600.0:.1f} h"


def listed(words, last="and"):
    """Words in a row: ``a, b and c``."""
    *others, end = words
    return f"{', '.join(others)} {last} {end}" if others else end


def sentence_case(text):
    """Text as a sentence: first letter large, full stop at the end."""
    return f"{text[0].upper()}{text[1:]}."
