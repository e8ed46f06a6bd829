"""Shenton's (1996) chart of rest, slide, rock and slide-rock: points a little off each of its boundaries.

Criteria for initiation of slide, rock, and slide-rock rigid-body modes, J. Eng. Mech. 122(7). Base acceleration
``a`` in g and friction ``mu`` of a block of ``b/h``: rest below both; slide where ``mu < b/h``; with ``mu > b/h``
and ``a > b/h`` rock without slip asks for ``needed(a)``; slide-rock between ``b/h`` and that.
"""

import numpy as np
from rocking_theory import G, H

from blockshake.dynamics.motion import ground_motion


def needed(rocker, a):
    """Friction that holds the pivot as rocking sets in under ``a``, from rest.

    About the pivot ``I q = m (a h - g b)``; there the base gives ``a - h q`` across and ``g + b q`` up.
    """
    q = rocker.mass * (a * H - rocker.pivot) / rocker.inertia
    return (a - H * q) / (1.0 + rocker.pivot * q)


def points(rocker, off):
    """Name, friction, acceleration [g], whether it slides and rocks, duration [s]; off each boundary by ``off``."""
    low, high, slim = 1.0 - off, 1.0 + off, rocker.pivot / H
    # the boundary of rest: a = mu under b/h, and a = b/h over it
    for mu in (0.15, 0.3, 0.45):
        yield f"rest-{mu}", mu, low * mu, False, False, 0.5
        yield f"slide-{mu}", mu, high * mu, True, False, 0.5
    for mu in (0.6, 0.9):
        yield f"rest-{mu}", mu, low * slim, False, False, 0.6
        yield f"rock-{mu}", mu, high * slim, False, True, 0.6
    # the wedge of slide-rock between mu = b/h and mu = needed(a), from its tip at a = b/h on; a wedge narrower
    # than two margins, as at 0.55 g, has no point inside it
    for a in (0.7, 0.9, 1.2):
        yield f"slide-under-{a}", low * slim, a, True, False, 0.25
        yield f"slide-rock-over-{a}", high * slim, a, True, True, 0.25
        yield f"slide-rock-under-{a}", low * needed(rocker, a), a, True, True, 0.2
        yield f"rock-over-{a}", high * needed(rocker, a), a, False, True, 0.2


def hold(a, slides, rocks, duration):
    """Motion whose acceleration is reached within 10 ms (50 ms for rest, which must not be jerked) and held."""
    ramp = 0.01 if (slides and rocks) or duration < 0.3 else 0.05
    return ground_motion("hold", [0.0, ramp, duration], {"x": [0.0, a * G, a * G]}, "acceleration")


def edge_of(run, rocker, lean):
    """Place along x of the edge at -x about which the block leans, seen from the slab [m]."""
    return run.position[:, 1, 0] - rocker.pivot * np.cos(lean) - H * np.sin(lean) - run.position[:, 0, 0]
