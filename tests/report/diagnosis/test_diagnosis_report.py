import re
from dataclasses import replace
from types import SimpleNamespace

import pytest
from fake_diagnosis import FakeDiagnosis
from fake_findings import CAUSES, OPEN, SEALED, track_record, write_horizons, write_made_up_track_record
from page import CLAIMS, Page, texts

from blockshake.diagnosis.verdict.ladder import ESTABLISHED, NOTHING, ONE_OF, PROBABLE, UNKNOWN
from blockshake.diagnosis.verdict.track_record import procedure_digest
from blockshake.diagnosis.verdict.verdict import load_verdict
from blockshake.errors import InputError
from blockshake.report.diagnosis.content import load_diagnosed
from blockshake.report.diagnosis.limits_section import limits_section
from blockshake.report.diagnosis.report import compose_diagnosis, make_diagnosis_report
from blockshake.report.diagnosis.track_record_section import track_record_section
from blockshake.report.diagnosis.verdict import statement
from blockshake.report.document.blocks import Text
from blockshake.report.document.html import write_html

WORDS = {
    "none": NOTHING,
    "named": ESTABLISHED,
    "ambiguous": ONE_OF,
    "combination": PROBABLE,
    "unknown": UNKNOWN,
}
SECTIONS = [
    "Verdict", "Joint forces",
    "Where the tests depart from the nominal model", "Candidates", "What decided", "The extension",
    "Gain on sealed tests", "Track record of the procedure", "What was not tested, assumptions, origin",
]  # fmt: skip


@pytest.fixture(scope="module")
def fakes(tmp_path_factory):
    """Results of each decision; the named one with a track record and horizons."""
    made = {kind: FakeDiagnosis(tmp_path_factory.mktemp(kind), kind) for kind in CAUSES}
    write_made_up_track_record(made["named"].track_record)
    return made


@pytest.fixture(scope="module")
def found(fakes):
    """Content of the report, by decision; sealed tests' files hold no test, so that opening one would fail."""
    horizons = {"named": write_horizons(fakes["named"].results)}
    return {kind: load_diagnosed(*fake.arguments(), horizons.get(kind, ())) for kind, fake in fakes.items()}


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


@pytest.mark.parametrize("kind", CAUSES)
def test_every_decision_has_a_whole_page(pages, documents, kind):
    page, text = pages[kind]
    assert page.open == []
    assert len(set(page.ids)) == len(page.ids)
    assert set(page.references) <= {f"#{one}" for one in page.ids}
    assert [section.title for section in documents[kind].sections] == SECTIONS
    assert all(text.count(title) >= 2 for title in SECTIONS)  # in the contents and over the section
    blocks = [block for section in documents[kind].sections for block in section.blocks]
    for table in (block for block in blocks if block.kind == "table"):
        assert {len(table.header), len(table.align)} == {len(row) for row in table.rows}, table.caption
    for what in ("figure", "table"):
        counted = [block.number for block in blocks if block.kind == what]
        assert counted == list(range(1, len(counted) + 1))


@pytest.mark.parametrize("kind", CAUSES)
def test_wording_is_that_of_the_ladder_and_claims_no_more(pages, found, kind):
    assert found[kind].verdict.word == WORDS[kind]
    text = pages[kind][1]
    assert statement(found[kind]) in text
    assert statement(found[kind]).lower().startswith(WORDS[kind])
    assert not [claim for claim in CLAIMS if claim in text.lower()]
    for word in set(WORDS.values()) - {WORDS[kind], ONE_OF}:
        assert f"{word}:" not in text.lower()


@pytest.mark.parametrize("kind", CAUSES)
def test_synthetic_is_said_where_it_shows(pages, kind):
    text = pages[kind][1]
    assert "The tests are SYNTHETIC" in text
    assert "virtual test (synthetic)" in text
    assert "alkion (SYNTHETIC): stochastic method" in text


def test_the_box_has_the_numbers_of_the_verdict(fakes, pages):
    verdict, text = load_verdict(fakes["named"].results / "verdict.json"), pages["named"][1]
    coefficient = verdict.parameters["table-pitch"]["coefficient"]
    shown = [f"{1e3 * value:.3f}" for value in (coefficient.estimate, coefficient.lower, coefficient.upper)]
    assert f"coefficient {shown[0]} ({shown[1]} to {shown[2]}) mrad per m/s²" in text
    assert f"p = {verdict.misfit.p:.3f}" in text
    own = verdict.gain.recalibrated
    assert f"{100 * own.estimate:.0f} % ({100 * own.lower:.0f} to {100 * own.upper:.0f} %)" in text


def test_what_was_drawn_from_the_prior_is_not_called_an_estimate_of_the_tests(documents):
    section = next(one for one in documents["named"].sections if one.key == "extension")
    rows = {row[0]: row for block in section.blocks if block.kind == "table" for row in block.rows}
    assert rows["coefficient"][3] == "the tests"
    assert rows["frequency"][3] == "the prior alone"


def test_none_says_which_sizes_are_excluded(pages):
    text = pages["none"][1]
    assert "pitch of the table beyond ±0.270 mrad per m/s²" in text
    assert "joint of low friction below 0.662" in text
    assert "soft joint beyond" not in text  # no size of it would have been seen
    assert "9 of 10" in text


def test_reasons_of_effects_that_are_struck_out_stand_in_words(pages):
    assert "another effect explains more; its best fit leaves too much" in pages["named"][1]
    assert "explains the tests together with the other" in pages["combination"][1]


def test_gain_table_has_the_scores_of_the_file(found, documents):
    gain = found["named"].gain
    section = next(one for one in documents["named"].sections if one.key == "gain")
    scores = next(block for block in section.blocks if block.kind == "table")
    extended = dict(zip(scores.header, next(row for row in scores.rows if row[0] == "extended"), strict=True))
    assert float(extended["Both"]) == pytest.approx(float(gain["score"].sel(kind="extended")), rel=5e-3)
    for test in SEALED:
        own = float(gain["score_of_test"].sel(kind="extended", test=test))
        assert float(extended[test]) == pytest.approx(own, rel=5e-3)


def test_laws_of_sealed_tests_stand_before_and_after(documents):
    section = next(one for one in documents["named"].sections if one.key == "gain")
    (table,) = (block for block in section.blocks if block.kind == "table" and block.header[1:2] == ("Law",))
    assert table.rows == (("sealed-1", "table.pitch", "-9.1", "-8.7", "0.60"),)
    assert "recalibrated: 0.980 (0.880 to 1)" in table.caption


def test_what_the_tests_tell_of_nominal_parameters_is_told_from_what_they_do_not(found, documents):
    (table,) = (
        block for section in documents["named"].sections for block in section.blocks
        if getattr(block, "caption", "").startswith("Parameters of the nominal model")
    )  # fmt: skip
    assert [row[:3] for row in table.rows] == [
        ("friction.concrete.concrete", "LS-DEM", "1"), ("ls_dem.node_spacing", "LS-DEM", "mm"),
        ("friction.concrete.concrete", "NSCD rigid", "1"),
    ]  # fmt: skip
    assert table.rows[0][3:] == ("0.750 (0.600 to 0.900)", "0.675 (0.540 to 0.810)", "0.50")
    assert "materials.concrete.youngs_modulus (NSCD rigid)" in table.caption


def test_the_error_of_a_size_is_that_of_left_out_draws(pages):
    assert "18 draws with it were simulated by each solver" in pages["named"][1]
    assert "draws with it were simulated" not in pages["none"][1]


def test_drift_before_and_after_is_that_of_the_strongest_sealed_test(found, pages):
    own = found["named"].consequences.sel(test=SEALED[-1])
    assert float(own["measured"]) == float(found["named"].consequences["measured"].max())
    before, after = (1e3 * float(own["drift"].sel(kind=kind)) for kind in ("recalibrated", "extended"))
    assert (
        f"On {SEALED[-1]}, which was sealed, the median drift of the top block goes from {before:.0f} mm"
        in pages["named"][1]
    )
    assert f"to {after:.0f} mm" in pages["named"][1]


def test_without_a_cause_no_gain_is_shown(pages):
    assert "No gain was measured" in pages["none"][1]


def test_a_track_record_of_an_earlier_program_is_called_so(pages):
    today = track_record().model_copy(update={"procedure": procedure_digest()})
    of_today = track_record_section(SimpleNamespace(track_record=today, effort="standard"))
    words = "changed since: the track record is that of an earlier one"
    assert words in pages["named"][1]
    assert not any(words in block.text for block in of_today.blocks if isinstance(block, Text))


def test_track_record_prints_its_figures_and_what_it_missed(pages):
    text = pages["named"][1]
    assert "Figures that missed the goal set beforehand: truth named or in the set." in text
    assert "1 of 60" in text
    for one in track_record().shares.values():
        assert f"{one.meaning} {100 * one.hits / one.n:.1f} %" in text
    assert "no track record yet" not in text
    assert "This procedure has no track record yet" in pages["none"][1]


def test_horizon_is_given_where_it_was_measured(pages):
    assert "Shaded: from 2 s on" in pages["named"][1]  # the shorter of both solvers
    assert "How long the test can be predicted was not measured" not in pages["named"][1]
    assert "How long the test can be predicted was not measured" in pages["none"][1]


def test_tests_sensors_and_files_are_accounted_for(pages, found):
    text = pages["named"][1]
    for name in OPEN:
        assert f"{name} alkion 1 fit judged by" in text
    for name in SEALED:
        assert f"{name} alkion 1 sealed sealed: read for the gain alone" in text
    assert "214 hypotheses on" in text
    assert "Not checked against others" in text
    assert "whose gain the markers of their bodies tell: wire-1." in text
    assert "these hardly moved apart: wire-2." in text
    assert found["named"].frozen["digest"] in text
    assert f"decision.json {found['named'].frozen['digest']}" in text
    assert not [path for path in found["named"].digests if any(name in path for name in SEALED)]


def test_html_and_pdf_are_the_same_bytes_again(fakes, tmp_path):
    fake = fakes["unknown"]
    made = []
    for name in "ab":
        paths = tmp_path / f"{name}.html", tmp_path / f"{name}.pdf"
        make_diagnosis_report(*fake.arguments(), *paths)
        made.append([path.read_bytes() for path in paths])
    assert made[0] == made[1]
    pdf = made[0][1]
    assert pdf.startswith(b"%PDF")
    assert len(re.findall(rb"/Type\s*/Page\b", pdf)) >= 5
    assert b"/Subtype/Image" not in pdf.replace(b" ", b"")


def test_missing_results_are_named_and_nothing_is_written(fakes, tmp_path):
    fake = FakeDiagnosis(tmp_path / "fake", "none")
    (fake.results / "misfit.nc").unlink()
    with pytest.raises(InputError, match=r"misfit\.nc"):
        make_diagnosis_report(*fake.arguments(), tmp_path / "a.html", tmp_path / "a.pdf")
    assert not (tmp_path / "a.html").exists()


def test_a_record_that_was_commanded_is_said_with_its_format_and_baseline(found):
    record = {
        "source": "r.AT2", "format": "PEER NGA AT2", "synthetic": False, "assumed": "g of 9.80665 m/s2",
        "baseline": "corrected, not at rest",
    }  # fmt: skip
    said = " ".join(texts(limits_section(replace(found["named"], motions={"r.AT2": record}))))
    assert (
        "r.AT2: r.AT2 (PEER NGA AT2); assumed: g of 9.80665 m/s2; baseline: corrected, not at rest." in said
    )
