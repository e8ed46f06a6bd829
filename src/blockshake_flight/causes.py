"""Causes that a free flight can show, as the paths that they make, and what of them undamaged tests have anyway."""

from collections.abc import Callable
from dataclasses import dataclass

import numpy as np

from blockshake_flight.paths import (
    dragged,
    dragged_by_square,
    dragged_dry,
    longer,
    off_centre,
    pushed,
)

# sizes that undamaged tests have, and that are not named
_LENGTHS = 5e-3  # of all lengths: calibration of a camera
_CENTRE = 0.02  # of the radius: mass centre of a block said to be uniform
# small errors of undamaged tests, standard deviations
_LEVEL = 3e-3  # rad, of the camera's vertical
_AIR, _DRAG_COEFFICIENT, _UNSURE = 1.2, 1.05, 0.5  # kg/m3; of a cube (Hoerner 1965); share of both


@dataclass(frozen=True)
class FlightCause:
    """A cause as a registered effect or a form from outside, by its paths in a flight."""

    # name, title: as in ``verdict.json``, and in words
    name: str
    title: str
    sizes: tuple  # of (str, str); name and unit of each amplitude
    paths: Callable  # of an `Arc` and the `TrackedCampaign`: (n, n_amplitudes, 3), per unit of the amplitudes
    scale: Callable  # of the `TrackedCampaign`: standard deviation of the amplitudes' prior
    positive: bool = False  # the amplitude is not negative
    nominal_size: Callable = lambda tracked: 0.0  # size that undamaged tests have
    alias: str = ""  # sentence on what flies alike; empty where nothing does


def _mass(tracked):
    return float(tracked.structure.mass[tracked.body])


def _gravity(tracked):
    return np.array(tracked.structure.file.gravity)


def _weight(tracked):
    return _mass(tracked) * float(np.linalg.norm(_gravity(tracked)))


def _sideways(arc, tracked):
    return pushed(arc)[:, :2] / _mass(tracked)


CAUSES = (
    FlightCause(
        "sensor-gain", "a scale error of the lengths", (("error", "1"),),
        lambda arc, tracked: longer(arc, _gravity(tracked)), lambda tracked: 0.03,
        nominal_size=lambda tracked: _LENGTHS,
        alias="gravity above the stated one by the same share, or a clock slow by half of it, would fall alike",
    ),
    FlightCause(
        "eccentricity", "mass centre off the middle", (("offset_x", "m"), ("offset_y", "m"), ("offset_z", "m")),
        lambda arc, tracked: off_centre(arc), lambda tracked: 0.1 * tracked.radius,
        nominal_size=lambda tracked: _CENTRE * tracked.radius,
        alias="an origin of the tracker that lies off the centroid by as much the other way would fly alike",
    ),
    FlightCause(
        "push", "a steady sideways push", (("force_x", "N"), ("force_y", "N")),
        _sideways, lambda tracked: 0.1 * _weight(tracked),
        alias="a vertical of the camera that is off by force over weight would look alike",
    ),
    FlightCause(
        "drag", "a viscous drag", (("damping", "N s/m"),),
        lambda arc, tracked: dragged(arc) / _mass(tracked), lambda tracked: 0.5 * _mass(tracked), True,
    ),
    FlightCause(
        "dry-drag", "a dry drag", (("force", "N"),),
        lambda arc, tracked: dragged_dry(arc) / _mass(tracked), lambda tracked: 0.05 * _weight(tracked), True,
    ),
    FlightCause(
        "square-drag", "a drag with the square of the speed", (("coefficient", "kg/m"),),
        lambda arc, tracked: dragged_by_square(arc) / _mass(tracked), lambda tracked: 0.5 * _mass(tracked), True,
    ),
)  # fmt: skip


def air_drag(tracked):
    """Drag of the air over the square of the speed and the mass [1/m].

    The mean shadow of a convex body is a quarter of its surface (Cauchy 1841).
    """
    solid = tracked.structure.solids[tracked.structure.file.bodies[tracked.body].shape]
    return 0.5 * _AIR * _DRAG_COEFFICIENT * 0.25 * solid.properties.area / _mass(tracked)


def nuisances(arc, tracked):
    """Paths of the small errors of undamaged tests times their standard deviations, (n, n_nuisances, 3)."""
    gravity = _gravity(tracked)
    tilted = pushed(arc)[:, :2] * _LEVEL * np.linalg.norm(gravity)
    return np.concatenate([tilted, _UNSURE * air_drag(tracked) * dragged_by_square(arc)], axis=1)
