"""Broken laws and the effects that they isolate, on values with known answers."""

import numpy as np
import pytest
import xarray as xr

from blockshake.diagnosis.laws.findings import OutsideForce
from blockshake.diagnosis.laws.judged_laws import accounts_for, judge_laws, law_that_holds, leans_to
from blockshake.diagnosis.laws.null_laws import null_laws, tamed

TESTS = ("one", "two", "three")
# law: its value in nominal draws, their scatter, its standard error in a test
NOMINAL = {
    "joint1.lever.short": (5e-3, 2e-3, 5e-4),
    "joint1.lever.bias": (0.0, 5e-4, 3e-4),
    "joint1.lever.slope": (0.0, 0.05, 0.1),
    "joint1.lever.stray": (1.1, 0.1, 0.03),
    "joint1.closed.compliance": (0.0, 1e-9, 1e-9),
    "joint1.impact.ringing": (0.12, 0.03, 0.01),
    "table.pitch": (0.0, 5e-6, 5e-6),
    "table.compliance": (0.0, 3e-11, 3e-11),
    "unexplained.largest": (0.017, 4e-3, 1e-4),
    "unexplained.mean": (0.0, 1e-4, 1e-4),
}
NAMES = list(NOMINAL)
SHARES = {"block-1": 0.5, "block-2": 0.5}


def draws(seed, count=20):
    generator = np.random.default_rng(seed)
    centre, scatter, _ = np.array(list(NOMINAL.values())).T
    return centre + scatter * generator.normal(size=(count, len(NAMES)))


def reading(seed, **changed):
    values = dict(zip(NAMES, draws(seed, 1)[0], strict=True)) | changed
    errors = [error for _, _, error in NOMINAL.values()]
    of_joint = [name.startswith("joint1") for name in NAMES]
    return xr.Dataset(
        {"law_value": ("law", [values[name] for name in NAMES]), "law_error": ("law", errors)},
        {
            "law": NAMES,
            "law_joint": ("law", ["slab-block-1" if one else "" for one in of_joint]),
            "law_beneath": ("law", of_joint),
        },
    )


def judged(outside=None, by_test=None, **changed):
    measured = {
        test: reading(100 + place, **(changed if by_test is None else by_test.get(test, {})))
        for place, test in enumerate(TESTS)
    }
    return judge_laws(measured, {test: draws(place) for place, test in enumerate(TESTS)}, outside, SHARES)


def force(law, **parameters):
    tests = {test: {"amplitude": 1.0, **parameters} for test in TESTS}
    return OutsideForce(
        bodies=("block-2",),
        law=law,
        scores={law: 0.0},
        amplitude=1.0,
        lower=0.5,
        upper=1.5,
        unit="N",
        tests=tests,
    )


def test_clean_tests_break_no_law():
    found = judged()
    assert found.broken == ()
    assert found.isolated == ()
    assert found.outside is None
    assert found.p > 0.01


def test_the_energy_that_a_joint_takes_is_shown_and_breaks_nothing():
    taken = np.random.default_rng(0).normal(500.0, 50.0, (20, 1))  # J
    measured = xr.Dataset(
        {"law_value": ("law", [5000.0]), "law_error": ("law", [5.0])},
        {
            "law": ["joint1.work.taken"],
            "law_joint": ("law", ["slab-block-1"]),
            "law_beneath": ("law", [True]),
        },
    )
    found = judge_laws({"one": measured}, {"one": taken}, None, SHARES)
    assert found.laws == found.broken == ()
    assert found.p == 1.0
    (shown,) = found.shown
    assert shown.measured == {"one": 5000.0}
    assert shown.expected["one"] == pytest.approx(500.0, abs=50.0)
    assert shown.spreads["one"] == pytest.approx(50.0, rel=0.5)


def test_a_law_that_holds_excludes_its_effect_at_its_place():
    found = judged()
    assert law_that_holds("table-pitch", {}, found) == "table.pitch"
    assert law_that_holds("reduced-bearing", {}, found) == "joint1.lever.short"
    # the joint beneath carries every block
    assert law_that_holds("eccentricity", {"body": "block-2"}, found) == "joint1.lever.bias"
    assert law_that_holds("eccentricity", {"body": "block-2"}, judged(**{"joint1.lever.bias": 0.03})) == ""


def test_a_law_of_one_joint_excludes_nothing_at_another():
    known = (
        judged()
        .laws[0]
        .model_copy(
            update={
                "name": "joint1.friction.loss",
                "joint": "slab-block-1",
                "departures": {"one": 0.5},
                "together": 0.5,
                "errors": {"one": 0.01},
                "expected": {"one": 0.0},
                "spreads": {"one": 0.05},
            }
        )
    )
    found = judged().model_copy(update={"laws": (known,)})
    assert law_that_holds("weak-joint", {"joint": ["slab", "block-1"]}, found) == "joint1.friction.loss"
    assert law_that_holds("weak-joint", {"joint": ["block-1", "block-2"]}, found) == ""


def test_clean_campaigns_seldom_break_a_law():
    """Two hundred campaigns by the null distribution itself: the thresholds lie far in the tail."""
    broken = 0
    for seed in range(200):
        measured = {test: reading(1000 + 10 * seed + place) for place, test in enumerate(TESTS)}
        null = {test: draws(5000 + 10 * seed + place) for place, test in enumerate(TESTS)}
        broken += bool(judge_laws(measured, null, None, SHARES).broken)
    assert broken <= 4


def test_laws_that_all_tests_of_a_structure_share_seldom_break():
    """Friction is one number in twelve tests: its departures do not add up like independent ones."""
    tests = [f"test-{number}" for number in range(12)]
    centre, scatter, _ = np.array(list(NOMINAL.values())).T
    broken = 0
    for seed in range(200):
        generator = np.random.default_rng(seed)
        shared = scatter * generator.normal(size=(24, len(NAMES)))
        null = {test: centre + shared + 0.2 * scatter * generator.normal(size=shared.shape) for test in tests}
        own = scatter * generator.normal(size=len(NAMES))
        measured = {}
        for number, test in enumerate(tests):
            values = centre + own + 0.2 * scatter * generator.normal(size=len(NAMES))
            measured[test] = reading(number, **dict(zip(NAMES, values, strict=True)))
        broken += bool(judge_laws(measured, null, None, SHARES).broken)
    assert broken <= 4


@pytest.mark.parametrize(
    ("effect", "changed"),
    [
        (
            "reduced-bearing",
            {"joint1.lever.short": 0.06, "joint1.lever.stray": 2.5, "joint1.lever.slope": 5.0},
        ),
        ("table-pitch", {"table.pitch": 4e-4}),
        ("table-pitch", {"table.pitch": -4e-4}),
        ("base-compliance", {"table.compliance": 2e-9}),
        ("eccentricity", {"joint1.lever.bias": 0.03, "unexplained.mean": -0.006}),
    ],
)
def test_an_effect_is_isolated_by_its_own_law(effect, changed):
    assert judged(**changed).isolated == (effect,)


def test_a_bearing_that_is_wider_is_no_reduced_one():
    found = judged(**{"joint1.lever.short": -0.06})
    assert found.broken
    assert found.isolated == ()


def test_a_law_beside_the_effects_own_isolates_nothing():
    found = judged(**{"table.pitch": 4e-4, "joint1.lever.stray": 9.0})
    assert found.isolated == ()


def test_a_table_that_pitches_may_push_the_levers_to_one_side():
    found = judged(
        force("steady"), **{"table.pitch": 4e-4, "joint1.lever.bias": 0.03, "unexplained.mean": -0.006}
    )
    assert found.isolated == ("table-pitch",)
    assert found.outside is None


def test_an_effect_has_one_size_in_all_tests():
    by_test = {"one": {"joint1.lever.bias": 0.05}}
    assert judged(by_test=by_test).isolated == ()


def test_a_force_from_an_instant_on_is_no_eccentric_mass():
    changed = {"joint1.lever.bias": 0.03, "unexplained.mean": -0.006}
    found = judged(force("constant", start=3.0), **changed)
    assert found.isolated == ()
    assert found.outside.law == "constant"
    assert judged(force("steady"), **changed).isolated == ("eccentricity",)


def test_a_spring_beyond_a_gap_is_a_stop():
    changed = {"joint1.lever.stray": 9.0, "unexplained.largest": 0.4}
    found = judged(force("spring", gap=0.02, side=1.0), **changed)
    assert found.isolated == ("stopper-contact",)
    assert found.outside is None
    assert found.outside_of_stop.law == "spring"
    assert judged(force("spring", gap=0.0, side=1.0), **changed).isolated == ()


@pytest.mark.parametrize(
    ("law", "sizes", "effect"),
    [
        ("table.compliance", (1e-9, 1.1e-9, 2e-8), "base-compliance"),
        ("joint1.closed.compliance", (5e-8, 5.5e-8, 5e-7), "joint-compliance"),
        ("table.pitch", (3e-4, 3.2e-4, 1.5e-3), "table-pitch"),
        ("joint1.lever.bias", (0.03, 0.032, 0.075), "eccentricity"),
    ],
)
def test_one_cause_has_sizes_that_agree_in_the_laws_own_unit(law, sizes, effect):
    by_test = {test: {law: size} for test, size in zip(TESTS, sizes, strict=True)}
    assert judged(by_test=by_test).isolated == ()
    assert judged(**{law: sizes[0]}).isolated == (effect,)


def test_a_law_that_is_told_too_roughly_excludes_nothing():
    """A bias of 80 mm with an error of 100 mm hides an eccentric block as well as it shows none."""
    found = judged(**{"joint1.lever.bias": 0.01})
    (bias,) = (one for one in found.laws if one.name == "joint1.lever.bias")
    rough = bias.model_copy(
        update={"errors": dict.fromkeys(TESTS, 0.1), "departures": dict.fromkeys(TESTS, 0.1), "together": 0.2}
    )
    laws = tuple(rough if one.name == bias.name else one for one in found.laws)
    assert law_that_holds("eccentricity", {"body": "block-2"}, found.model_copy(update={"laws": laws})) == ""


def test_an_effect_whose_law_no_nominal_draw_tells_is_left_to_the_features():
    """One block has no joint above whose lever rings after an impact."""
    found = judged()
    silent = found.model_copy(
        update={"readable": tuple(name for name in found.readable if "ringing" not in name)}
    )
    place = {"joint": ["slab", "block-1"]}
    assert not leans_to("impact-restitution", place, found)
    assert leans_to("impact-restitution", place, silent)


def test_a_base_that_turns_against_its_moment_is_broken_and_belongs_to_no_effect():
    found = judged(**{"table.compliance": -2e-9})
    assert [one.name for one in found.broken] == ["table.compliance"]
    assert found.isolated == ()


def test_laws_that_no_draw_tells_keep_their_usual_value():
    untold = np.full((20, len(NAMES)), np.nan)
    nulls = null_laws(NAMES, untold)
    assert "joint1.impact.ringing" not in nulls
    assert nulls["joint1.lever.bias"].mean == 0.0
    assert nulls["joint1.lever.stray"].mean == pytest.approx(tamed("joint1.lever.stray", 1.0))


def test_a_distance_that_is_small_breaks_nothing():
    """Blocks that slide in place of rocking leave less unexplained than nominal draws that rock."""
    found = judged(**{"unexplained.largest": 1e-6, "joint1.lever.stray": 1e-3})
    assert found.broken == ()
    assert found.p > 0.01


def test_the_pitch_that_every_table_has_breaks_nothing():
    assert judged(**{"table.pitch": 2.5e-5}).broken == ()
    assert judged(**{"table.pitch": 3e-4}).isolated == ("table-pitch",)


def test_an_edge_that_broke_between_two_tests_is_no_reduced_bearing():
    by_test = {"one": {"joint1.lever.short": 0.065}, "two": {"joint1.lever.short": 0.012}}
    found = judged(by_test=by_test)
    assert [one.name for one in found.broken] == ["joint1.lever.short"]
    assert found.isolated == ()
    assert not accounts_for("reduced-bearing", found)


@pytest.mark.parametrize(("short", "leans"), [(0.005, False), (0.02, True), (-0.01, False)])
def test_a_law_leans_to_its_effect_or_not(short, leans):
    found = judged(**{"joint1.lever.short": short})
    assert leans_to("reduced-bearing", {}, found) is leans


def test_effects_without_a_law_and_structures_without_levers_are_left_to_the_features():
    found = judged()
    assert leans_to("vertical-motion", {}, found)
    assert not leans_to("stopper-contact", {"body": "block-2"}, found)
    # its friction was not told, as nothing slipped
    slipping = found.model_copy(update={"readable": ("joint1.friction.loss",)})
    assert not leans_to("weak-joint", {"joint": ["slab", "block-1"]}, slipping)
    bridged = found.model_copy(update={"laws": tuple(one for one in found.laws if not one.joint)})
    assert leans_to("weak-joint", {"joint": ["slab", "block-1"]}, bridged)
