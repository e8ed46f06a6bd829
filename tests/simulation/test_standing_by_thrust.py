"""Arches, leaning stones and keystones, which stand by thrust and friction on steep joints, against limit analysis."""

import itertools
import os
from pathlib import Path

import numpy as np
import pytest
import scipy
import trimesh

from blockshake.cli import main
from blockshake.simulation.falling import still_falling

CASES = Path(os.environ.get("BLOCKSHAKE_SHARED", Path(__file__).parents[3] / "shared")) / "cases"
FRICTION, DEPTH = 0.75, 0.4  # 1, m
RADIUS = 1.0  # m, mean radius of the arches


def centroid(corners):
    """Centroid and area of a convex polygon, (n, 2) and m2."""
    after = np.roll(corners, -1, axis=0)
    cross = corners[:, 0] * after[:, 1] - after[:, 0] * corners[:, 1]
    area = 0.5 * cross.sum()
    return ((corners + after) * cross[:, None]).sum(axis=0) / (6.0 * area), abs(area)


@pytest.fixture
def falls(make_structure, tmp_path):
    """Whether stones fall that are left alone: polygons in x and z, extruded along y, turned by a heading [rad]."""

    def judge(stones, friction=FRICTION, heading=0.0):
        bodies, shapes, cos, sin = [], {}, np.cos(heading), np.sin(heading)
        for number, corners in enumerate(np.asarray(stone, dtype=float) for stone in stones):
            middle, _ = centroid(corners)
            solid = [(x, y, z) for (x, z), y in itertools.product(corners - middle, (-DEPTH / 2, DEPTH / 2))]
            trimesh.convex.convex_hull(solid).export(tmp_path / f"{number}.obj")
            shapes[f"stone-{number}"] = {"mesh": f"{number}.obj"}
            place = [float(value) for value in (middle[0] * cos, middle[0] * sin, middle[1])]
            turn = [float(np.cos(heading / 2.0)), 0.0, 0.0, float(np.sin(heading / 2.0))]
            name = f"stone-{number}"
            bodies.append({"name": name, "shape": name, "position": place, "orientation": turn})
        one = make_structure(bodies, folder=tmp_path, shapes=shapes, friction=friction)
        return still_falling(one, one.position, one.orientation, np.zeros_like(one.position)) is not None

    return judge


def arch(count, thickness):
    """Wedges of a semicircular arch of radius `RADIUS`, from right to left."""
    angles = np.linspace(0.0, np.pi, count + 1)
    inner, outer = (
        np.column_stack([radius * np.cos(angles), radius * np.sin(angles)])
        for radius in (RADIUS - thickness / 2, RADIUS + thickness / 2)
    )
    return [np.array([inner[n], outer[n], outer[n + 1], inner[n + 1]]) for n in range(count)]


def stands_by_limit_analysis(stones):
    """Whether planar wedges in a row carry their weights by compression within friction: a linear program.

    A joint has two normal forces at its ends and a shear force; the first and the last joint are fixed.
    """
    count = len(stones)
    matrix, weights = np.zeros((3 * count, 3 * (count + 1))), np.zeros(3 * count)
    for joint in range(count + 1):
        ends = stones[joint][:2] if joint < count else stones[-1][[3, 2]]
        along = (ends[1] - ends[0]) / np.linalg.norm(ends[1] - ends[0])
        normal = np.array([-along[1], along[0]])  # towards the next stone
        for column, (point, force) in enumerate(((ends[0], normal), (ends[1], normal), (ends[0], along))):
            for stone, sign in ((joint, 1.0), (joint - 1, -1.0)):
                if 0 <= stone < count:
                    arm = point - centroid(stones[stone])[0]
                    moment = arm[0] * force[1] - arm[1] * force[0]
                    matrix[3 * stone : 3 * stone + 3, 3 * joint + column] = sign * np.array([*force, moment])
    weights[1::3] = [centroid(stone)[1] for stone in stones]
    limits = np.zeros((2 * (count + 1), matrix.shape[1]))
    for joint, sign in itertools.product(range(count + 1), (0, 1)):
        limits[2 * joint + sign, 3 * joint : 3 * joint + 3] = -FRICTION, -FRICTION, (1.0, -1.0)[sign]
    bounds = [(0.0, None), (0.0, None), (None, None)] * (count + 1)
    found = scipy.optimize.linprog(
        np.zeros(matrix.shape[1]),
        A_ub=limits,
        b_ub=np.zeros(len(limits)),
        A_eq=matrix,
        b_eq=weights,
        bounds=bounds,
    )
    return found.status == 0


def least_thickness(count):
    low, high = 0.01, 0.9
    while high - low > 1e-4:
        middle = 0.5 * (low + high)
        low, high = (low, middle) if stands_by_limit_analysis(arch(count, middle)) else (middle, high)
    return high


def test_the_limit_analysis_of_the_tests_has_known_thicknesses():
    """A continuous arch 0.1075 of the radius (Milankovitch 1907), of fifteen wedges 0.1061."""
    assert least_thickness(15) == pytest.approx(0.1061, abs=2e-4)
    assert least_thickness(61) == pytest.approx(0.1075, abs=5e-4)


@pytest.mark.parametrize("count", [5, 9, 15, 31])
def test_an_arch_stands_from_its_least_thickness_on(falls, count):
    least = least_thickness(count)
    assert falls(arch(count, 0.97 * least))
    assert not falls(arch(count, 1.03 * least))


def test_an_arch_of_three_stones_stands(falls):
    assert not falls(arch(3, 0.2))


@pytest.mark.parametrize("degrees", [20, 45, 90])
def test_an_arch_stands_whichever_way_it_spans(falls, degrees):
    heading = np.radians(degrees)
    assert not falls(arch(15, 0.13), friction=0.4, heading=heading)
    assert falls(arch(15, 0.13), friction=0.35, heading=heading)


@pytest.mark.parametrize("ratio", [0.95, 1.05])
def test_two_stones_that_lean_on_each_other_stand_by_friction_at_their_feet(falls, ratio):
    """The thrust at the top of their common face is at least the weight times the overhang over its height."""
    right = np.array([[0.6, 0.0], [0.8, 0.0], [0.0, 1.2], [0.0, 1.0]])
    (middle, _), top = centroid(right), 1.2
    limit = (0.6 - middle[0]) / top
    assert falls([right, right * [-1.0, 1.0]], friction=ratio * limit) == (ratio < 1.0)


@pytest.mark.parametrize("splay", [0.0, 0.1, 0.2])
@pytest.mark.parametrize("ratio", [0.95, 1.05])
def test_a_keystone_between_two_jambs_stands_where_their_weight_holds_its_thrust(falls, splay, ratio):
    """Its least thrust is W / (2 tan(splay + phi)), and the jambs slide by mu times what they carry."""
    height, half, lift, friction = 0.5, 0.2, 0.1, 0.5
    top = half + height * np.tan(splay)
    key = np.array([[-half, lift], [half, lift], [top, lift + height], [-top, lift + height]])
    weight = centroid(key)[1]
    thrust = 0.5 * weight / np.tan(splay + np.arctan(friction))
    needed = ratio * (thrust / friction - 0.5 * weight)
    slope = np.tan(splay)
    inner = np.array([[half - lift * slope, 0.0], [top, lift + height]])
    width = needed / (lift + height) + 0.5 * (inner[1, 0] - inner[0, 0])
    jamb = np.array([inner[0], [inner[0, 0] + width, 0.0], [inner[0, 0] + width, lift + height], inner[1]])
    assert centroid(jamb)[1] == pytest.approx(needed)
    assert falls([key, jamb, jamb * [-1.0, 1.0]], friction) == (ratio < 1.0)


@pytest.mark.parametrize("name", ["arch-3", "arch-15"])
@pytest.mark.skipif(not CASES.is_dir(), reason=f"no {CASES} (set BLOCKSHAKE_SHARED)")
def test_an_arch_that_rests_has_completed(name, tmp_path, capsys):
    folder = CASES / "arch-called-falling"
    command = ["simulate", "--structure", str(folder / f"{name}.yaml"), "--motion", str(folder / "rest.csv")]
    assert main([*command, "--model", "nscd-rigid", "--output", str(tmp_path / "run.nc")]) == 0
    assert "no block fell in 2 s" in capsys.readouterr().out
