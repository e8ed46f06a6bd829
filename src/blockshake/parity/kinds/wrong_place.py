"""A marker, or an end of a displacement transducer, sits elsewhere on its body than in the structure ."""

import numpy as np

from blockshake.parity.body_markers import BodyMarkers
from blockshake.parity.kinds.kind import Column, Kind


def _correct(test, findings, structure):
    """Move markers to where the structure has them, by the rotation of their body.

    Where fewer than three markers are read the reading becomes a gap. The reading of a displacement transducer stays:
    it is right, of other points than in the structure .
    """
    offsets = {finding.where[0]: finding.estimate for finding in findings}
    for name in structure.body_names:
        body = BodyMarkers.of(structure, name, {"": test}, test["marker"].values).in_test()
        if offsets.keys().isdisjoint(body.markers):
            continue
        places = np.array([offsets.get(marker, np.zeros(3)) for marker in body.markers])
        turned = body.frame(body.readings[0][1], places).rotation - body.rotation
        for marker in offsets.keys() & set(body.markers):
            test["marker_displacement"].loc[{"marker": marker}] -= turned @ offsets[marker]


PLACE = Kind(
    quantity="place",
    effect="marker-offset",
    equation="reading = displacement of the stated point + (R - R0) e",
    correct=_correct,
    units=("m", "m"),
    size=2,  # the registry's effect has the height
)
REFERENCE_PLACE = PLACE._replace(quantity="reference place", correct=None)

# m, along any direction: markers are mounted within 1 mm along each axis, hooks and brackets are placed with a tape
OF_MARKER = Column(PLACE, 3, 2e-3, lambda seen: (np.eye(3) - seen.turned)[:, None])
OF_END = Column(PLACE, 3, 5e-3, lambda held: held.places[:, :3], visible=0.05)
OF_REFERENCE_END = Column(REFERENCE_PLACE, 3, 5e-3, lambda held: held.places[:, 3:], visible=0.05)
