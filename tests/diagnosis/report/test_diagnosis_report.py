import re
from dataclasses import replace

import pytest
from fake_diagnosis import SIMULATED, FakeDiagnosis
from fake_findings import KINDS, OPEN, PUSHED, SEALED, gain_finding, part, track_record
from page import CLAIMS, Page

from blockshake.diagnosis.answer.decision import Part
from blockshake.diagnosis.report.content import load_diagnosed
from blockshake.diagnosis.report.report import compose_diagnosis, make_diagnosis_report
from blockshake.diagnosis.report.statement import not_distinguished, statement, until_then
from blockshake.diagnosis.verdict.track_record import procedure_digest
from blockshake.diagnosis.verdict.verdict import NOTHING_TO_GAIN, load_verdict
from blockshake.errors import InputError
from blockshake.files import write_json
from blockshake.pages.writing import write_html

ALWAYS = [
    "Answer", "Odds of all causes", "Gain on sealed tests", "Sensors", "Limits: what would have been seen",
    "Track record of the procedure", "Tests, assumptions, origin",
]  # fmt: skip


@pytest.fixture(scope="module")
def documents(found):
    return {kind: compose_diagnosis(one) for kind, one in found.items()}


@pytest.fixture(scope="module")
def pages(documents, tmp_path_factory):
    """Text of each page, with its parser."""
    folder, made = tmp_path_factory.mktemp("pages"), {}
    for kind, document in documents.items():
        write_html(folder / f"{kind}.html", document)
        page = Page()
        page.feed((folder / f"{kind}.html").read_text(encoding="utf-8"))
        page.close()
        made[kind] = page, " ".join(" ".join(page.words).split())
    return made


def blocks_of(document, kind, section=None):
    return [
        block
        for one in document.sections
        for block in one.blocks
        if block.kind == kind and section in (None, one.key)
    ]


@pytest.mark.parametrize("kind", KINDS)
def test_every_decision_has_a_whole_page(pages, documents, kind):
    page, _ = pages[kind]
    assert page.open == []
    assert len(set(page.ids)) == len(page.ids)
    assert set(page.references) <= {f"#{one}" for one in page.ids}
    titles = [section.title for section in documents[kind].sections]
    assert [title for title in titles if title in ALWAYS] == ALWAYS
    assert ("Size of what acts" in titles) == (kind != "none")
    assert ("What the nominal simulation gets wrong" in titles) == (kind == SIMULATED)
    for table in blocks_of(documents[kind], "table"):
        assert {len(table.header), len(table.align)} == {len(row) for row in table.rows}, table.caption
    for what in ("figure", "table"):
        counted = [block.number for block in blocks_of(documents[kind], what)]
        assert counted == list(range(1, len(counted) + 1))


@pytest.mark.parametrize("kind", KINDS)
def test_the_page_opens_with_the_answer_and_claims_no_more_than_its_word(pages, found, documents, kind):
    text = pages[kind][1]
    box, *following = documents[kind].sections[0].blocks
    assert box.sentence == statement(found[kind])
    assert box.sentence.lower().startswith(found[kind].verdict.word)
    assert [block.text for block in following[: len(not_distinguished(found[kind]))]] == not_distinguished(
        found[kind]
    )
    assert documents[kind].sections[0].blocks[-1].kind == "figure"
    assert not [claim for claim in CLAIMS if claim in text.lower()]


@pytest.mark.parametrize("kind", KINDS)
def test_synthetic_is_said_where_it_shows(pages, kind):
    text = pages[kind][1]
    assert "The tests are SYNTHETIC" in text
    assert "virtual test (synthetic)" in text
    assert "alkion (SYNTHETIC): stochastic method" in text


def test_the_box_has_the_numbers_of_the_verdict(fakes, documents):
    verdict = load_verdict(fakes["named"].results / "verdict.json")
    facts = [value for _, value, _ in documents["named"].sections[0].blocks[0].facts]
    assert facts == ["less than 1 in a million", "50 mm (45 to 55) towards +x", "60 % (50 to 70 %)"]
    assert verdict.misfit.p == 1e-12
    assert verdict.parameters["eccentricity"]["offset"].estimate == 0.05
    assert verdict.row_gain.recalibrated.estimate == 0.8


def test_the_card_of_the_gain_agrees_with_the_table(found):
    """A recalibrated model without an error to remove stands with a gain over the nominal one."""
    one = found["named"]
    gain = one.verdict.gain.model_copy(update={"recalibrated": NOTHING_TO_GAIN})
    document = compose_diagnosis(replace(one, verdict=one.verdict.model_copy(update={"gain": gain})))
    _, value, note = document.sections[0].blocks[0].facts[2]
    assert value == "no error to remove"
    assert "of the nominal model's: 60 % (50 to 70 %)" in note
    rows = {row[0]: row[2] for row in blocks_of(document, "table", "gain")[0].rows}
    assert rows["the nominal model"] == "60 % (50 to 70 %)"
    assert rows["the nominal model, recalibrated on the open tests"] == value


def test_a_gain_on_forces_is_no_headline_where_that_on_responses_may_be_nothing(found):
    one = found["named"]
    nothing = one.verdict.gain.recalibrated.model_copy(update={"estimate": 0.0, "lower": -0.1, "upper": 0.1})
    gain = one.verdict.gain.model_copy(update={"recalibrated": nothing})
    document = compose_diagnosis(replace(one, verdict=one.verdict.model_copy(update={"gain": gain})))
    _, value, note = document.sections[0].blocks[0].facts[2]
    assert value == "none shown"
    assert "0 % (-10 to 10 %)" in note
    assert note.endswith("on their forces: 80 % (70 to 90 %)")


def test_a_gain_on_forces_alone_is_no_prediction(documents):
    """Nothing was simulated at quick effort; what the forces gain stands in the note."""
    _, value, note = documents["unknown"].sections[0].blocks[0].facts[2]
    assert value == "not simulated"
    assert note == ("effort quick simulates no response; on the forces read off them: 80 % (70 to 90 %)")


def test_none_says_which_sizes_would_have_been_seen(documents):
    words = documents["none"].sections[0].blocks[1].text
    assert "pitch of the table beyond 0.050 mrad per m/s²" in words
    assert "eccentric mass of a block beyond 21 mm" in words
    assert "contact with a stop" not in words  # seen at some places alone


def test_limits_stand_by_effect_in_units_of_engineers(documents):
    (table,) = blocks_of(documents["none"], "table", "limits")
    rows = {row[0]: row[2:] for row in table.rows}
    assert rows["eccentric mass of a block"] == (
        "beyond 19 mm, block-2",
        "beyond 21 mm, block-1",
        "beyond 21 mm",
    )
    assert rows["joint of low friction"] == ("below 66 %, joint slab-block-1", "", "not everywhere")
    assert rows["contact with a stop"][:2] == (
        "beyond 0.020 MN/m, top of block-1",
        "beyond 0.40 MN/m, middle of block-1",
    )
    assert rows["soft joint"] == ("not seen", "", "not everywhere")


def test_every_cause_of_the_set_has_its_size(documents):
    (table,) = blocks_of(documents["ambiguous"], "table", "size")
    assert [row[:1] + row[2:4] for row in table.rows] == [
        ("joint of low friction", "41.0 % (36.9 to 45.1)", "10 to 100 %"),
        ("friction that falls with slip rate", "61 % (55 to 67)", "0 to 90 %"),
        ("friction that falls with slip rate", "12.0 mm/s (10.8 to 13.2)", "1 to 100 mm/s"),
    ]


def test_gain_stands_on_forces_and_on_responses(documents):
    (gains,) = blocks_of(documents["named"], "table", "gain")
    assert gains.header == ("Alternative", "Forces", "Responses")
    assert {row[1:] for row in gains.rows} == {("80 % (70 to 90 %)", "60 % (50 to 70 %)")}
    assert blocks_of(documents["unknown"], "table", "gain")[0].header == ("Alternative", "Forces")


def test_the_report_ends_with_what_the_cause_changes(documents):
    document = documents["named"]
    assert [section.key for section in document.sections][-2:] == ["effect", "origin"]
    (table,) = blocks_of(document, "table", "effect")
    assert [row[:2] for row in table.rows[:4]] == [
        (SEALED[0], "median of the drift [mm]"), (SEALED[0], "95 % quantile of the drift [mm]"),
        (SEALED[0], "95 % quantile of the uplift [mm]"), (SEALED[0], "probability of collapse [%]"),
    ]  # fmt: skip
    assert [row[-1] for row in table.rows[:4]] == ["26.2", "26.2", "2.6", "none"]
    without, extended = (float(table.rows[0][column].partition(" ")[0]) for column in (2, 3))
    assert extended == pytest.approx(1.3 * without, abs=0.11)
    (items,) = blocks_of(document, "items", "effect")
    assert items.items[0].startswith(
        f"{SEALED[0]}, 24 pairs of samples: eccentric mass of a block changes median"
    )
    assert "Not distinguished from no change: probability of collapse." in items.items[0]
    assert all(section.key != "effect" for section in documents["none"].sections)


def test_without_a_cause_no_gain_is_shown(pages):
    assert "No gain was measured" in pages["none"][1]


def test_misfit_ranks_histories_by_their_usual_error(documents):
    (table,) = blocks_of(documents["named"], "table", "misfit")
    ratios = [float(row[5]) for row in table.rows]
    assert ratios == sorted(ratios, reverse=True)
    assert table.rows[0][:2] == (OPEN[-1], "drift, block-3")


def test_a_gain_of_an_earlier_run_is_not_shown_at_quick_effort(fakes, documents):
    fake = fakes["unknown"]
    for name in ("gain.nc", "misfit.nc"):
        (fake.results / name).write_bytes((fakes[SIMULATED].results / name).read_bytes())
    again = load_diagnosed(*fake.arguments())
    assert again.gain is None
    assert again.misfit is None


def test_a_track_record_of_an_earlier_program_is_called_so(fakes, pages):
    words = "changed since: the track record is that of an earlier one"
    assert words in pages["named"][1]
    write_json(fakes["none"].track_record, track_record() | {"procedure": procedure_digest()})
    of_today = compose_diagnosis(load_diagnosed(*fakes["none"].arguments()))
    assert not any(words in block.text for block in blocks_of(of_today, "text", "track-record"))
    write_json(fakes["none"].track_record, track_record() | {"shares": {"false_alarms": {"hits": 2, "n": 1}}})
    with pytest.raises(InputError, match=r"hidden-effects\.json: shares"):
        load_diagnosed(*fakes["none"].arguments())
    fakes["none"].track_record.unlink()


def test_track_record_is_two_lines_for_a_reader_and_where_all_figures_are(pages, documents):
    (lines,) = blocks_of(documents["named"], "items", "track-record")
    assert lines.items == (
        "False alarms: 1 of 30 campaigns in which nothing was hidden (95 % limits 0 to 17 %; goal at most 5 %, too "
        "few to show it).",
        "Effects named, or listed with others: 5 of 6 that the tests can show (95 % limits 36 to 100 %; goal at least "
        "88 %, missed).",
    )
    link, _ = (block.text for block in blocks_of(documents["named"], "text", "track-record"))
    assert "a quarter of those planned" in link
    assert link.endswith("docs/results/hidden-effects.md.")
    assert "This procedure has no track record" in pages["none"][1]


def test_tests_sensors_and_files_are_accounted_for(pages, found):
    text = pages["named"][1]
    assert f"{OPEN[0]} alkion 1 fit judged by the slab alone: no joint moved" in text
    assert f"judged by 3 tests ({', '.join(OPEN)}), of which joints moved in 2, effort standard" in text
    assert f"{OPEN[1]} alkion 1 fit judged by" in text
    for name in SEALED:
        assert f"{name} alkion 1 sealed sealed: read for the skill score alone" in text
    assert "sealed: not read" in pages["none"][1]
    assert "214 hypotheses on" in text
    assert "Not checked against others" in text
    assert "2 accelerometer channels" in text
    assert "Accelerometer channels whose scale the markers of their bodies show: block-1-acc-x." in text
    assert "the markers do not show what they read or it is small: block-1-acc-z." in text
    assert "whose scale the markers of their bodies show: wire-1." in text
    assert "these hardly moved apart: wire-2." in text
    assert "The rotation of block-4, which has one marker." in text
    assert not [path for path in found["named"].digests if any(name in path for name in SEALED)]


def test_a_sensor_s_fault_alone_is_the_answer(tmp_path):
    one = load_diagnosed(*FakeDiagnosis(tmp_path, "none", findings=[gain_finding()]).arguments())
    assert one.verdict.decision == "named"
    assert statement(one).startswith("Probable: gain of a marker (block-2-face), error 3")
    assert "undamaged blocks explain all forces" in statement(one)
    assert "take the fault out of the readings" in until_then(one)
    document = compose_diagnosis(one)
    (table,) = blocks_of(document, "table", "sensors")
    assert table.rows[0][:4] == ("gain of a marker", "block-2-face", "gain", "3 % (0.10 %)")


def test_a_blow_is_drawn_near_its_time(found):
    blow = {**PUSHED, "name": "blow", "when": {"blows": {OPEN[2]: {"time": 2.5, "width": 0.08}}}}
    decision = found["unknown"].decision.model_copy(
        update={"parts": (Part.model_validate(part("joints", blow)),)}
    )
    document = compose_diagnosis(replace(found["unknown"], decision=decision))
    (figure,) = blocks_of(document, "figure", "answer")
    assert "within 0.5 s of a blow" in figure.caption
    assert figure.caption.endswith(f"Not drawn: {OPEN[0]}, {OPEN[1]}.")


def test_tests_without_any_movement_of_joints_have_words_in_place_of_a_figure(found):
    still = found["none"].departures.isel(instant=slice(0))
    document = compose_diagnosis(replace(found["none"], departures=still))
    assert blocks_of(document, "figure", "answer") == []
    assert blocks_of(document, "text", "answer")[-1].text.startswith("No joint turned, slipped or lifted")


def test_html_and_pdf_are_the_same_bytes_again(fakes, tmp_path):
    made = []
    for name in "ab":
        paths = tmp_path / f"{name}.html", tmp_path / f"{name}.pdf"
        make_diagnosis_report(*fakes["combination"].arguments(), *paths)
        made.append([path.read_bytes() for path in paths])
    assert made[0] == made[1]
    pdf = made[0][1]
    assert pdf.startswith(b"%PDF")
    assert len(re.findall(rb"/Type\s*/Page\b", pdf)) >= 3
    assert b"/Subtype/Image" not in pdf.replace(b" ", b"")


@pytest.mark.parametrize("name", ["evidence.nc", "decision.json"])
def test_missing_results_are_named_and_nothing_is_written(tmp_path, name):
    fake = FakeDiagnosis(tmp_path / "fake", "none")
    (fake.results / name).unlink()
    with pytest.raises(InputError, match=name.replace(".", r"\.")):
        make_diagnosis_report(*fake.arguments(), tmp_path / "a.html", tmp_path / "a.pdf")
    assert not (tmp_path / "a.html").exists()


def test_odds_are_a_row_a_cause_the_most_probable_first(documents):
    (table,) = blocks_of(documents["named"], "table", "odds")
    assert table.rows[0][2] == "the most probable"
    assert "nothing" in [row[0] for row in table.rows]
    assert {row[1] for row in table.rows} <= {"", "effect", "form from outside"}


def test_sizes_that_change_from_test_to_test_are_on_the_first_page_and_others_are_not(documents, pages):
    words = (
        "The edges of joint slab / block-1, by test: inset 10 mm (0 to 20) in alkion-250 and 50 mm (40 to 60) in "
        "basso-200; that is more than a million times likelier than one inset in all tests."
    )
    first = [block.text for block in documents["unknown"].sections[0].blocks if block.kind == "text"]
    assert words in first
    items = blocks_of(documents["unknown"], "items", "history")[0].items
    assert items == (words, "The friction of all joints: one change in all tests is enough.")
    assert ", by test: " not in " ".join(pages["named"][1].split("From test to test")[:1])
