"""A cylinder is a prism of its volume, and lies and rolls as the stated errors say."""

import numpy as np
import pytest

import blockshake
from blockshake.errors import InputError
from blockshake.geometry.cylinder import prism_errors
from blockshake.geometry.polyhedron import convex_polyhedron
from blockshake.own_files.check import check

DIAMETER, HEIGHT = 0.8, 0.5


def drum(make_mapping, sides=24, *, lying=False, **keys):
    half = np.sqrt(0.5)
    turned = {"orientation": [half, half, 0.0, 0.0]} if lying else {}
    shapes = {"drum": {"cylinder": {"diameter": DIAMETER, "height": HEIGHT, "sides": sides}}}
    return make_mapping([{"name": "drum", "shape": "drum", "on": "slab", **turned}], shapes=shapes, **keys)


@pytest.mark.parametrize("sides", [8, 24, 64])
def test_volume_inertia_and_radius_are_those_that_are_stated(make_mapping, sides):
    solid = blockshake.load_structure(drum(make_mapping, sides)).solids["drum"]
    volume = np.pi * DIAMETER**2 / 4.0 * HEIGHT
    assert solid.properties.volume == pytest.approx(volume, rel=1e-12)
    errors = prism_errors(sides)
    about = volume * DIAMETER**2 / 8.0  # of a cylinder about its axis
    assert solid.properties.inertia[2, 2] == pytest.approx(about * (1.0 + errors.inertia), rel=1e-12)
    assert np.abs(solid.vertices[:, 0]).max() == pytest.approx(
        DIAMETER / 2.0 * (1.0 + errors.narrow), rel=1e-12
    )
    far = np.hypot(*solid.vertices[:, :2].T).max()
    assert far == pytest.approx(DIAMETER / 2.0 * (1.0 + errors.wide), rel=1e-12)
    assert len(convex_polyhedron(solid.vertices).faces) == sides + 2
    assert errors.narrow < 0.0 < errors.inertia < errors.wide


def test_errors_fall_with_the_square_of_the_sides():
    coarse, fine = prism_errors(16), prism_errors(32)
    for name in ("narrow", "wide"):
        assert getattr(coarse, name) / getattr(fine, name) == pytest.approx(4.0, rel=0.02)
    assert coarse.slope == 2.0 * fine.slope


@pytest.mark.parametrize("model", ["nscd-rigid", "ls-dem"])
@pytest.mark.parametrize(("share", "rolls"), [(0.8, False), (1.2, True)])
def test_a_lying_drum_rolls_above_the_stated_slope_alone(make_mapping, model, share, rolls):
    slope = share * prism_errors(24).slope
    gravity = [9.81 * np.sin(slope), 0.0, -9.81 * np.cos(slope)]
    mapping = drum(make_mapping, lying=True, gravity=gravity)
    still = {"time_s": [0.0, 1.0], "acceleration_x": [0.0, 0.0]}
    step = {"ls-dem": 5e-5, "nscd-rigid": 1e-3}[model]
    run = blockshake.simulate(mapping, still, model, duration=1.0, time_step=step)
    moved = float(
        run["position"].sel(body="drum", axis="x")[-1] - run["position"].sel(body="drum", axis="x")[0]
    )
    assert (moved > 0.05) == rolls
    if not rolls:
        assert abs(moved) < 1e-3


def test_drums_stack_and_follow_a_drawn_size(make_mapping):
    mapping = drum(make_mapping)
    mapping["bodies"].append({"name": "upper", "shape": "drum", "material": "stone", "on": "drum"})
    structure = blockshake.load_structure(mapping, {"shapes.drum.cylinder.height": 0.7})
    np.testing.assert_allclose(structure.centroid[1:, 2], [0.35, 1.05], atol=1e-12)
    assert structure.touching[1, 2]
    assert "drum is a prism of 24 sides: the cylinder's volume" in check(structure)


@pytest.mark.parametrize(
    ("shape", "line"),
    [
        ({"cylinder": {"diameter": 1.0, "height": 1.0, "sides": 10}}, "multiple of 4, not 10"),
        ({"cylinder": {"diameter": -1.0, "height": 1.0}}, "greater than 0, not -1"),
        ({"cylinder": {"diameter": 1.0}}, "height"),
        ({"cylinder": {"diameter": 1.0, "height": 1.0}, "chamfer": 0.1}, "expected a chamfer on a box only"),
        ({"cylinder": {"diameter": 1.0, "height": 1.0}, "box": [1.0, 1.0, 1.0]}, "expected either box"),
        ({}, "expected either box"),
    ],
)
def test_a_wrong_cylinder_is_refused(make_mapping, shape, line):
    mapping = make_mapping([{"name": "drum", "shape": "drum", "on": "slab"}], shapes={"drum": shape})
    with pytest.raises(InputError, match=line):
        blockshake.load_structure(mapping)
