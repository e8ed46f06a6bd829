"""Signatures of effects in the laws: the law that each breaks, and those that it may break on the way.

The table is a matrix of structured residuals (Gertler 1998; Frisk, Krysander and Jung 2017): an effect is isolated
if it accounts for all laws that are broken, and its own law is.
"""

from typing import NamedTuple

OUTSIDE = ("lever.bias", "lever.step", "lever.short", "lever.slope", "lever.stray", "unexplained.rms",
           "unexplained.largest", "unexplained.mean")  # fmt: skip
_IMPACTS = ("impact.kept", "impact.ringing")


class Signature(NamedTuple):
    """Laws of an effect.

    Attributes
    ----------
    own : str
        Kind of the law that it breaks wherever it is seen at all.
    sign : int
        Of the departure; 0 for either.
    others : tuple of str
        Kinds of laws that it may break too.
    excludes : bool
        Whether the effect at its visible size surely breaks its own law where that is told at its place: if the law
        holds there, the effect is excluded.
    """

    own: str
    sign: int
    others: tuple
    excludes: bool = False


STOP, ECCENTRIC = "stopper-contact", "eccentricity"  # told by the law of the force that would explain them
OF_A_STOP = (*OUTSIDE, *_IMPACTS, "closed.compliance")
OF_ANY = _IMPACTS  # whatever acts on the blocks lets them meet at other velocities

SIGNATURES = {
    "table-pitch": Signature(
        "table.pitch", 0,
        ("lever.short", "lever.slope", "unexplained.rms", "unexplained.largest", "closed.compliance", *_IMPACTS),
        excludes=True,
    ),
    "base-compliance": Signature(
        "table.compliance", 1,
        ("lever.short", "lever.slope", "unexplained.rms", "unexplained.largest", "closed.compliance", *_IMPACTS),
        excludes=True,
    ),
    "reduced-bearing": Signature(
        "lever.short", 1,
        ("lever.slope", "lever.stray", "unexplained.rms", "unexplained.largest", "closed.compliance", *_IMPACTS),
        excludes=True,
    ),
    "eccentricity": Signature(
        "lever.bias", 0, ("unexplained.rms", "unexplained.largest", "unexplained.mean", *_IMPACTS),
        excludes=True,
    ),
    "weak-joint": Signature(
        "friction.loss", 1, ("friction.rate", "closed.compliance", "lever.stray", *_IMPACTS), excludes=True
    ),
    "rate-weakening-friction": Signature(
        "friction.rate", -1, ("friction.loss", "closed.compliance", "lever.stray", *_IMPACTS)
    ),
    "impact-restitution": Signature("impact.ringing", 1, ("impact.kept", "friction.loss", "closed.compliance")),
    "joint-compliance": Signature(
        "closed.compliance", 1, ("lever.short", "lever.slope", "lever.stray", *_IMPACTS)
    ),
}  # fmt: skip
