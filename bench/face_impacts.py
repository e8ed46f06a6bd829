"""A square that comes down on a face while it rocks: the spin it keeps, by both solvers and by impacts in sequence.

``python bench/figures_of_docs.py face-impacts`` writes the table of docs/theory/rocking.md. The body is that of the
measured drops (docs/results/measured.md), and all paths are read by the program that reads those: the films need not
be there.
"""

import itertools
from typing import NamedTuple

import numba
import numpy as np
from scipy.spatial.transform import Rotation

from blockshake.dynamics.motion import GroundMotion, rest_table
from blockshake.forces.flight.impacts import find_impacts, summary
from blockshake.geometry.rotations import rotation_matrices
from blockshake.geometry.structure import build_structure
from blockshake.measurement.poses.posed_test import PosedCampaign, PosedTest
from blockshake.simulation.simulate import simulate

HALF, DENSITY, GRAVITY, RATE = 0.03, 1200.0, 9.81, 250.0  # m, kg/m3, m/s2, readings a second
MASS = DENSITY * (2.0 * HALF) ** 3  # kg
GYRATION = 2.0 * HALF**2 / 3.0  # moment of inertia about the mass centre over the mass [m2]
DURATION = 0.08  # s; the face comes down after 24 to 33 ms
FALLEN, SPINS, SLIPS = (0.04, 0.06, 0.1), (0.0, 2.0, 5.0, 10.0), (-0.2, 0.0, 0.2)  # rad, rad/s, m/s
LEAD = 0.03  # s of turning at the spin of the start, by which it is tilted more: five readings fit before the impact
FRICTION, RESTITUTION = 0.13, 0.45
GROUND = 0.5  # m, width
HEADER = ("model", "setting", "faces", "returned [%]", "spin kept", "quartiles")


class Start(NamedTuple):
    """A square that touches the ground with its left edge: tilt [rad], spin [rad/s], speed of that edge along x [m/s].

    The tilt is positive where the right edge is up, so that it falls to the right by a negative spin.
    """

    tilt: float
    spin: float
    slip: float


def starts():
    """All `Start`."""
    return [
        Start(fallen - LEAD * spin, spin, slip)
        for fallen, spin, slip in itertools.product(FALLEN, [-spin for spin in SPINS], SLIPS)
    ]


def posture(start):
    """Place and velocity of the mass centre at a start: x, z, u, v [m, m/s], the touching edge at the origin."""
    c, s = np.cos(start.tilt), np.sin(start.tilt)
    x, z = HALF * (c - s), HALF * (c + s)
    return x, z, start.slip - start.spin * z, start.spin * x


# ---- impacts in sequence ----


@numba.njit
def strike(velocity, arm, gyration, restitution, friction):
    """One impact at a point of a planar body: Newton's restitution, and friction that sticks where Coulomb lets it.

    Parameters
    ----------
    velocity : float64 array, shape (3,)
        Of the mass centre along x and z [m/s], and spin, positive from x to z [rad/s]; changed in place.
    arm : (float, float)
        From the mass centre to the point [m].
    gyration : float
        Moment of inertia about the mass centre over the mass [m2].
    restitution, friction : float
        [1]; infinite friction always sticks.

    Returns
    -------
    along, normal : float
        Impulse over the mass [m/s].
    """
    x, z = arm
    slip, closing = velocity[0] - velocity[2] * z, velocity[1] + velocity[2] * x
    tt, nn, tn = 1.0 + z * z / gyration, 1.0 + x * x / gyration, -x * z / gyration
    gain = -(1.0 + restitution) * closing
    # both velocities after: slip + tt along + tn normal = 0, closing + tn along + nn normal = -restitution closing
    normal = (gain * tt + tn * slip) / (tt * nn - tn * tn)
    along = -(slip + tn * normal) / tt
    if abs(along) > friction * normal:
        side = 1.0 if along > 0.0 else -1.0
        normal = gain / (nn + side * friction * tn)
        along = side * friction * normal
    velocity[0] += along
    velocity[1] += normal
    velocity[2] += (x * normal - z * along) / gyration
    return along, normal


@numba.njit
def strike_in_sequence(velocity, arms, touching, gyration, restitution, friction):
    """Impacts one after another at the points that touch, always where it closes fastest, until none closes.

    ``arms`` (n, 2): of the points [m]; ``touching`` (n,); the rest as of `strike`. The number of impacts is returned.
    """
    struck = 0
    while struck < 10_000:
        at, fastest = -1, -1e-9
        for point in range(len(arms)):
            closing = velocity[1] + velocity[2] * arms[point, 0]
            if touching[point] and closing < fastest:
                at, fastest = point, closing
        if at < 0:
            break
        strike(velocity, (arms[at, 0], arms[at, 1]), gyration, restitution, friction)
        struck += 1
    return struck


@numba.njit
def _paths(place, velocity, corners, gyration, restitution, friction, dt, every, rows):
    """Poses x, z, angle of a body whose corners hit the ground in sequence, (rows, 3), one each ``every`` steps."""
    found = np.empty((rows, 3))
    arms, touching = np.empty_like(corners), np.empty(len(corners), np.bool_)
    for row in range(rows):
        found[row] = place
        for _ in range(every):
            velocity[1] -= GRAVITY * dt
            c, s = np.cos(place[2]), np.sin(place[2])
            for corner in range(len(corners)):
                arms[corner, 0] = c * corners[corner, 0] - s * corners[corner, 1]
                arms[corner, 1] = s * corners[corner, 0] + c * corners[corner, 1]
                touching[corner] = place[1] + arms[corner, 1] <= 0.0
            strike_in_sequence(velocity, arms, touching, gyration, restitution, friction)
            place += dt * velocity
    return found


def sequence_path(start, restitution, friction, dt=1e-5):
    """Poses of a square by impacts in sequence, at the readings."""
    x, z, u, v = posture(start)
    corners = HALF * np.array([[-1.0, -1.0], [1.0, -1.0]])
    rows, every = round(DURATION * RATE) + 1, round(1.0 / (RATE * dt))
    return _paths(
        np.array([x, z, start.tilt]), np.array([u, v, start.spin]), corners, GYRATION, restitution, friction,
        dt, every, rows,
    )  # fmt: skip


def kept_at_once(restitution, friction, slip=0.0):
    """Spin kept by a square's one sequence of impacts, no gravity and no film in between.

    ``slip``: speed of the edge about which it turned before the impact, over half the side and the spin, positive
    toward the far edge [1].
    """
    velocity = np.array([HALF + slip * HALF, -HALF, -1.0])
    arms = HALF * np.array([[-1.0, -1.0], [1.0, -1.0]])
    strike_in_sequence(velocity, arms, np.ones(2, np.bool_), GYRATION, restitution, friction)
    return -velocity[2]


# ---- the solvers ----


def square(restitution, friction, start=None, layer=0.0):
    """The square over a ground that is 0.5 m wide; ``layer``: normal compliance between them [m3/N]."""
    x, z, u, v = posture(start) if start else (0.0, 1.0, 0.0, 0.0)
    # a turn from x to z is negative about y
    turned = Rotation.from_rotvec([0.0, -start.tilt if start else 0.0, 0.0])
    ground = {
        "name": "ground", "shape": "ground", "material": "body", "position": [0.0, 0.0, -0.1], "driven": True,
    }  # fmt: skip
    body = {
        "name": "square", "shape": "square", "material": "body", "position": [x, 0.0, z], "velocity": [u, 0.0, v],
        "orientation": turned.as_quat(scalar_first=True).tolist(),
        "angular_velocity": [0.0, -start.spin if start else 0.0, 0.0],
    }  # fmt: skip
    joints = [{"bodies": ["ground", "square"], "compliance": layer}] if layer else []
    return build_structure(
        {
            "name": "square",
            "materials": {"body": {"density": DENSITY, "youngs_modulus": 3e9, "poisson_ratio": 0.37}},
            "shapes": {"ground": {"box": [GROUND, GROUND, 0.2]}, "square": {"box": [2.0 * HALF] * 3}},
            "bodies": [ground, body],
            "friction": [{"pair": ["body", "body"], "coefficient": friction}],
            "restitution": restitution, "nscd_restitution": restitution, "joints": joints,
        },
        "square", ".",
    )  # fmt: skip


def solver_path(start, restitution, friction, solver, layer=0.0, **options):
    """Poses of a square by a solver, at the readings; ``options`` of `simulate`."""
    still = GroundMotion("ground at rest", rest_table(), "displacement")
    run = simulate(
        square(restitution, friction, start, layer), still, solver, duration=DURATION, output_rate=RATE,
        accelerometers=False, **options,
    )  # fmt: skip
    place, turned = run["position"].to_numpy()[:, 1], rotation_matrices(run["orientation"].to_numpy()[:, 1])
    # the angle from x to z
    return np.column_stack([place[:, 0], place[:, 2], np.arctan2(turned[:, 2, 0], turned[:, 0, 0])])


# ---- how they are read ----


def read(paths):
    """The first face of each path that comes down, by the program that reads films: `FlightImpact`."""
    structure = square(0.0, FRICTION)
    vertices = structure.solids["square"].polyhedron.vertices
    tests = []
    for number, path in enumerate(paths):
        rotation = Rotation.from_rotvec(np.outer(-path[:, 2], [0.0, 1.0, 0.0])).as_matrix()
        place = np.column_stack([path[:, 0], np.zeros(len(path)), path[:, 1]])
        tests.append(PosedTest(f"{number:03d}", np.arange(len(path)) / RATE, place, rotation, planar=True))
    first = {}
    for impact in find_impacts(PosedCampaign(structure, tests, 1, vertices, 0.0), []):
        first.setdefault(impact.test, impact)
    return list(first.values())


def row(model, setting, path, **settings):
    """Row of the table: of all starts, by a program ``path`` with its settings."""
    found = summary(read([path(start, **settings) for start in starts()])).get("face", {})
    if "returned" not in found:
        return model, setting, 0, "", "", ""
    kept, returned = found["kept"], found["returned"]
    return (
        model, setting, returned["count"], f"{100.0 * returned['share']:.0f}", f"{kept['median']:.2f}",
        f"{kept['lower']:.2f} to {kept['upper']:.2f}",
    )  # fmt: skip


