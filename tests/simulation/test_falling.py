"""States at the end of a run that fall and that do not, made by hand, against statics and the energy of one block."""

import numpy as np
import pytest
from scipy.spatial.transform import Rotation

from blockshake.dynamics.motion import ground_motion
from blockshake.simulation.falling import still_falling
from blockshake.simulation.simulate import simulate

B, H = 0.4, 0.8  # m, half width and half height of the block
SLENDER = np.arctan(B / H)
TIME = np.linspace(0.0, 1.0, 201)
AHEAD = 0.46  # s, from the end of the window to the ground


class Ending:
    """Poses and rates of a structure's bodies, which groups of them can be turned in."""

    def __init__(self, structure):
        self.structure = structure
        self.position, self.orientation = structure.position.copy(), structure.orientation.copy()
        self.rate = np.zeros_like(self.position)

    def turn(self, bodies, angle, about, rate=0.0):
        """Turn bodies together about a line along y, positive leaning the top to +x [rad, rad/s]."""
        turn = Rotation.from_rotvec([0.0, angle, 0.0])
        for body in bodies:
            self.position[body] = about + turn.apply(self.position[body] - about)
            now = Rotation.from_quat(self.orientation[body], scalar_first=True)
            self.orientation[body] = (turn * now).as_quat(scalar_first=True)
            self.rate[body, 1] += rate
        return self

    def falls(self):
        return still_falling(self.structure, self.position, self.orientation, self.rate)


def stack(make_structure, count, **keys):
    blocks = [
        {"name": f"block-{n}", "shape": "sharp", "position": [0.0, 0.0, H + 2 * H * (n - 1)]}
        for n in range(1, count + 1)
    ]
    return Ending(make_structure(blocks, friction=0.75, **keys))


def slenderness(count):
    return np.arctan(B / (count * H))


def edge(level, side=1.0):
    """Edge of the joint under the block of a level, from 1, in an upright stack."""
    return np.array([side * B, 0.0, 2 * H * (level - 1)])


@pytest.mark.parametrize("count", [1, 2, 4, 10])
def test_blocks_as_they_were_placed_do_not_fall(make_structure, count):
    assert stack(make_structure, count).falls() is None


@pytest.mark.parametrize("side", [1.0, -1.0])
@pytest.mark.parametrize("count", [1, 2, 4, 10])
def test_blocks_that_turn_as_one_fall_from_their_balance_on(make_structure, count, side):
    """Statics: the common mass centre passes the edge at the slenderness of the whole."""
    for share, falls in ((0.98, False), (1.02, True)):
        angle = side * share * slenderness(count)
        ending = stack(make_structure, count).turn(range(1, count + 1), angle, edge(1, side))
        assert bool(ending.falls()) == falls


def test_the_block_that_falls_is_named(make_structure):
    ending = stack(make_structure, 1).turn([1], 1.1 * SLENDER, edge(1))
    assert ending.falls() == "block-1"


@pytest.mark.parametrize("level", [2, 3])
def test_the_upper_part_of_a_stack_falls_by_itself(make_structure, level):
    upper = range(level, 5)
    for share, falls in ((0.98, False), (1.02, True)):
        ending = stack(make_structure, 4).turn(upper, share * slenderness(len(upper)), edge(level))
        assert bool(ending.falls()) == falls


def test_an_upper_block_that_leans_back_holds_the_whole(make_structure):
    """The lower block is past the balance of two, the upper one rocks back and brings the mass centre inside."""
    lean, back = 1.1 * slenderness(2), -1.2 * slenderness(2)
    ending = stack(make_structure, 2).turn([1, 2], lean, edge(1))
    assert ending.falls()
    hinge = edge(1) + Rotation.from_rotvec([0.0, lean, 0.0]).apply(edge(2, -1.0) - edge(1))
    ending.turn([2], back, hinge)
    centre = ending.position[1:, 0].mean()
    assert centre < B
    assert ending.falls() is None


def rate_over_balance(angle, slender):
    """Rate at which a block on its edge just comes to its balance, by energy; p2 = 3 g / (4 R) (Housner 1963)."""
    radius = np.hypot(B, B / np.tan(slender))
    return np.sqrt(2.0 * 0.75 * 9.81 / radius * (1.0 - np.cos(slender - angle)))


@pytest.mark.parametrize("count", [1, 4])
@pytest.mark.parametrize("share", [0.3, 0.8])
def test_below_its_balance_a_block_falls_with_the_energy_to_pass_it(make_structure, count, share):
    slender = slenderness(count)
    angle = share * slender
    for excess, falls in ((0.95, False), (1.05, True)):
        rate = excess * rate_over_balance(angle, slender)
        ending = stack(make_structure, count).turn(range(1, count + 1), angle, edge(1), rate)
        assert bool(ending.falls()) == falls
        # turning back it does not fall, whatever its energy
        back = stack(make_structure, count).turn(range(1, count + 1), angle, edge(1), -0.9 * rate)
        assert back.falls() is None


@pytest.mark.parametrize("count", [1, 4])
def test_past_its_balance_only_a_block_with_the_energy_comes_back(make_structure, count):
    slender = slenderness(count)
    angle = 1.3 * slender
    for excess, falls in ((-0.95, True), (-1.05, False), (0.1, True)):
        rate = excess * rate_over_balance(angle, slender)
        ending = stack(make_structure, count).turn(range(1, count + 1), angle, edge(1), rate)
        assert bool(ending.falls()) == falls


@pytest.mark.parametrize(("overhang", "falls"), [(0.39, False), (0.41, True)])
def test_a_block_that_slides_over_an_edge_falls_with_its_mass_centre(make_structure, overhang, falls):
    ending = stack(make_structure, 2)
    ending.position[2, 0] += overhang
    assert bool(ending.falls()) == falls


def test_a_block_off_its_edge_falls(make_structure):
    ending = stack(make_structure, 2)
    ending.position[2] += [0.85, 0.0, -0.1]
    assert ending.falls() == "block-2"


@pytest.mark.parametrize("hop", [1e-4, 0.02, 0.5])
def test_a_block_in_flight_over_its_place_comes_back(make_structure, hop):
    ending = stack(make_structure, 2)
    ending.position[2, 2] += hop
    assert ending.falls() is None
    ending.position[2, 0] += 0.9
    assert ending.falls() == "block-2"


def test_a_block_in_flight_past_its_place_lands_lower_than_a_collapse_allows(make_structure):
    ending = stack(make_structure, 2)
    ending.position[2] += [1.0, 0.0, 0.3]
    assert ending.falls()


def test_what_shakes_and_slides_does_not_fall(make_structure):
    """Rates of rattling blocks, and the slab's own turning."""
    ending = stack(make_structure, 4)
    ending.rate[1:, 1] = [0.05, -0.08, 0.1, -0.1]
    assert ending.falls() is None
    ending.rate[:] = [0.0, 5.0, 0.0]
    assert ending.falls() is None


def bridged(make_structure, **keys):
    """Two walls of two blocks, 0.8 m apart, under a beam."""
    blocks = [
        {"name": f"{side}-{n}", "shape": "sharp", "position": [x, 0.0, H + 2 * H * (n - 1)]}
        for side, x in (("left", -0.8), ("right", 0.8))
        for n in (1, 2)
    ]
    beam = {"name": "beam", "shape": "beam", "position": [0.0, 0.0, 4 * H + 0.4]}
    return Ending(
        make_structure([*blocks, beam], friction=0.75, shapes={"beam": {"box": [2.4, 2.4, 0.8]}}, **keys)
    )


def lean_both(ending, angle):
    """Both walls about their right edges, the beam carried along without turning."""
    left, right = (np.array([x + B, 0.0, 0.0]) for x in (-0.8, 0.8))
    before = ending.position.copy()
    ending.turn([1, 2], angle, left).turn([3, 4], angle, right)
    top = Rotation.from_rotvec([0.0, angle, 0.0]).apply(
        [-2 * B, 0.0, 4 * H]
    )  # the upper left corner of a wall
    ending.position[5] = before[5] + top - [-2 * B, 0.0, 4 * H]
    return ending


def test_bridged_walls_fall_together_where_the_weight_of_all_passes_its_crest(make_structure):
    """Potential energy of two walls that turn under a beam on their upper left edges.

    Each wall weighs 2 w and the beam 1.5 w by volume, half of it on each edge: the energy is
    2 R cos(a - t) + 0.75 D cos(c + t) from the pivot, whose crest is the balance.
    """
    structure = bridged(make_structure)
    wall, beam = 2.0 * structure.structure.mass[1], structure.structure.mass[5]
    angles = np.linspace(0.0, 0.4, 4001)
    energy = wall * (2 * H * np.cos(angles) + B * np.sin(angles)) + 0.5 * beam * (
        4 * H * np.cos(angles) + 2 * B * np.sin(angles)
    )
    crest = angles[energy.argmax()]
    assert 0.2 < crest < 0.3
    assert lean_both(structure, 0.97 * crest).falls() is None
    assert lean_both(bridged(make_structure), 1.03 * crest).falls()


def test_a_block_that_leans_on_a_stopper_does_not_fall(make_structure):
    stopper = {"body": "block-1", "position": [B, 0.0, H], "axis": "+x", "gap": 0.3, "stiffness": 1e7}
    angle = 1.05 * SLENDER
    assert stack(make_structure, 1).turn([1], angle, edge(1)).falls()
    held = stack(make_structure, 1, stoppers=[stopper]).turn([1], angle, edge(1))
    assert held.falls() is None
    held.rate[1, 1] = 0.2
    assert held.falls() is None


def test_a_chamfered_block_rocks_on_its_flat(make_structure):
    """The flat ends 20 mm inside: so does the balance; the chamfer carries nothing below 45 degrees."""
    flat = B - 0.02
    slender = np.arctan(flat / H)
    for share, falls in ((0.97, False), (1.03, True)):
        structure = make_structure([{"name": "one", "shape": "block", "position": [0.0, 0.0, H]}])
        ending = Ending(structure).turn([1], share * slender, np.array([flat, 0.0, 0.0]))
        assert bool(ending.falls()) == falls


def test_without_a_driven_body_or_gravity_nothing_falls(make_structure):
    blocks = [{"name": "one", "shape": "sharp", "position": [0.0, 0.0, H]}]
    weightless = Ending(make_structure(blocks, gravity=[0.0, 0.0, 0.0]))
    assert weightless.turn([1], 1.2 * SLENDER, edge(1)).falls() is None
    alone = Ending(make_structure(blocks, slab=False))
    assert alone.falls() is None


def test_a_beam_is_not_carried_by_a_slab_that_it_never_touched(make_structure):
    """Foot and beam turn as one about the foot's edge; the beam's corner comes near the slab before it is down."""
    shapes = {"foot": {"box": [0.8, 0.8, 0.9]}, "beam": {"box": [2.4, 2.4, 0.8]}}
    bodies = [
        {"name": "foot", "shape": "foot", "position": [0.0, 0.0, 0.45]},
        {"name": "beam", "shape": "beam", "position": [0.0, 0.0, 1.3]},
    ]
    structure = make_structure(bodies, shapes=shapes, friction=0.75)
    balance = np.arctan(B / (structure.mass[1:] @ [0.45, 1.3] / structure.mass[1:].sum()))
    for angle, falls in ((0.98 * balance, False), (1.02 * balance, True), (np.radians(33.0), True)):
        ending = Ending(structure).turn([1, 2], angle, np.array([B, 0.0, 0.0]))
        assert bool(ending.falls()) == falls


def push(strength):
    return ground_motion("push", TIME, {"x": strength * (TIME < 0.6)}, "acceleration")


def run_until(duration, strength):
    return simulate("configuration-2", push(strength), "nscd-rigid", duration=duration, accelerometers=False)


def test_a_wall_that_leans_as_the_window_ends_is_falling():
    whole = run_until(4.0, 1.3)
    assert whole.attrs["status"] == "collapsed"
    end = round(whole.attrs["end_time"] - AHEAD, 2)
    cut = run_until(end, 1.3)
    lean = np.degrees(2.0 * np.arcsin(abs(float(cut["orientation"].isel(time=-1, body=-1, quaternion=2)))))
    assert 12.0 < lean < 25.0
    assert cut.attrs["status"] == "falling"
    assert cut.attrs["reason"] == f"block-4 still falls at {end:.3f} s, when the window ends"
    assert cut.attrs["end_time"] == pytest.approx(end)
    # the same run so far
    np.testing.assert_array_equal(cut["position"], whole["position"].isel(time=slice(cut.sizes["time"])))


def test_a_wall_that_rocks_as_the_window_ends_has_completed():
    rocking = run_until(0.9, 1.2)
    assert np.abs(rocking["angular_velocity"].isel(time=-1)).max() > 0.01
    assert (rocking.attrs["status"], rocking.attrs["reason"]) == ("completed", "")
