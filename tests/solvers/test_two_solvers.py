"""LS-DEM with stiff, critically damped contacts beside nonsmooth contact dynamics: 2 % of the peak.

Both move the same blocks; what differs is the contact: springs and dashpots against Signorini's condition. As the
springs stiffen, what they store and how long an impact lasts go to zero with the square root of the stiffness.
"""

import numpy as np
import pytest
from rail_nodes import rail_nodes

from blockshake.dynamics.motion import ground_motion
from blockshake.geometry.structure import build_structure, load_structure
from blockshake.measurement.sensors.markers import marker_position
from blockshake.solvers.ls_dem import surfaces
from blockshake.solvers.ls_dem.driver import simulate_ls_dem
from blockshake.solvers.ls_dem.parameters import LsDemParameters
from blockshake.solvers.nscd.driver import simulate_nscd
from blockshake.solvers.nscd.parameters import NscdParameters

pytestmark = pytest.mark.slow

RATE = 200  # Hz
INSET = 1e-3  # m, of LS-DEM's pivots from the edge of a flat; far above the 2 um of an impact's penetration
FLAT = 0.76  # m, width of the flats
SHIFT = (
    1e-5  # m, of the twin: the sink of a stack at rest at the usual stiffness, which rigid blocks do not have
)
AGREE = 0.02  # of the peak, aimed at
SPREAD = 0.01  # of the peak, at which twins have parted: half of what is asked for is then chance
NORMAL, SHEAR = (
    LsDemParameters.model_fields[name].default for name in ("normal_stiffness", "shear_stiffness")
)


def motion(duration):
    """One cycle of 1.5 Hz and 2.5 m/s2, and rest: the motion of LS-DEM's convergence in docs/method.md."""
    omega, time = 3.0 * np.pi, np.arange(round(1000 * duration) + 101) / 1000.0
    swing = np.cos(omega * np.minimum(time, 1.0 / 1.5)) - 1.0
    return ground_motion("one cycle", time, {"x": 2.5 / omega**2 * swing}, "displacement", {"source": "test"})


def structure(name, shift=0.0):
    """Shipped structure without rebound, its highest block shifted by ``shift``; or configuration 1 in one piece."""
    mapping = load_structure("configuration-1" if name == "monolith" else name).file.model_dump()
    mapping["restitution"] = 0.0  # critical damping
    if name == "monolith":
        mapping["shapes"]["block"]["box"] = [0.8, 2.4, 4.8]
        mapping["bodies"] = [mapping["bodies"][0], {**mapping["bodies"][1], "position": [0.0, 0.0, 2.4]}]
        slab = [marker for marker in mapping["markers"] if marker["body"] == "slab"]
        mapping["markers"] = [*slab, {"name": "top", "body": "block-1", "position": [0.0, -1.2, 1.6]}]
        mapping["accelerometers"] = []
    x, y, z = mapping["bodies"][-1]["position"]
    mapping["bodies"][-1]["position"] = [x + shift, y, z]
    return build_structure(mapping, name, ".")


def times(duration):
    return np.arange(round(duration * RATE) + 1) / RATE


def relative(built, run):
    """Displacement of the blocks' markers relative to the slab's first [m], shape (n_times, n_markers, 3)."""
    assert run.status == "completed", run.reason
    place = marker_position(built, run.position, run.orientation)
    place = place - place[:, :1]
    return (place - place[:1])[:, [marker.body != "slab" for marker in built.file.markers]]


def by_nscd(name, duration, shift=0.0, time_step=1e-4):
    # contact areas drawn in to where LS-DEM's outermost nodes are
    parameters = NscdParameters(impact_parts=20, shrink=2.0 * INSET / FLAT)
    built = structure(name, shift)
    return relative(built, simulate_nscd(built, motion(duration), parameters, times(duration), time_step))


def by_ls_dem(name, duration, stiffer, time_step, shift=0.0, spacing=0.4):
    parameters = LsDemParameters(
        normal_stiffness=stiffer * NORMAL,
        shear_stiffness=stiffer * SHEAR,
        perimeter_inset=INSET / FLAT,
        node_spacing=spacing,
    )
    built = structure(name, shift)
    run = simulate_ls_dem(built, motion(duration), parameters, times(duration), time_step)
    assert time_step < run.numerics["stable_time_step"]
    return relative(built, run)


def apart(one, other):
    """Largest distance of a marker in one run from itself in the other, over the peak of ``other`` [1], by time."""
    return np.linalg.norm(one - other, axis=2).max(axis=1) / np.abs(other[..., 0]).max()


def first_above(share, level):
    """First time at which a share is above a level [s]; infinite where it never is."""
    above = np.flatnonzero(share > level)
    return above[0] / RATE if len(above) else np.inf


@pytest.fixture
def on_rails(monkeypatch):
    monkeypatch.setattr(surfaces, "box_nodes", rail_nodes)


def test_a_monolith_rocks_alike_the_more_the_stiffer(on_rails):
    """One body as large as the three blocks, one cycle, then free rocking with an impact every 0.6 s."""
    exact = by_nscd("monolith", 6.0)
    differences = [
        apart(by_ls_dem("monolith", 6.0, *setting), exact).max() for setting in ((100, 5e-6), (1000, 2e-6))
    ]
    assert differences[1] < AGREE
    # an impact lasts 1 / sqrt(k): ten times the stiffness, a third of the difference
    assert differences[0] / differences[1] == pytest.approx(np.sqrt(10.0), rel=0.15)


def test_stacks_agree_until_their_horizon(on_rails):
    """Configurations 2 and 3 at a hundred times the usual stiffness: 6 s, and until twins have parted."""
    for name, duration in (("configuration-2", 6.0), ("configuration-3", 3.0)):
        exact, twin = (by_nscd(name, duration, shift=shift) for shift in (0.0, SHIFT))
        horizon = min(first_above(apart(twin, exact), SPREAD), duration)
        assert horizon > 2.0
        difference = apart(by_ls_dem(name, duration, 100, 4e-6), exact)
        assert difference[: round(horizon * RATE)].max() < AGREE


def test_configuration_1_agrees_for_seven_impacts(on_rails):
    """Its twins do not part in 6 s, so that 2 % until then is aimed at. This is missed, by the joints' impacts.

    An impact opens the upper joints by some 0.1 mrad for an instant, which rigid contacts do not, and takes up to 3 %
    more or less energy. The stack swings on with another period, and drifts out of step: docs/theory/nscd.md.
    """
    exact = by_nscd("configuration-1", 4.5)
    difference = apart(by_ls_dem("configuration-1", 4.5, 1000, 2e-6), exact)
    # the seventh impact is at 4.2 s; 2 % is passed at 4.67 s
    assert difference[: round(4.3 * RATE)].max() < AGREE


def test_whole_faces_part_with_the_first_impact():
    """With nodes all over its faces LS-DEM has another impact, however stiff: why the others bear on rails."""
    exact = by_nscd("configuration-1", 1.5)
    difference = apart(by_ls_dem("configuration-1", 1.5, 100, 5e-6, spacing=0.2), exact)
    # first impact at 0.25 s, 2 % passed at 0.48 s, before the first peak
    assert difference[: round(0.25 * RATE)].max() < AGREE
    assert difference.max() > 5.0 * AGREE
