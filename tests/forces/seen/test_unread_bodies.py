"""Tests whose sensors show less: a body that is not read, no quiet start; nothing is guessed and nothing breaks."""

import numpy as np
import pytest
from known_blocks import GRAVITY, kicked, readings, rocking, stack

from blockshake.diagnosis.answer.explain import gather_evidence
from blockshake.diagnosis.answer.limits import cannot_see
from blockshake.diagnosis.evidence.angular_momentum_ratio import restitution_gain
from blockshake.diagnosis.evidence.slab_motion import explain_slab, slab_motion
from blockshake.forces.seen.reconstructed_test import reconstruct_test


@pytest.fixture(scope="module")
def structure():
    return stack(2)


@pytest.fixture(scope="module")
def read(structure):
    """Two blocks; the upper one rocks alone on the lower one, which rests."""
    turn = kicked([0.8], kick=1.0)

    def poses(t):
        return np.array([[0.0, 0.0, 0.0], [0.0, 0.0, 0.0], rocking(lambda t: 0.0, turn)(t)[1]])

    return readings(structure, poses, 1e-4, 0.02)


def without(read, body):
    """Readings without the sensors of a body."""
    markers = [name for name in read["marker"].values if not str(name).startswith(body)]
    channels = [name for name in read["channel"].values if not str(name).startswith(body)]
    return read.sel(marker=markers, channel=channels)


def of_upper(seen):
    """Rows of the upper block alone, by instant."""
    own = np.abs(seen.rows.direction[:, 2]).max(axis=1) > 0.0
    return dict(zip(seen.rows.instant[own], np.abs(seen.rows.value[own]), strict=True))


def test_a_body_that_is_not_read_leaves_the_forces_above_it_and_no_row_that_needs_it(
    structure, read, sensors
):
    """The motion of the lower block decides the edge on which the upper one bears: without it no row is left."""
    whole, less = (
        reconstruct_test(name, one, structure, sensors)
        for name, one in (("whole", read), ("less", without(read, "block-1")))
    )
    weight = GRAVITY * structure.mass[2]
    assert len(of_upper(whole)) > 20
    assert not len(less.rows.value)
    assert np.isfinite(less.forces.force[:, 1]).all()
    assert np.isnan(less.forces.force[:, 0]).all()
    np.testing.assert_allclose(less.forces.force[:, 1], whole.forces.force[:, 1], atol=1e-5 * weight)


def test_a_gap_of_a_body_below_leaves_the_forces_above(structure, read, sensors):
    gapped = read.copy(deep=True)
    own = [str(name).startswith("block-1") for name in read["marker"].values]
    gapped["marker_displacement"][dict(time=slice(300, 500), marker=own)] = np.nan
    seen = reconstruct_test("gapped", gapped, structure, sensors)
    inside = (seen.motion.time > 1.6) & (seen.motion.time < 2.4)
    assert np.isfinite(seen.forces.force[inside, 1]).all()
    assert np.isnan(seen.forces.force[inside, 0]).all()
    assert "block-1: its motion is unknown for" in " ".join(cannot_see([seen]))


@pytest.mark.filterwarnings("error::RuntimeWarning")
@pytest.mark.parametrize("body", ["block-1", "block-2"])
def test_nothing_is_said_of_what_is_not_read(structure, read, sensors, body):
    seen = [reconstruct_test("less", without(read, body), structure, sensors)]
    gathered = gather_evidence(seen)
    assert gathered is None or all(gathered.gain(key) < 8.0 for key in gathered.keys)
    assert all(one.gain <= 0.0 for one in explain_slab([slab_motion(one) for one in seen]).values())
    assert restitution_gain(seen).gain <= 0.0
    assert f"{body}: its rotation is not read; forces of the joints at it are not judged" in cannot_see(seen)


def test_a_test_without_a_quiet_start_is_not_judged(structure, read, sensors):
    late = read.sel(time=slice(1.0, None), time_acc=slice(1.0, None))
    late = late.assign(marker_displacement=late["marker_displacement"] - late["marker_displacement"][0])
    seen = reconstruct_test("late", late, structure, sensors)
    assert not seen.still.any()
    assert not len(seen.rows.value)
    assert not seen.states.closed.any()
    assert cannot_see([seen]) == [
        "late: no quiet start, from which its readings would count; nothing of it is judged"
    ]


def test_of_joints_that_are_read_the_one_that_rests_alone_is_said(structure, read, sensors):
    (line,) = cannot_see([reconstruct_test(name, read, structure, sensors) for name in ("t1", "t2")])
    assert line.startswith("slab-block-1: turned, slipped and lifted in no test")


def test_joints_that_never_move_are_said(structure, sensors):
    at_rest = readings(structure, lambda t: np.zeros((3, 3)), 1e-4, 0.02)
    lines = cannot_see([reconstruct_test("t1", at_rest, structure, sensors)])
    assert lines[0] == "t1 alone: a cause that acts once is not distinguished from one that lasts"
    assert [line.split(":")[0] for line in lines[1:]] == ["slab-block-1", "block-1-block-2"]
