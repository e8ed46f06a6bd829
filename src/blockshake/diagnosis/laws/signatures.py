"""Signatures of effects in the laws: the law that each breaks, and those that it may break on the way.

The table is a matrix of structured residuals (Gertler 1998; Frisk, Krysander and Jung 2017): an effect is isolated
if it accounts for all laws that are broken, and its own law is.
"""

from typing import NamedTuple

from blockshake.effects.registry import EFFECTS

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
    excludes : float
        Departure of its own law, in the law's unit, that the effect at its visible size makes where that is told at its
        place: if the law is told better than that and holds there, the effect is excluded. 0: no departure is sure.
    """

    own: str
    sign: int
    others: tuple
    excludes: float = 0.0


STOP, ECCENTRIC = "stopper-contact", "eccentricity"  # told by the law of the force that would explain them
OF_A_STOP = (*OUTSIDE, *_IMPACTS, "closed.compliance")
OF_ANY = _IMPACTS  # whatever acts on the blocks lets them meet at other velocities


def _visible(effect, share=1.0):
    """Share of an effect's visible size that its own law departs by."""
    first = EFFECTS[effect].parameters[0]
    return share * abs(first.visible - first.null)


SIGNATURES = {
    "table-pitch": Signature(
        "table.pitch", 0,
        ("lever.short", "lever.bias", "lever.slope", "unexplained.rms", "unexplained.largest", "unexplained.mean",
         "closed.compliance", *_IMPACTS),
        excludes=_visible("table-pitch"),
    ),
    "base-compliance": Signature(
        "table.compliance", 1,
        ("lever.short", "lever.slope", "unexplained.rms", "unexplained.largest", "closed.compliance", *_IMPACTS),
        excludes=_visible("base-compliance"),
    ),
    "reduced-bearing": Signature(
        "lever.short", 1,
        ("lever.slope", "lever.stray", "unexplained.rms", "unexplained.largest", "closed.compliance", *_IMPACTS),
        excludes=_visible("reduced-bearing"),
    ),
    "eccentricity": Signature(
        "lever.bias", 0, ("lever.short", "unexplained.rms", "unexplained.largest", "unexplained.mean", *_IMPACTS),
        excludes=_visible("eccentricity", 1.0 / 3.0),  # one of three blocks that a joint carries
    ),
    "weak-joint": Signature(
        "friction.loss", 1, ("closed.compliance", "lever.stray", *_IMPACTS), excludes=_visible("weak-joint"),
    ),
    "rate-weakening-friction": Signature(
        "friction.rate", -1, ("friction.loss", "closed.compliance", "lever.stray", *_IMPACTS)
    ),
    "impact-restitution": Signature("impact.ringing", 1, ("impact.kept", "friction.loss", "closed.compliance")),
    "joint-compliance": Signature(
        "closed.compliance", 1, ("lever.short", "lever.slope", "lever.stray", *_IMPACTS)
    ),
}  # fmt: skip
