"""Readings of displacement transducers against geometry done by hand: one block on a slab, moved as prescribed."""

import re

import numpy as np
import pytest
from scipy.spatial.transform import Rotation

from blockshake.errors import InputError
from blockshake.measurement.sensors.instruments import Instruments, observe
from blockshake.measurement.sensors.transducers import transducer_lengths
from blockshake.simulation.simulate import simulate

LENGTH = 1.0  # m, of the wire
WIRE = {
    "name": "wire", "body": "block", "position": [-0.4, 0.0, 0.7],
    "reference": "slab", "reference_position": [-1.4, 0.0, 1.6],
}  # fmt: skip
ROD = {
    "name": "rod", "body": "block", "position": [0.4, 0.0, 0.7], "reference": "slab",
    "reference_position": [1.0, 0.0, 1.6], "axis": "-x",
}  # fmt: skip
BLOCK = {"name": "block", "shape": "sharp", "position": [0.0, 0.0, 0.8]}


@pytest.fixture
def structure(make_structure):
    return make_structure([BLOCK], displacement_transducers=[WIRE, ROD])


def _read(structure, moves, turns):
    """Second reading, of a slab and a block that have moved and turned: wire, rod [m]."""
    position = np.stack([structure.position, structure.position + moves])
    quaternions = Rotation.from_rotvec(turns).as_quat(scalar_first=True)
    return np.diff(
        transducer_lengths(structure, position, np.stack([structure.orientation, quaternions])), axis=0
    )[0]


@pytest.mark.parametrize("shift", [0.02, -0.05])
def test_a_translation_along_the_axis_is_read_with_its_sign(structure, shift):
    moved = _read(structure, [[0.0, 0.0, 0.0], [shift, 0.0, 0.0]], np.zeros((2, 3)))
    # away from the wire's anchor at -x, towards the rod's at +x: longer is positive
    np.testing.assert_allclose(moved, [shift, -shift], atol=1e-15)


def test_sideways_motion_lengthens_a_wire_in_second_order_and_slides_under_a_rod(structure):
    aside = 0.03
    moved = _read(structure, [[0.0, 0.0, 0.0], [0.0, aside, 0.0]], np.zeros((2, 3)))
    assert moved[0] == pytest.approx(np.hypot(LENGTH, aside) - LENGTH, abs=1e-15)
    # the next term of the series is s^4 / 8
    assert moved[0] == pytest.approx(aside**2 / (2.0 * LENGTH), abs=aside**4 / 8.0)
    assert moved[1] == pytest.approx(0.0, abs=1e-15)


def test_what_both_bodies_do_together_is_not_read(structure):
    """Any motion of slab and block as one rigid body, by Euler's theorem a turn about the slab and a shift."""
    turn, shift = Rotation.from_rotvec([0.1, -0.3, 0.7]), [0.2, -0.1, 0.05]
    place = turn.apply(structure.position - structure.position[0]) + structure.position[0] + shift
    moved = _read(structure, place - structure.position, np.tile(turn.as_rotvec(), (2, 1)))
    np.testing.assert_allclose(moved, 0.0, atol=1e-15)


@pytest.mark.parametrize("angle", [0.05, -0.05])
def test_a_block_that_rocks_about_its_edge(structure, angle):
    edge = np.array([np.copysign(0.4, angle), 0.0, 0.0])
    turn = Rotation.from_rotvec([0.0, angle, 0.0])
    place = edge + turn.apply(structure.position[1] - edge)
    moved = _read(
        structure, [[0.0, 0.0, 0.0], place - structure.position[1]], [[0.0, 0.0, 0.0], [0.0, angle, 0.0]]
    )
    hook = edge + turn.apply([-0.4, 0.0, 1.5] - edge)
    assert moved[0] == pytest.approx(np.linalg.norm(hook - [-1.4, 0.0, 1.5]) - LENGTH, abs=1e-15)
    # the face's line in the plane of the motion, by hand: where it crosses the height of the rod, 1.5 m
    foot, top = edge + turn.apply([0.4, 0.0, 0.0] - edge), edge + turn.apply([0.4, 0.0, 1.6] - edge)
    share = (1.5 - foot[2]) / (top[2] - foot[2])
    assert moved[1] == pytest.approx(-(foot[0] + share * (top[0] - foot[0]) - 0.4), abs=1e-15)
    # to first order both read the angle times the height
    np.testing.assert_allclose(moved, [1.5 * angle, -1.5 * angle], atol=1.5 * angle**2)


def test_a_rod_that_has_lost_its_face_reads_nothing(structure):
    moved = _read(structure, np.zeros((2, 3)), [[0.0, 0.0, 0.0], [0.0, np.deg2rad(61.0), 0.0]])
    assert np.isfinite(moved[0])
    assert np.isnan(moved[1])


def test_a_mass_out_of_the_middle_moves_no_end(make_structure):
    """A turn about the centroid, whose mass centre lies 0.1 m above, gives what it gives a block without."""
    angle = 0.03
    plain, heavy = (
        make_structure([{**BLOCK, "mass_offset": [0.0, 0.0, offset]}], displacement_transducers=[WIRE, ROD])
        for offset in (0.0, 0.1)
    )
    turn = Rotation.from_rotvec([0.0, angle, 0.0])
    lever = np.array([[0.0, 0.0, 0.0], turn.apply([0.0, 0.0, 0.1]) - [0.0, 0.0, 0.1]])
    turns = [[0.0, 0.0, 0.0], [0.0, angle, 0.0]]
    np.testing.assert_allclose(_read(heavy, lever, turns), _read(plain, np.zeros((2, 3)), turns), atol=1e-15)


def test_a_run_has_the_readings_at_512_hz_and_none_where_there_is_no_transducer(make_structure):
    structure = make_structure([BLOCK], displacement_transducers=[WIRE, ROD])
    run = simulate(structure, "alkion", "nscd-rigid", duration=1.0)
    read = run["transducer_displacement"]
    assert read.dims == ("time_acc", "transducer")
    assert read["transducer"].values.tolist() == ["wire", "rod"]
    assert (read.attrs["units"], "accelerometer" in run) == ("m", False)
    np.testing.assert_array_equal(run["time_acc"], np.arange(513) / 512.0)
    # both records hold the poses at every eighth of a second
    poses = run.isel(time=slice(None, None, 25))
    lengths = transducer_lengths(structure, poses["position"].to_numpy(), poses["orientation"].to_numpy())
    np.testing.assert_allclose(read[::64], lengths - lengths[0], atol=1e-12)
    silent = simulate(make_structure([BLOCK]), "alkion", "nscd-rigid", duration=0.1)
    assert "time_acc" not in silent.coords
    assert "transducer" not in silent.attrs["structure_file"]


def test_noise_has_its_size_and_leaves_the_other_sensors_as_they_are(make_structure):
    markers = [{"name": "m", "body": "block", "position": [0.0, 0.0, 0.0]}]
    structure = make_structure([BLOCK], markers=markers, displacement_transducers=[WIRE, ROD])
    run = simulate(structure, "alkion", "nscd-rigid", duration=4.0)
    quiet, noisy = (observe(run, structure, Instruments(transducer_noise=noise), 3) for noise in (0.0, 2e-4))
    np.testing.assert_array_equal(quiet["transducer_displacement"], run["transducer_displacement"])
    np.testing.assert_array_equal(noisy["marker_displacement"], quiet["marker_displacement"])
    error = (noisy["transducer_displacement"] - run["transducer_displacement"]).to_numpy()
    assert (error[0] == 0.0).all()
    # 4,000 readings: a standard error of 1.1 %; the first reading's own error is in all others
    assert (error[1:] - error[1:].mean(axis=0)).std() == pytest.approx(2e-4, rel=0.05)


REFUSED = {
    "no such reference": ({**WIRE, "reference": "floor"}, "wire.reference: expected another body"),
    "itself": ({**WIRE, "reference": "block"}, "wire.reference: expected another body"),
    "no such body": ({**WIRE, "body": "roof"}, "wire.body: expected a body of this structure, not 'roof'"),
    "no length": ({**WIRE, "reference_position": [-0.4, 0.0, 1.6]}, "wire.reference_position: expected ends"),
    "rod backwards": ({**ROD, "axis": "+x"}, r"rod.axis: expected a rod that points .* against \+x"),
    "a marker's name": ({**WIRE, "name": "m"}, "m: expected a name that no marker"),
    "a channel's name": ({**WIRE, "name": "a-x"}, "a-x: expected a name that no marker"),
}  # fmt: skip


@pytest.mark.parametrize("what", REFUSED)
def test_a_transducer_that_reads_nothing_is_refused_in_one_line(make_structure, what):
    item, message = REFUSED[what]
    others = {
        "markers": [{"name": "m", "body": "block", "position": [0.0, 0.0, 0.0]}],
        "accelerometers": [{"name": "a", "body": "block", "position": [0.0, 0.0, 0.0], "axes": ["x"]}],
    }
    with pytest.raises(InputError, match=rf"test\.yaml: displacement_transducers\.{message}") as error:
        make_structure([BLOCK], displacement_transducers=[item], **others)
    assert not re.search("\n", str(error.value))
