"""The scorer: perfect verdicts score 100 %, shuffled truths chance; its page holds what its file states."""

import json
from collections import Counter
from dataclasses import replace

import case_plan
import numpy as np
import pytest
import score
from answer_file import load_answer
from answers import Scored
from case_files import (
    CALIBRATION_SEEDS,
    OPEN_SEEDS,
    PAGE,
    README,
    SEEDS,
    SMALL_SEEDS,
    TRACK_RECORD,
    failure_of,
    load_plan,
    truth_of,
    verdict_of,
)
from case_truth import true_causes
from draw_cases import CLEAN, FORMS, SLIDING, as_text, draw_cases
from draw_cases import STRUCTURES as BY_STRUCTURE
from make_case import LABORATORIES, structure_file
from oracle_gain import ResponseGains
from outside_forces import OUTSIDE
from score import make_track_record
from score_figures import LATE, figures, shares
from scored_record import load_scored_record, write_scored_record
from track_record_text import as_markdown, block_of, in_words, with_block

from blockshake.diagnosis.verdict.verdict import Verdict, write_verdict
from blockshake.effects.registry import EFFECTS
from blockshake.errors import InputError
from blockshake.files import write_json
from blockshake.geometry.structure import load_structure

PLAN = load_plan()
EMPTY = "<!-- figures: begin -->\nold\n<!-- figures: end -->"
STRUCTURES = {
    name: load_structure(structure_file(name))
    for name in {case.structure for seeds in (SEEDS, SMALL_SEEDS) for case in load_plan(seeds).cases}
}
BAD = {
    "false_alarms", "confidently_wrong", "false_beside", "outside_named", "single_called_pair", "unseen", "gain_idle",
    "gain_harmful",
}  # fmt: skip
BODY, OTHER = "block-1", "block-2"
GAIN = {"estimate": 0.5, "lower": 0.4, "upper": 0.6}


def _truth(case):
    tests = case_plan.planned_tests(case.structure, case.seed, case.gain is not None, case.strength)
    structure = STRUCTURES[case.structure]
    far = {body.name: [-1.0, 1.0] for body in structure.file.bodies}
    return {
        "causes": true_causes(case.causes, case.size, structure, len(tests), case.seed), "size": case.size,
        "seed": case.seed, "structure": case.structure, "sealed": case.gain is not None,
        "laboratory": case.laboratory, "moved": 9.0 if set(case.causes) & set(OUTSIDE) else None,
        "tests": {f"test-{n + 1}": {"role": role, "drift": far} for n, (_, _, role) in enumerate(tests)},
    }  # fmt: skip


def _gain(value):
    contrast = {"estimate": value, "lower": value - 0.1, "upper": value + 0.1}
    return {rival: contrast for rival in ("recalibrated", "nominal", "discrepancy")}


def _verdict(decision, causes=(), **keys):
    return Verdict(
        decision=decision, causes=tuple(causes), probabilities={}, misfit={"p": 0.5, "where": ""}, runs=1,
        word="one of", **keys,
    )  # fmt: skip


def _word(place):
    return "-".join(place["joint"]) if "joint" in place else place.get("body", "all")


def _form(cause, tests):
    """The description of a cause from outside without an error."""
    starts = zip(tests, cause["start"], strict=True)
    place = cause["place"]["body"]
    return {
        "form": OUTSIDE[cause["name"]].form, "title": "", "place": {"body": place}, "places": (f"{place}@0.42",),
        "size": {}, "starts": {test: at for test, at in starts if at is not None},
    }  # fmt: skip


def _perfect(truth):
    known = [cause for cause in truth["causes"] if cause["name"] in EFFECTS]
    outside = [_form(cause, truth["tests"]) for cause in truth["causes"] if cause["name"] in OUTSIDE]
    gain = (0.9 if truth["causes"] else 0.0) if truth["sealed"] else None
    parameters, limits = {}, {}
    for cause in known:
        first = EFFECTS[cause["name"]].parameters[0]
        size = cause["values"][first.name]
        limits[cause["name"]] = {_word(cause["place"]): first.null + 0.9 * (size - first.null)}
        parameters[cause["name"]] = {
            name: {"estimate": value, "lower": value, "upper": value, "unit": "1"}
            for name, value in cause["values"].items()
        }
    decision = ("unknown" if outside else "none", "named", "combination")[len(known)]
    return _verdict(
        decision, [cause["name"] for cause in known], parameters=parameters, limits=limits,
        location={cause["name"]: cause["place"] for cause in known if cause["place"]},
        outside=outside[0] if outside else None,
        odds=dict.fromkeys([*(cause["name"] for cause in known), *(one["form"] for one in outside)], 0.0),
        **({} if gain is None else {"gain": _gain(gain), "row_gain": _gain(gain)}),
    )  # fmt: skip


@pytest.fixture(scope="module")
def perfect():
    contrast = {"estimate": 0.9, "lower": 0.8, "upper": 1.0}
    gains = ResponseGains(proposed=True, found=contrast, oracle=contrast)
    truths = [(case, _truth(case)) for case in PLAN.cases]
    return [Scored(case.name, truth, _perfect(truth), gains if case.gain else None) for case, truth in truths]


def test_the_plan_is_what_was_asked_for():
    assert len(PLAN.cases) >= 300
    assert sum(not case.causes for case in PLAN.cases) >= 100
    assert sum(len(case.causes) == 2 for case in PLAN.cases) == 40
    assert sum(case.gain == "responses" for case in PLAN.cases) >= 40
    single = [case for case in PLAN.cases if len(case.causes) == 1]
    for laboratory in LABORATORIES:
        own = Counter((case.causes[0], case.size) for case in single if case.laboratory == laboratory)
        wanted = {(name, size): 1 for name in EFFECTS for size in ("small", "large")}
        assert own == wanted | {(name, None): FORMS[laboratory] for name in OUTSIDE}
    assert {case.structure for case in PLAN.cases} == {*BY_STRUCTURE, SLIDING}
    assert {case.strength for case in PLAN.cases} == set(case_plan.STRENGTHS)
    opened = [case for seeds in (CALIBRATION_SEEDS, OPEN_SEEDS) for case in load_plan(seeds).cases]
    # the open cases have one laboratory less than the sealed ones
    assert {case.laboratory for case in opened} == {"home", "mujoco"}
    everywhere = [*PLAN.cases, *opened]
    assert (
        len({case.seed for case in everywhere}) == len({case.name for case in everywhere}) == len(everywhere)
    )


def test_the_page_counts_the_sealed_cases():
    page = " ".join(PAGE.read_text(encoding="utf-8").split())
    clean = sum(not case.causes for case in PLAN.cases)
    assert f"The {len(PLAN.cases)} sealed cases" in page
    assert f"{clean} are clean" in page
    for name, seeds in (("home", CALIBRATION_SEEDS), ("mujoco", OPEN_SEEDS)):
        assert f"`{seeds.name}` ({len(load_plan(seeds).cases)}, `{name}`)" in page


def test_the_sealed_list_is_what_its_number_draws():
    text = SEEDS.read_text(encoding="utf-8")
    seed = int(text.split("--seed ")[1].split(".")[0])
    assert text == as_text(draw_cases(seed), seed, True)


def test_a_part_of_the_list_keeps_its_strata():
    whole, part = (Counter(case.stratum for case in PLAN.chosen(share).cases) for share in ("1/1", "1/4"))
    assert whole.keys() == part.keys()
    assert all(part[one] == -(-count // 4) for one, count in whole.items())
    fourths = [PLAN.chosen(f"{number}-{number}/4").cases for number in range(1, 5)]
    assert fourths[0] == PLAN.chosen("1/4").cases
    assert sorted(case.name for fourth in fourths for case in fourth) == sorted(
        case.name for case in PLAN.cases
    )
    assert {case.laboratory for case in PLAN.chosen(laboratory="mujoco").cases} == {"mujoco"}
    with pytest.raises(InputError, match="1/4"):
        PLAN.chosen("a quarter")


def test_perfect_verdicts_score_full(perfect):
    found = figures(perfect)
    for name, share in found["shares"].items():
        assert share.hits == (0 if name in BAD else share.n), name
        assert share.met in (True, None) or name == "sizes_hold_no_wider", name
        assert share.n > 0, name
    medians = found["medians"]
    assert medians["gain_named"].estimate == medians["gain_rows_described"].estimate == 0.9
    assert all(median.met in (True, None) for median in medians.values())
    assert sum(row.answers.n for row in found["confusion"]) == len(PLAN.cases)
    assert sum(row.answers.unknown for row in found["confusion"]) == len(OUTSIDE) * sum(FORMS.values())


def test_shuffled_truths_score_chance(perfect):
    """A name given to a truth drawn from all is right as often as two cases have the same truth."""
    known = [case for case in perfect if case.kind == "effect"]
    count = len(known)
    own = [sum(name in case.causes for case in known) for name in EFFECTS]
    chance = sum(number**2 for number in own) / count**2
    generator = np.random.default_rng(1)
    shares = []
    for _ in range(40):
        order = generator.permutation(count)
        shuffled = [
            Scored(case.name, known[at].truth, case.verdict) for case, at in zip(known, order, strict=True)
        ]
        found = figures(shuffled)["shares"]
        shares.append(found["truth_in_set"].hits / count)
        assert found["confidently_wrong"].hits == count - found["truth_in_set"].hits
    # one share has a standard deviation of nearly sqrt(p (1 - p) / count)
    assert abs(np.mean(shares) - chance) < 4.0 * np.sqrt(chance * (1.0 - chance) / count / 40.0)


def test_always_none_is_never_wrong_and_finds_nothing(perfect):
    silent = figures([Scored(case.name, case.truth, _verdict("none")) for case in perfect])["shares"]
    assert silent["false_alarms"].hits == silent["confidently_wrong"].hits == silent["false_beside"].hits == 0
    # 0 of n: 1 - 0.025^(1/n)
    assert silent["false_alarms"].n == sum(CLEAN.values())
    assert silent["false_alarms"].upper == pytest.approx(1.0 - 0.025 ** (1.0 / silent["false_alarms"].n))
    assert not any(silent[key].met for key in ("exact_large", "outside_unknown", "outside_form", "pairs_one"))


def _cause(name="eccentricity", **keys):
    values = {"offset": -0.08, "stiffness": 1e7, "gap": 0.02}
    return {"name": name, "values": values, "place": {"body": BODY}, **keys}


def _case(verdict, *causes, tests=("one",), size="large", drift=0.03):
    truth = {
        "causes": causes or (_cause(),), "size": size, "seed": 1, "sealed": False, "structure": "two-blocks",
        "tests": {name: {"role": "fit", "drift": {BODY: [-0.05, drift]}} for name in tests},
    }  # fmt: skip
    return Scored("case", truth, verdict)


def _share(key, *cases):
    found = figures(list(cases))["shares"][key]
    return found.hits, found.n


ROPE = {"form": "rope", "title": "", "place": {}, "places": (f"{BODY}@0.42",), "size": {}, "starts": {}}


def test_every_answer_has_its_column():
    answers = {
        "right": _case(_verdict("named", ["eccentricity"])),
        "wrong": _case(_verdict("named", ["weak-joint"])),
        "set_with": _case(_verdict("ambiguous", ["weak-joint", "eccentricity"])),
        "set_without": _case(_verdict("ambiguous", ["weak-joint", "table-pitch"])),
        "unknown": _case(_verdict("unknown")),
        "none": _case(_verdict("none")),
        "combination": _case(_verdict("combination", ["weak-joint", "eccentricity"])),
    }
    assert {name: case.answer for name, case in answers.items()} == {name: name for name in answers}


def test_a_class_is_the_truth_with_what_is_mistaken_for_it():
    group = _case(_verdict("ambiguous", ["eccentricity", "stopper-contact"]))
    with_push = _case(_verdict("ambiguous", ["eccentricity"], outside={**ROPE, "form": "push"}))
    with_rope = _case(_verdict("ambiguous", ["eccentricity"], outside=ROPE))
    wider = _case(_verdict("ambiguous", ["eccentricity", "weak-joint"]))
    cases = group, with_push, with_rope, wider
    assert [case.within_class for case in cases] == [True, True, False, False]
    assert (_share("exact_large", *cases), _share("exact_large_alone", *cases)) == ((2, 4), (0, 4))


def test_what_is_asserted_beside_a_truth_is_counted_by_the_parts_of_the_answer():
    right, false = {"eccentricity": 0.0}, {"table-pitch": 0.0}
    single = [
        _case(_verdict("combination", ["eccentricity", "table-pitch"], odds=right | false)),
        _case(_verdict("named", ["eccentricity"], outside=ROPE, odds=right | {"rope": 0.0})),
        _case(_verdict("combination", ["eccentricity", "marker-offset"], odds=right)),  # a sensor has no odds
        _case(_verdict("ambiguous", ["eccentricity", "weak-joint"], odds=right | {"weak-joint": 1.2})),
        _case(_verdict("named", ["table-pitch"], odds=false)),
    ]
    assert [case.asserted for case in single] == [2, 2, 2, 1, 1]
    assert _share("false_beside", *single) == (3, 5)
    assert _share("single_called_pair", *single) == (3, 5)
    pair = _cause(), _cause("table-pitch", place={})
    both = _case(_verdict("combination", ["eccentricity", "table-pitch"], odds=right | false), *pair)
    assert (_share("false_beside", both), _share("pairs_both", both)) == ((0, 1), (1, 1))
    half = _case(_verdict("named", ["eccentricity"], odds=right), *pair)
    assert (_share("pairs_one", half), _share("pairs_both", half)) == ((1, 1), (0, 1))


@pytest.mark.parametrize(
    ("limits", "seen"),
    [
        ({f"{BODY}": 0.07}, True), ({f"{BODY}": -0.09}, False), ({OTHER: 0.01}, False), ({}, False),
        ({f"{BODY}@0": 0.09, f"{BODY}@0.42": 0.05}, True),
    ],
)  # fmt: skip
def test_an_effect_can_be_seen_from_the_limit_at_its_place_on(limits, seen):
    case = _case(_verdict("none", limits={"eccentricity": limits}))
    assert case.can_be_seen is seen
    assert _share("truth_in_set_seen", case) == (0, int(seen))


@pytest.mark.parametrize(("drift", "seen"), [(0.03, True), (0.01, False)])
def test_a_stop_that_is_not_reached_cannot_be_seen(drift, seen):
    stop = _cause("stopper-contact", place={"body": BODY, "axis": "+x"})
    limits = {"stopper-contact": {BODY: 1e6}}
    assert _case(_verdict("none", limits=limits), stop, drift=drift).can_be_seen is seen


@pytest.mark.parametrize(
    ("location", "places", "right"),
    [
        ({"body": BODY}, (), 1), ({"body": OTHER}, (), 0), ({}, (), 0), ({"body": BODY, "axis": "-x"}, (), 0),
        ({"body": OTHER}, (OTHER, BODY), 1), ({"body": OTHER}, (OTHER,), 0),
    ],
)  # fmt: skip
def test_a_place_is_right_where_it_is_said_or_cannot_be_told_from_it(location, places, right):
    verdict = _verdict(
        "named", ["eccentricity"], location={"eccentricity": location}, places={"eccentricity": places}
    )
    case = _case(verdict, _cause(place={"body": BODY, "axis": "+x"}))
    assert _share("location", case) == (right, 1)


def test_a_rope_beside_a_stop_is_as_good_as_unknown():
    rope = _cause("outside-rope", start=[0.0])
    said = {
        "class": _verdict("ambiguous", ["stopper-contact"], outside=ROPE),
        "alone": _verdict("named", ["stopper-contact"]),
        "wider": _verdict("ambiguous", ["stopper-contact", "eccentricity"], outside=ROPE),
        "unknown": _verdict("unknown", outside={**ROPE, "form": "drag"}),
    }
    cases = {name: _case(verdict, rope, size=None) for name, verdict in said.items()}
    assert {name: case.called_unknown for name, case in cases.items()} == {
        "class": True, "alone": False, "wider": False, "unknown": True,
    }  # fmt: skip
    assert _share("outside_named", *cases.values()) == (1, 4)
    assert _share("outside_form", *cases.values()) == (2, 4)
    assert _share("outside_block", *cases.values()) == (2, 2)


@pytest.mark.parametrize(
    ("test", "at", "hits"), [("one", 2.0 + LATE - 0.01, 1), ("one", 2.3, 0), ("two", 2.0, 0)]
)
def test_a_description_is_on_time_in_the_test_that_was_struck(test, at, hits):
    blow = _cause("outside-blow", start=[2.0, None])
    said = _verdict("unknown", outside={**ROPE, "form": "blow", "starts": {test: at}})
    assert _share("outside_time", _case(said, blow, tests=("one", "two"), size=None)) == (hits, 1)


@pytest.mark.parametrize(("true", "hits"), [(0.5, 1), (2.0, 1), (2.3, 0)])
def test_a_start_that_is_said_as_then_or_earlier_is_missed_by_a_later_one_alone(true, hits):
    push = _cause("outside-push", start=[true])
    said = _verdict("unknown", outside={**ROPE, "form": "push", "starts": {"one": 2.0}, "before": ("one",)})
    assert _share("outside_time", _case(said, push, tests=("one",), size=None)) == (hits, 1)


def test_intervals_of_medians_are_order_statistics():
    """6 values the least and largest hold the median in 1 - 2 / 64 = 0.969; of 5 nothing does in 0.95."""
    gained = [
        replace(
            _case(_verdict("named", ["eccentricity"])),
            gains=ResponseGains(
                proposed=True, found={"estimate": n / 10, "lower": -1.0, "upper": 1.0}, oracle=GAIN
            ),
        )
        for n in range(6)
    ]
    six = figures(gained)["medians"]["gain_named"]
    assert (six.lower, six.estimate, six.upper) == (0.0, 0.25, 0.5)
    assert figures(gained[:5])["medians"]["gain_named"].lower is None


def test_the_track_record_comes_back_from_its_file(perfect, tmp_path):
    track_record = make_track_record(perfect, PLAN)
    write_scored_record(tmp_path / "track-record.json", track_record)
    assert load_scored_record(tmp_path / "track-record.json") == track_record
    page = with_block(f"before\n{EMPTY}\nafter\n", "figures", as_markdown(track_record))
    assert block_of(page, "figures") == as_markdown(track_record)
    assert page.startswith("before")
    assert page.endswith("after\n")
    assert with_block(page, "figures", as_markdown(track_record)) == page


def test_scoring_goes_from_the_files_of_a_run_to_track_record_and_page(perfect, tmp_path, capsys):
    for case in perfect:
        write_json(truth_of(tmp_path, case.name), case.truth)
        write_verdict(verdict_of(tmp_path, case.name), case.verdict)
    page, record, readme = tmp_path / "page.md", tmp_path / "track-record.json", tmp_path / "readme.md"
    page.write_text(EMPTY)
    readme.write_text(EMPTY.replace("figures", "record"))
    asked = [
        "--results",
        str(tmp_path),
        "--track-record",
        str(record),
        "--page",
        str(page),
        "--readme",
        str(readme),
    ]
    score.main(asked)
    text = as_markdown(load_scored_record(record))
    assert block_of(page.read_text(), "figures") == text == capsys.readouterr().out.strip()
    assert block_of(readme.read_text(), "record") == in_words(load_scored_record(record))
    verdict_of(tmp_path, perfect[0].name).unlink()
    with pytest.raises(InputError):
        score.main(asked)
    write_json(failure_of(tmp_path, perfect[0].name), {"step": "diagnose", "reason": "ValueError: none"})
    score.main(asked)
    assert load_scored_record(record).failed == (perfect[0].name,)
    assert "; 1 more could not be made or diagnosed." in page.read_text()


def test_another_plan_than_the_sealed_one_is_printed_alone(tmp_path, capsys):
    for case in load_plan(SMALL_SEEDS).cases:
        truth = _truth(case)
        write_json(truth_of(tmp_path, case.name), truth)
        write_verdict(verdict_of(tmp_path, case.name), _perfect(truth))
    record = tmp_path / "track-record.json"
    score.main(["--results", str(tmp_path), "--seeds", str(SMALL_SEEDS), "--track-record", str(record)])
    assert "| eccentricity, large |  | 1 |" in capsys.readouterr().out
    assert not record.exists()


@pytest.mark.parametrize(
    ("change", "key"),
    [
        (lambda record: record["shares"]["false_alarms"].update(hits=99), "hits"),
        (lambda record: record["cases"].pop(), "cases"),
        (lambda record: record.update(extra=1), "extra"),
        (lambda record: record.update(version=99), "version"),
    ],
)
def test_a_track_record_that_contradicts_itself_is_refused(perfect, tmp_path, change, key):
    record = make_track_record(perfect, PLAN).model_dump(mode="json")
    change(record)
    (tmp_path / "track-record.json").write_text(json.dumps(record))
    with pytest.raises(InputError) as error:
        load_scored_record(tmp_path / "track-record.json")
    assert key in str(error.value)


def test_a_missing_track_record_is_one_line(tmp_path):
    with pytest.raises(InputError):
        load_scored_record(tmp_path / "none.json")


@pytest.fixture(scope="module")
def record():
    """The record that the package ships, where it is of the plan of today."""
    shipped = load_scored_record(TRACK_RECORD)
    if shipped.seeds != PLAN.digest:
        pytest.skip("the track record is of an earlier plan: make test-hidden measures a new one")
    return shipped


def test_the_page_shows_what_the_file_says(record):
    assert block_of(PAGE.read_text(encoding="utf-8"), "figures") == as_markdown(record)


def test_the_readme_says_what_the_file_says(record):
    assert block_of(README.read_text(encoding="utf-8"), "record") == in_words(record)


def test_a_cause_that_moves_nothing_is_counted_apart(perfect):
    struck = next(case for case in perfect if case.kind == "outside")
    still = replace(struck, truth=struck.truth | {"moved": 1.0}, verdict=_verdict("none"))
    found = shares([still])
    assert (found["unseen"].hits, found["outside_unknown"].n) == (1, 0)


def test_a_program_that_always_says_none_is_scored_by_its_files_alone(perfect, tmp_path, capsys):
    for case in perfect:
        write_json(truth_of(tmp_path / "made", case.name), case.truth)
        write_json(tmp_path / "said" / case.name / "verdict.json", {"decision": "none"})
    score.main(["--results", str(tmp_path / "made"), "--verdicts", str(tmp_path / "said")])
    out = capsys.readouterr().out
    assert (
        "| an effect is called where there is none | 0.000 (0 of 32) | 0.000 (0 of 46) | 0.000 (0 of 36) |"
        in out
    )
    known = len(EFFECTS) * 2
    assert f"| the truth is named or in the set | 0.000 (0 of {known}) |" in out


def test_an_answer_that_contradicts_itself_is_one_line(tmp_path):
    write_json(tmp_path / "verdict.json", {"decision": "named"})
    with pytest.raises(InputError, match="expected one cause for 'named'"):
        load_answer(tmp_path / "verdict.json")


@pytest.mark.parametrize(
    ("gains", "share", "idle"),
    [
        ({"proposed": True, "found": GAIN, "oracle": GAIN}, 1.0, False),
        ({"proposed": True, "found": None, "oracle": GAIN}, 0.0, False),
        ({"proposed": False, "found": None, "oracle": GAIN}, None, False),
        ({"proposed": True, "found": GAIN, "oracle": None}, None, True),
        (
            {"proposed": True, "found": GAIN, "oracle": {"estimate": 0.1, "lower": -0.2, "upper": 0.4}},
            None,
            True,
        ),
    ],
)
def test_a_gain_is_held_against_the_oracles(gains, share, idle):
    gains = ResponseGains(**gains)
    assert (gains.share, gains.idle) == (share, idle)


def test_an_extension_that_predicts_worse_is_counted(perfect):
    gains = ResponseGains(proposed=True, found={"estimate": -0.3, "lower": -0.9, "upper": 0.1}, oracle=GAIN)
    gained = [replace(case, gains=gains) for case in perfect if case.kind == "effect"][:3]
    found = figures(gained)
    assert (found["shares"]["gain_harmful"].hits, found["shares"]["gain_harmful"].met) == (3, False)
    assert found["medians"]["gain_over_oracle"].estimate == pytest.approx(-0.6)
    assert [one.found.estimate for one in found["gains"]] == [-0.3] * 3


def test_a_true_cause_that_gains_nothing_is_marked(perfect):
    oracles = [None, {"estimate": 0.2, "lower": 0.0, "upper": 0.4}, GAIN]
    effects = [case for case in perfect if case.kind == "effect"][:3]
    gained = [
        replace(case, gains=ResponseGains(proposed=False, found=None, oracle=oracle))
        for case, oracle in zip(effects, oracles, strict=True)
    ]
    record = make_track_record([*gained, *(case for case in perfect if case not in effects)], PLAN)
    rows = [row for row in as_markdown(record).splitlines() if "| not proposed |" in row]
    assert sorted("the cause changes no prediction" in row for row in rows) == [False, True, True]


def test_a_report_has_the_figure_of_the_worst_laboratory(perfect):
    alarmed = [
        replace(case, verdict=_verdict("named", ["eccentricity"]))
        if case.kind == "clean" and case.laboratory == "mujoco"
        else case
        for case in perfect
    ]
    laboratory, worst = make_track_record(alarmed, PLAN).worst["false_alarms"]
    assert (laboratory, worst.hits, worst.n) == ("mujoco", 46, 46)
