"""The scorer: perfect verdicts score 100 %, shuffled truths chance; its page holds what its file says."""

import json

import numpy as np
import pytest
import score
from case_files import PAGE, ROOT, SMALL_SEEDS, TRACK_RECORD, load_plan, truth_of
from case_truth import true_effect
from make_case import structure_file
from outside_forces import OUTSIDE
from score import make_track_record
from score_figures import Scored, figures
from track_record_text import as_markdown, block_of, with_block

from blockshake.diagnosis.laws.findings import OutsideForce
from blockshake.diagnosis.verdict.track_record import load_track_record, write_track_record
from blockshake.diagnosis.verdict.verdict import Verdict, write_verdict
from blockshake.effects.registry import EFFECTS
from blockshake.errors import InputError
from blockshake.files import write_json
from blockshake.geometry.structure import load_structure

PLAN = load_plan()
EMPTY = "<!-- figures: begin -->\nold\n<!-- figures: end -->"
STRUCTURES = {name: load_structure(structure_file(name)) for name in PLAN.efforts}
TESTS = ("one", "two", "three")
GAIN = {"estimate": 0.7, "lower": 0.5, "upper": 0.9}
LAW_GAIN = {"estimate": 0.9, "lower": 0.8, "upper": 1.0}
# effects that are hidden in structures other than two blocks
ELSEWHERE = (
    "table-pitch", "vertical-motion", "stopper-contact", "reduced-bearing", "eccentricity", "weak-joint",
    "joint-compliance", "base-compliance",
)  # fmt: skip


def _truth(case):
    effect = true_effect(case.truth, case.size, STRUCTURES[case.structure], len(TESTS), case.seed)
    tests = {test: {"trace": 2e-4} for test in TESTS}
    return {
        "truth": case.truth, "size_class": case.size, "effect": effect, "seed": case.seed, "tests": tests,
        "structure": case.structure,
        "sealed": case.sealed,
    }  # fmt: skip


def _verdict(decision, causes=(), **keys):
    return Verdict(
        decision=decision,
        causes=tuple(causes),
        probabilities={},
        misfit={"p": 0.5, "where": ""},
        runs=1,
        word="one of",
        **keys,
    )


def _perfect(truth):
    if truth["effect"] is None:
        nothing = dict.fromkeys(GAIN, 0.0)
        return _verdict("none", gain=dict.fromkeys(("recalibrated", "nominal", "discrepancy"), nothing))
    name, values, place = truth["truth"], truth["effect"]["values"], truth["effect"]["place"]
    if name in OUTSIDE:
        return _verdict(
            "unknown", outside=_described(truth), law_gain=LAW_GAIN,
            gain=dict.fromkeys(("recalibrated", "nominal", "discrepancy"), GAIN),
        )  # fmt: skip
    parameters = {
        item.name: {
            "estimate": values[item.name], "lower": values[item.name], "upper": values[item.name], "unit": item.unit,
        }
        for item in EFFECTS[name].parameters
    }  # fmt: skip
    return _verdict(
        "named", [name], parameters={name: parameters}, location={name: place} if place else {},
        gain=dict.fromkeys(("recalibrated", "nominal", "discrepancy"), GAIN), law_gain=LAW_GAIN,
    )  # fmt: skip


def _described(truth):
    """The force that a description without an error gives."""
    starts = zip(TESTS, truth["effect"]["start"], strict=True)
    return OutsideForce(
        bodies=(truth["effect"]["place"]["body"],), law="constant", scores={"constant": 0.0}, amplitude=1.0,
        lower=0.5, upper=1.5, unit="N", tests={test: {"start": at} for test, at in starts if at is not None},
    )  # fmt: skip


@pytest.fixture(scope="module")
def perfect():
    truths = {case.name: _truth(case) for case in PLAN.cases}
    scored = [Scored(name, truth, _perfect(truth)) for name, truth in truths.items()]
    return scored + [Scored(name, truths[name], _verdict("unknown"), removed=True) for name in PLAN.removed]


def test_the_plan_is_what_the_docs_say():
    wanted = {("two-blocks", "none", None): 60} | {("two-blocks", name, None): 4 for name in OUTSIDE}
    wanted |= {("two-blocks", name, size): 3 for name in EFFECTS for size in ("small", "large")}
    slides = (
        ("weak-joint", "small"),
        ("rate-weakening-friction", "small"),
        ("rate-weakening-friction", "large"),
    )
    for kind in slides:
        del wanted["two-blocks", *kind]
    for structure in set(PLAN.efforts) - {"two-blocks", "sliding-blocks"}:
        wanted |= {(structure, "none", None): 4} | {(structure, name, "large"): 1 for name in ELSEWHERE}
        wanted |= {(structure, name, None): 1 for name in ("outside-push", "outside-blow", "outside-rope")}
    wanted |= {("sliding-blocks", "none", None): 4, ("sliding-blocks", "weak-joint", "large"): 1}
    wanted |= {("sliding-blocks", *kind): 3 for kind in slides}
    wanted |= {("sliding-blocks", name, None): 1 for name in ("outside-push", "outside-rope", "outside-drag")}
    counted = {}
    for case in PLAN.cases:
        kind = (case.structure, case.truth, case.size)
        counted[kind] = counted.get(kind, 0) + 1
    assert counted == wanted
    assert len({case.seed for case in PLAN.cases}) == len({case.name for case in PLAN.cases}) == 215
    large = {case.name: case.truth for case in PLAN.cases if case.size == "large"}
    assert [large[name] for name in PLAN.removed] == list(EFFECTS)


def test_perfect_verdicts_score_full(perfect):
    found = figures(perfect)
    for name, share in found["shares"].items():
        wrong = name in ("false_alarms", "confidently_wrong", "unknown_named", "outside_named")
        assert share.hits == (0 if wrong else share.n), name
        assert share.met in (True, None), name
        assert share.n > 0 or name == "bound_holds"
    assert found["medians"]["gain_named"].estimate == 0.7
    assert found["medians"]["gain_clean"].estimate == 0.0
    assert all(median.met in (True, None) for median in found["medians"].values())
    assert found["medians"]["gain_laws_named"].estimate == 0.9
    assert sum(row.answers.right for row in found["confusion"]) == sum(
        case.truth in EFFECTS for case in PLAN.cases
    )


def test_shuffled_truths_score_chance(perfect):
    """A name given to a truth drawn from all is right as often as two cases have the same truth."""
    known = [case for case in perfect if case.truth["truth"] in EFFECTS and not case.removed]
    count = len(known)
    own = [sum(case.truth["truth"] == name for case in known) for name in EFFECTS]
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
    silent = [Scored(case.name, case.truth, _verdict("none"), case.removed) for case in perfect]
    found = figures(silent)["shares"]
    assert found["false_alarms"].hits == found["confidently_wrong"].hits == 0
    # 0 of n: 1 - 0.025^(1/n)
    assert found["false_alarms"].n == 76
    assert found["false_alarms"].upper == pytest.approx(1.0 - 0.025 ** (1.0 / 76.0))
    assert found["truth_in_set"].met is False
    assert found["unknown_recall"].met is False


def _case(verdict, truth="eccentricity", place=None, size="large", removed=False):
    place = place or {"body": "block-1"}
    effect = {"name": truth, "values": {"offset": -0.08}, "place": place}
    told = {
        "truth": truth,
        "size_class": size,
        "effect": effect,
        "seed": 1,
        "sealed": False,
        "tests": {},
        "structure": "two-blocks",
    }
    return Scored("case", told, verdict, removed)


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
    # its own name is no right answer where the candidates lacked it, for then it cannot have been given
    assert _case(_verdict("named", ["eccentricity"]), removed=True).answer == "wrong"


def test_sets_within_the_truths_own_group_are_left_out_of_exact_names():
    group = _case(_verdict("ambiguous", ["eccentricity", "stopper-contact"]))
    wider = _case(_verdict("ambiguous", ["eccentricity", "weak-joint"]))
    found = figures([group, wider])["shares"]
    assert (found["exact_large"].n, found["exact_large_all"].n) == (1, 2)


@pytest.mark.parametrize(
    ("said", "right"),
    [({"body": "block-1"}, 1), ({"body": "block-2"}, 0), ({}, 0), ({"body": "block-1", "axis": "-x"}, 0)],
)
def test_a_place_is_right_where_all_that_is_said_is(said, right):
    verdict = _verdict("named", ["eccentricity"], location={"eccentricity": said})
    place = {"body": "block-1", "axis": "+x"}
    assert figures([_case(verdict, place=place)])["shares"]["location"].hits == right


@pytest.mark.parametrize(("limit", "hits"), [(0.09, 1), (-0.09, 1), (0.07, 0)])
def test_a_bound_holds_where_the_truth_is_smaller(limit, hits):
    found = figures([_case(_verdict("none", excluded_above={"eccentricity": limit}))])["shares"]
    assert (found["bound_holds"].hits, found["bound_holds"].n) == (hits, 1)


def test_intervals_of_medians_are_order_statistics(perfect):
    """Of 6 values the least and largest hold the median in 1 - 2 / 64 = 0.969; of 5 nothing does in 0.95."""
    cases = [case for case in perfect if case.answer == "right"]
    gained = []
    for number, case in enumerate(cases[:6]):
        gain = dict.fromkeys(("recalibrated", "nominal", "discrepancy"), dict.fromkeys(GAIN, number / 10))
        gained.append(
            Scored(case.name, case.truth, Verdict(**{**case.verdict.model_dump(), "gain": gain}), False)
        )
    six = figures(gained)["medians"]["gain_named"]
    assert (six.lower, six.estimate, six.upper) == (0.0, 0.25, 0.5)
    assert figures(gained[:5])["medians"]["gain_named"].lower is None


def test_the_track_record_comes_back_from_its_file(perfect, tmp_path):
    track_record = make_track_record(perfect, PLAN.efforts, PLAN.digest)
    write_track_record(tmp_path / "track-record.json", track_record)
    assert load_track_record(tmp_path / "track-record.json") == track_record
    page = with_block(f"before\n{EMPTY}\nafter\n", "figures", as_markdown(track_record))
    assert block_of(page, "figures") == as_markdown(track_record)
    assert page.startswith("before")
    assert page.endswith("after\n")
    assert with_block(page, "figures", as_markdown(track_record)) == page


def test_scoring_goes_from_the_files_of_a_run_to_track_record_and_page(tmp_path, monkeypatch, capsys):
    plan = load_plan(SMALL_SEEDS)
    verdicts = tmp_path / "verdicts"
    monkeypatch.setattr(score, "load_plan", lambda: plan)
    monkeypatch.setattr(
        score, "verdict_of", lambda results, name, without: verdicts / f"{name}-{without}" / "verdict.json"
    )
    for case in plan.cases:
        write_json(truth_of(tmp_path, case.name) / "truth.json", _truth(case))
        write_verdict(verdicts / f"{case.name}-None" / "verdict.json", _perfect(_truth(case)))
    write_verdict(verdicts / "small-4-eccentricity" / "verdict.json", _verdict("unknown"))
    page = tmp_path / "page.md"
    page.write_text(EMPTY)
    told = [
        "--results",
        str(tmp_path),
        "--track-record",
        str(tmp_path / "track-record.json"),
        "--page",
        str(page),
    ]
    score.main(told)
    track_record = load_track_record(tmp_path / "track-record.json")
    assert [case.answer for case in track_record.cases] == ["none", "right", "right", "right", "unknown"]
    assert (
        block_of(page.read_text(), "figures") == as_markdown(track_record) == capsys.readouterr().out.strip()
    )
    (verdicts / "small-2-None" / "verdict.json").unlink()
    with pytest.raises(InputError):
        score.main(told)


@pytest.mark.parametrize(
    ("change", "key"),
    [
        (lambda told: told["shares"]["false_alarms"].update(hits=99), "hits"),
        (lambda told: told["cases"].pop(), "cases"),
        (lambda told: told.update(extra=1), "extra"),
        (lambda told: told.update(version=2), "version"),
    ],
)
def test_a_track_record_that_contradicts_itself_is_refused(perfect, tmp_path, change, key):
    told = make_track_record(perfect, PLAN.efforts, PLAN.digest).model_dump(mode="json")
    change(told)
    (tmp_path / "track-record.json").write_text(json.dumps(told))
    with pytest.raises(InputError) as error:
        load_track_record(tmp_path / "track-record.json")
    assert key in str(error.value)


def test_a_missing_track_record_is_one_line(tmp_path):
    with pytest.raises(InputError):
        load_track_record(tmp_path / "none.json")


def test_the_page_shows_what_the_file_says():
    page = PAGE.read_text(encoding="utf-8")
    if TRACK_RECORD.is_file():
        assert block_of(page, "figures") == as_markdown(load_track_record(TRACK_RECORD))
        # of the last plan that was run; the next one is fixed before it is
        assert load_track_record(TRACK_RECORD).seeds == PLAN.digest
    else:
        assert block_of(page, "figures") == "Not run yet: no figures."


def test_the_readme_says_what_the_file_says():
    readme = " ".join((ROOT / "README.md").read_text(encoding="utf-8").split())
    record = load_track_record(TRACK_RECORD)
    assert (
        f"We made {sum(not row.removed for row in record.confusion for _ in range(row.answers.n))} " in readme
    )
    for name, words in {
        "truth_in_set": "in {share:.0f} % of the {n} (goal {goal:.0f} %)",
        "false_alarms": "in {share:.0f} % of the {n} (goal {goal:.0f} %)",
        "outside_unknown": "in {share:.0f} % of the {n} (goal {goal:.0f} %)",
        "outside_named": "in {share:.0f} % (goal {goal:.0f} %)",
    }.items():
        one = record.shares[name]
        assert words.format(share=100.0 * one.estimate, n=one.n, goal=100.0 * one.goal) in readme, name


def test_removed_and_known_cases_do_not_mix():
    found = figures([_case(_verdict("unknown"), removed=True), _case(_verdict("named", ["eccentricity"]))])
    assert found["shares"]["truth_in_set"].n == 1
    assert found["shares"]["unknown_recall"].n == 1
    assert [row.removed for row in found["confusion"]] == [False, True]


@pytest.mark.parametrize(("late", "hits"), [(0.2, 1), (0.4, 0)])
def test_a_description_is_on_time_within_three_tenths_of_a_second(late, hits):
    case = next(case for case in PLAN.cases if case.truth == "outside-push")
    truth = _truth(case)
    told = _described(
        truth | {"effect": truth["effect"] | {"start": [at + late for at in truth["effect"]["start"]]}}
    )
    found = figures([Scored(case.name, truth, _verdict("unknown", outside=told))])["shares"]
    assert found["outside_time"].hits == hits
    assert found["outside_block"].hits == 1
