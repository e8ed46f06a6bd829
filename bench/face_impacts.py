"""A square that comes down on a face while it rocks: the spin it keeps, by both solvers and by impacts in sequence.

``python bench/figures_of_docs.py face-impacts`` writes the table of docs/theory/rocking.md. The body is that of the
measured drops (docs/results/measured.md), and all paths are read by the program that reads those: the films need not
be there.
"""

import itertools
import os
import re
import sys
import tempfile
from dataclasses import replace
from pathlib import Path
from typing import NamedTuple

import numba
import numpy as np
from measured import make_campaign
from measured_impacts import SOLVERS
from scipy.spatial.transform import Rotation

from blockshake.dynamics.motion import GroundMotion, rest_table
from blockshake.geometry.rotations import rotation_matrices
from blockshake.geometry.structure import build_structure
from blockshake.measurement.campaigns.campaign import load_campaign
from blockshake.simulation.simulate import simulate
from blockshake_flight.arcs import find_arcs
from blockshake_flight.impacts import find_impacts, summary
from blockshake_flight.replay import FlightModel, filmed_replay, start_arc
from blockshake_flight.tracked_test import TrackedCampaign, TrackedTest, load_tracked

HALF, DENSITY, GRAVITY, RATE = 0.03, 1200.0, 9.81, 250.0  # m, kg/m3, m/s2, readings a second
MASS = DENSITY * (2.0 * HALF) ** 3  # kg
GYRATION = 2.0 * HALF**2 / 3.0  # moment of inertia about the mass centre over the mass [m2]
DURATION = 0.12  # s; the face comes down after some 30 ms, or later where the square hops first
FALLEN, SPINS = (0.04, 0.06, 0.1), (0.0, 2.0, 5.0, 10.0)  # rad, rad/s
SLIPS, HOPS = (-0.2, 0.0, 0.2), (0.0, 0.1, 0.2)  # m/s
LEAD = 0.03  # s of turning at the spin of the start, by which it is tilted more: five readings fit before the impact
FRICTION, RESTITUTION = 0.13, 0.4  # where only another setting is changed
RESTITUTIONS = (0.0, 0.2, 0.4, 0.5, 0.6, 0.8)
REPLAYED = {  # restitution on the filmed starts
    "nscd-rigid": ("NSCD", (0.35, 0.45, 0.5, 0.55, 0.6, 0.65)),
    "ls-dem": ("LS-DEM", (0.35, 0.45, 0.6, 0.7, 0.8)),
}
GROUND = 0.5  # m, width
MEASURED = Path(__file__).parents[1] / "docs" / "results" / "measured.md"
HEADER = ("model", "setting", "faces", "returned [%]", "spin kept", "quartiles")
REPLAY_HEADER = (*HEADER, "path error [mm]", "early error [mm]")
FILMS = (
    Path(os.environ.get("BLOCKSHAKE_SHARED") or MEASURED.parents[3] / "shared") / "measured" / "square-drops"
)
THEORY_HEADER = (
    "restitution",
    "sticks, in sequence",
    "sticks, at once",
    f"friction {FRICTION:g}, in sequence",
    f"friction {FRICTION:g}, at once",
    "no friction, in sequence",
)


class Row(NamedTuple):
    """For the table: ``returned``: share of the faces; ``kept``, ``lower``, ``upper``: spin kept and its quartiles."""

    model: str
    setting: str
    faces: int
    returned: float
    kept: float
    lower: float
    upper: float


class Start(NamedTuple):
    """A square that touches the ground with its left edge.

    ``tilt`` [rad], positive where the right edge is up, so that it falls to the right by a negative ``spin`` [rad/s];
    ``slip``, ``hop``: speed of the left edge along x and up [m/s].
    """

    tilt: float
    spin: float
    slip: float
    hop: float = 0.0


def starts():
    """All `Start`."""
    return [
        Start(fallen + LEAD * spin, -spin, slip, hop)
        for fallen, spin, slip, hop in itertools.product(FALLEN, SPINS, SLIPS, HOPS)
    ]


def posture(start):
    """Place and velocity of the mass centre at a start: x, z, u, v [m, m/s], the touching edge at the origin."""
    c, s = np.cos(start.tilt), np.sin(start.tilt)
    x, z = HALF * (c - s), HALF * (c + s)
    return x, z, start.slip - start.spin * z, start.hop + start.spin * x


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
        [1]; infinite friction sticks, at a point that does not slide before.

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


def kept_in_sequence(restitution, friction, slip=0.0):
    """Spin kept by a square's one sequence of impacts, no gravity and no film in between.

    ``slip``: speed of the edge about which it turned before the impact, over half the side and the spin, positive
    toward the far edge [1].
    """
    velocity = np.array([HALF + slip * HALF, -HALF, -1.0])
    arms = HALF * np.array([[-1.0, -1.0], [1.0, -1.0]])
    strike_in_sequence(velocity, arms, np.ones(2, np.bool_), GYRATION, restitution, friction)
    return -float(velocity[2])


def kept_together(restitution, friction):
    """Spin kept by a square's impact where Newton's law holds at both edges at the same instant, in closed form.

    The far edge leaves with the restitution; the other one, which did not close, stays where the impulse at the far
    edge pushes it down, and is lifted else.
    """
    # beyond this coefficient both edges stick: the ratio of the impulses of a pivot that sticks
    lever = HALF * (1.0 - min(friction, HALF**2 / (GYRATION + HALF**2)))
    lifted = (GYRATION - HALF * lever) / (GYRATION + HALF * lever)
    return lifted - restitution * (1.0 - lifted) if lifted > 0.0 else -restitution


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


def posed_square(tests):
    """`TrackedCampaign` of tests of the square over its ground."""
    structure = square(0.0, FRICTION)
    return TrackedCampaign(structure, tests, 1, structure.solids["square"].polyhedron.vertices, 0.0)


def read(paths):
    """The first face of each path that comes down, by the program that reads films: `FlightImpact`."""
    tests = []
    for number, path in enumerate(paths):
        rotation = Rotation.from_rotvec(np.outer(-path[:, 2], [0.0, 1.0, 0.0])).as_matrix()
        place = np.column_stack([path[:, 0], np.zeros(len(path)), path[:, 1]])
        tests.append(TrackedTest(f"{number:03d}", np.arange(len(path)) / RATE, place, rotation, planar=True))
    first = {}
    for impact in find_impacts(posed_square(tests), []):
        first.setdefault(impact.test, impact)
    return list(first.values())


def row(model, setting, path, **settings):
    """Row of the table: of all starts, by a program ``path`` with its settings."""
    return _row_of(model, setting, read([path(start, **settings) for start in starts()]))


def _row_of(model, setting, impacts):
    found = summary(impacts)["face"]
    kept, returned = found["kept"], found["returned"]
    return Row(
        model, setting, returned["count"], returned["share"], kept["median"], kept["lower"], kept["upper"]
    )


def _rounded(value, digits=2):
    """Decimals, without the sign of a zero."""
    return f"{round(value, digits) + 0.0:.{digits}f}"


def _cells(row):
    return (
        row.model, row.setting, row.faces, f"{100.0 * row.returned:.0f}", _rounded(row.kept),
        f"{_rounded(row.lower)} to {_rounded(row.upper)}",
    )  # fmt: skip


def measured_row():
    """Row of the table as docs/results/measured.md has it of the square."""
    line = next(line for line in MEASURED.read_text("utf-8").splitlines() if line.startswith("| measured |"))
    count, returned, kept, lower, upper = map(float, re.findall(r"-?[\d.]+", line))
    return Row("measured", "", int(count), returned / 100.0, kept, lower, upper)


def rows():
    """Rows of all settings, one after another."""
    for e in RESTITUTIONS:
        yield row(
            "impacts in sequence", f"restitution {e:g}", sequence_path, restitution=e, friction=FRICTION
        )
    for mu in (0.0, 0.3, 0.9):
        words = f"restitution {RESTITUTION:g}, friction {mu:g}"
        yield row("sequence of impacts", words, sequence_path, restitution=RESTITUTION, friction=mu)
    yield from _nscd_rows()
    yield from _ls_dem_rows()


def _nscd_rows():
    usual = {"path": solver_path, "solver": "nscd-rigid", "restitution": RESTITUTION, "friction": FRICTION}
    for e in RESTITUTIONS:
        yield row("NSCD", f"restitution {e:g}", **usual | {"restitution": e})
    base = f"restitution {RESTITUTION:g}"
    for step in (1e-4, 1e-5):
        yield row("NSCD", f"{base}, step {step:g} s", **usual, time_step=step)
    yield row("NSCD", f"{base}, friction 0.9", **usual | {"friction": 0.9})
    for layer in (1e-9, 1e-8, 1e-7):
        yield row("NSCD", f"layer {layer:g} m3/N, step 0.0001 s", **usual, time_step=1e-4, layer=layer)


def _ls_dem_rows():
    def one(words, e=RESTITUTION, mu=FRICTION, stiffness=2e9, nodes=3, step=2e-5):
        parameters = {
            "normal_stiffness": stiffness,
            "shear_stiffness": 0.5 * stiffness,
            "node_spacing": 2.0 * HALF,
        }
        parameters["node_spacing"] /= nodes - 1
        return row(
            "LS-DEM", words, solver_path, solver="ls-dem", restitution=e, friction=mu, time_step=step,
            parameters={f"ls_dem.{name}": value for name, value in parameters.items()},
        )  # fmt: skip

    for e in (*RESTITUTIONS[1:], 0.9):
        yield one(f"restitution {e:g}", e)
    base = f"restitution {RESTITUTION:g}"
    yield one(f"{base}, friction 0.9", mu=0.9)
    for stiffness in (2e8, 2e10):
        yield one(f"{base}, {stiffness:g} N/m3, step 5e-06 s", stiffness=stiffness, step=5e-6)
    yield one(f"{base}, step 5e-06 s", step=5e-6)
    for nodes in (5, 9):
        yield one(f"{base}, {nodes} nodes a side", nodes=nodes)


def off(row, measured):
    """How far a row is from the measured one: the larger difference of the share returned and of the spin kept [1]."""
    return max(abs(row.returned - measured.returned), abs(row.kept - measured.kept))


def nearest(found, measured):
    """A sentence on the row that comes nearest to the measured one, and its place among them."""
    at = int(np.argmin([off(one, measured) for one in found]))
    best = found[at]
    spans = (best.upper - best.lower) / (measured.upper - measured.lower)
    words = (
        f"{best.model}: nearest to the measured faces at {best.setting}: {best.returned:.0%} return, spin kept "
        f"{_rounded(best.kept)}, the larger of both differences {off(best, measured):.2f}. Its quartiles span "
        f"{spans:.0%} of those measured."
    )
    return words, at


def face_impacts():
    """Cells of the table, and a sentence on the nearest setting of each model."""
    measured, found = measured_row(), list(rows())
    models = [list(own) for _, own in itertools.groupby(found, lambda one: one.model)]
    return [_cells(one) for one in [measured, *found]], [nearest(own, measured)[0] for own in models]


def theory_rows():
    """Rows of the spin kept at the instant of the impact, one of each restitution."""
    for e in RESTITUTIONS:
        kept = (
            kept_in_sequence(e, np.inf), kept_together(e, np.inf), kept_in_sequence(e, FRICTION),
            kept_together(e, FRICTION), kept_in_sequence(e, 0.0),
        )  # fmt: skip
        yield f"{e:g}", *(_rounded(one, 3) for one in kept)


def replayed():
    """Cells and sentences of the filmed drops from their own starts; None where the films are not there.

    Tests and settings of the solvers are those of docs/results/measured.md. The errors are the mean distances from the
    film, over all and until 0.1 s after the first flight, as `diagnose` has them.
    """
    if not FILMS.is_dir():
        return None
    with tempfile.TemporaryDirectory() as folder:
        campaign = load_campaign(make_campaign("square-drops", FILMS, Path(folder) / "drops", 1))
        posed = load_tracked(campaign, list(campaign.open))
    arcs, _ = find_arcs(posed)
    measured = _row_of("measured", "", find_impacts(posed, arcs))
    cells, words = [(*_cells(measured), "", "")], []
    for solver, (model, restitutions) in REPLAYED.items():
        runs = [(_replayed(posed, arcs, solver, model, e)) for e in restitutions]
        found, errors = zip(*runs, strict=True)
        cells += [(*_cells(one), *(f"{value:.1f}" for value in own)) for one, own in runs]
        sentence, at = nearest(found, measured)
        path, early = np.argmin(errors, axis=0)
        words.append(
            f"{sentence} There the early error is {errors[at][1] / errors[early][1]:.1f} times the least, which is at "
            f"{found[early].setting}, and that of whole paths {errors[at][0] / errors[path][0]:.1f} times the least, "
            f"at {found[path].setting}."
        )
    return cells, words


def _replayed(posed, arcs, solver, model, restitution):
    """Row of the table of films, and the mean errors of path and early path [mm]."""
    count, options = SOLVERS[solver]
    tests = [(test, arc) for test in posed.tests if (arc := start_arc(test, arcs)) is not None][:count]
    known = FlightModel(FRICTION, restitution)
    runs = [filmed_replay(posed, *one, known, solver, **options) for one in tests]
    again = replace(posed, tests=runs)
    words = f"restitution {restitution:g}, {len(runs)} tests"
    away = [_errors(*one, run) for one, run in zip(tests, runs, strict=True)]
    return _row_of(model, words, find_impacts(again, find_arcs(again)[0])), 1e3 * np.mean(away, axis=0)


def _errors(test, arc, run):
    """Mean distance of a replay from its film, over all and until 0.1 s after the first flight [m]."""
    away = np.linalg.norm((test.position[arc.first :] - run.position)[:, test.axes], axis=1)
    early = np.searchsorted(test.time[arc.first :], test.time[arc.last] + 0.1)
    return np.nanmean(away), np.nanmean(away[:early])


if __name__ == "__main__":
    for header, found in ((HEADER, face_impacts()), (REPLAY_HEADER, replayed())):
        for cells in [header, *(found[0] if found else ())]:
            sys.stdout.write(f"{' | '.join(map(str, cells))}\n")
