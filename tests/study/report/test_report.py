import re
import shutil
from dataclasses import replace

import numpy as np
import pytest
import xarray as xr
from fake_inputs import PEAK_ACCELERATION
from fake_study import COLLAPSE_REASON, MODELS
from page import CLAIMS, Page

from blockshake.errors import InputError
from blockshake.files import HOME
from blockshake.pages.blocks import Document, Section, Table, Text, numbered
from blockshake.pages.rows import face_markers
from blockshake.pages.wording import number
from blockshake.pages.writing import write_html, write_pdf
from blockshake.study import analyses
from blockshake.study.calibration.section import calibration
from blockshake.study.report import content
from blockshake.study.report.answer import answer
from blockshake.study.report.content import load_content
from blockshake.study.report.opening_sections import failures
from blockshake.study.report.report import compose, make_report
from blockshake.study.report.result_sections import band_remarks


def test_tags_close_and_ids_are_unique(page):
    assert page.open == []
    assert len(set(page.ids)) == len(page.ids)


def test_head_says_who_and_when_as_stated(text):
    assert "Author: A. <Nobody> Date: 2026-11-23" in text
    assert "Project:" not in text


def test_page_refers_to_nothing_outside_itself(page):
    inside = {f"#{one}" for one in page.ids}
    for reference in page.references:
        assert reference in inside or reference.startswith("data:"), reference
    assert not {"link", "iframe", "object"} & set(page.tags)


def test_style_and_drawings_refer_to_nothing_outside(report, page):
    whole = report[0].read_text(encoding="utf-8")
    html = re.sub(
        r"<script>.*?</script>", "", whole, flags=re.DOTALL
    )  # of programs the browser's console tells
    used = set(re.findall(r"url\(([^)]*)\)", html))
    assert used  # clipped curves are
    assert used <= {f"#{one}" for one in page.ids}
    assert "@import" not in html


@pytest.mark.parametrize(
    "title",
    [
        "Answer", "Cases in figures", "Structures", "Ground motions", "Samples", "Contact stiffness",
        "Displacement of the blocks", "Models against each other", "Causes of the thickness of the envelopes",
        "Origin", "Limits of this study",
    ],
)  # fmt: skip
def test_sections_and_contents(text, title):
    assert text.count(title) >= 2  # in the table of contents and over the section


def test_synthetic_is_said_where_it_shows(report, text):
    assert "The measured curves are SYNTHETIC" in text
    assert "basso-tirreno is a synthetic ground motion, not recorded." in text
    assert "virtual test (synthetic)" in text
    assert not [claim for claim in CLAIMS if claim in text.lower()]


def test_measured_peak_is_that_of_the_simulated_window(fake, tmp_path):
    study = {**fake.study, "cases": [{**fake.study["cases"][0], "duration": 1.0}]}
    case = load_content(study, fake.results).cases["configuration-1"]
    test = xr.load_dataset(f"{study['cases'][0]['measured']['campaign']}/virtual.nc")
    along = test["marker_displacement"].sel(axis="x")
    relative = np.abs(along.sel(marker="block-3-face") - along.sel(marker="slab-face"))
    shown = float(case.measured["peak"].sel(frame="slab", marker="block-3-face"))
    assert shown == float(relative.sel(time=slice(0.0, 1.0 + 1e-9)).max())
    assert shown < float(relative.max())


def test_coverage_never_stands_alone(fake, text):
    compared = xr.load_dataset(fake.results / "comparisons" / "ls-dem" / "configuration-1.nc").sel(
        marker="block-2-face"
    )
    reference = " to ".join(f"{100 * float(end):.0f}" for end in compared["reference"][[0, -1]])
    chance = number(float(compared["curve_probability"]), 2)
    distance = number(float(compared["distance"]), 2)
    assert f"{100 * float(compared['coverage']):.1f} {reference} {distance} {chance}" in text


def test_samples_that_did_not_complete_are_listed_with_their_reason(text):
    assert f"configuration-4 NSCD rigid 2 collapsed 1 {COLLAPSE_REASON}" in text
    assert "configuration-4 NSCD rigid 4 not-converged" in text
    assert "48 runs: 46 completed, 1 collapsed, 0 still falling when the window ended, 1 failed" in text
    assert "Some samples failed for a numerical reason: configuration-4 by NSCD rigid (1 of 6)." in text


def test_fewer_samples_of_a_model_are_said(text):
    assert "NSCD rigid ran 6 of the 10 samples on configuration-4" in text
    assert "NSCD elastic ran 1 of the 10 samples on configuration-4" in text
    assert text.count("Bounds of fewer samples are narrower") == 1
    assert "NSCD elastic: one sample, whose curve is drawn in place of a band." in text


def test_figures_of_motion(text):
    assert f"{2.0 * PEAK_ACCELERATION:.2f}" in text  # scaled by the case


def test_pages_that_the_report_names_are_there(text):
    pages = set(re.findall(r"docs/[\w/.-]+\.md", text))
    assert pages >= {
        "docs/guide/uncertainty.md",
    }
    assert [page for page in pages if not (HOME / page).is_file()] == []


def test_origin_holds_configuration_digests_and_seed(text):
    assert "0123456789ab (blockshake 0.0.7)" in text
    assert "seed: 77" in text
    assert "friction.concrete.concrete" in text
    assert "blockshake study FILE" in text


def test_figures_and_tables_are_counted(document):
    for kind in ("figure", "table"):
        blocks = [block for section in document.sections for block in section.blocks if block.kind == kind]
        assert [block.number for block in blocks] == list(range(1, len(blocks) + 1))
        assert len(blocks) > 8


def test_rows_are_as_long_as_their_header(document):
    tables = [block for section in document.sections for block in section.blocks if block.kind == "table"]
    for table in tables:
        assert {len(table.header), len(table.align)} == {len(row) for row in table.rows}


def test_pdf_has_pages_and_vector_figures(report):
    pdf = report[1].read_bytes()
    assert pdf.startswith(b"%PDF")
    assert len(re.findall(rb"/Type\s*/Page\b", pdf)) > 8
    assert b"CreationDate" not in pdf
    assert b"/Subtype/Image" not in pdf.replace(b" ", b"")


def test_the_first_page_holds_four_cases_by_four_models(fake, tmp_path):
    found = load_content(fake.study, fake.results)
    cases = [
        replace(found.cases[f"configuration-{like}"], name=f"configuration-{number}")
        for number, like in enumerate((1, 1, 4, 4), start=1)
    ]
    first = answer(replace(found, cases={case.name: case for case in cases}))
    sections = first, Section("Second page", "second", (Text("No more."),))
    write_pdf(tmp_path / "a.pdf", numbered(Document("blockshake: study", 30 * "words ", sections)))
    assert len(re.findall(rb"/Type\s*/Page\b", (tmp_path / "a.pdf").read_bytes())) == 2


def test_same_results_same_bytes(document, report, tmp_path):
    again = tmp_path / "fake.html", tmp_path / "fake.pdf"
    write_html(again[0], document)
    write_pdf(again[1], document)
    for first, second in zip(report, again, strict=False):
        assert first.read_bytes() == second.read_bytes()


def test_complete_study_lists_no_sample(fake):
    study = {**fake.study, "cases": fake.study["cases"][:1]}
    assert [block.kind for block in failures(load_content(study, fake.results))] == ["text"]


def test_the_answer_is_first_and_what_nobody_asked_for_is_not_there(document, text):
    assert document.sections[0].key == "answer"
    assert "statement by statement" not in text
    assert "LMGC90" not in text
    assert "Floor, half step" not in text


def test_own_structures_by_rigid_models_need_no_contact_stiffness(copied, monkeypatch):
    for module in (analyses, content):
        monkeypatch.setattr(module, "OF_THE_PAPER", ())
    for name in ("stiffness", "waves"):
        shutil.rmtree(copied.results / name)
    study = {**copied.study, "models": {"nscd-rigid": MODELS["nscd-rigid"]}}
    found = load_content(study, copied.results)
    assert "stiffness" not in {section.key for section in compose(found).sections}


def test_case_alone_needs_and_tells_nothing_of_the_others(copied, tmp_path):
    fake = copied
    others = fake.results.rglob("configuration-1*")
    for path in others:
        path.unlink()
    html, pdf = tmp_path / "case.html", tmp_path / "case.pdf"
    make_report(fake.study, fake.results, html, pdf, "configuration-4")
    assert pdf.read_bytes().startswith(b"%PDF")
    parsed = Page()
    parsed.feed(html.read_text(encoding="utf-8"))
    said = " ".join(" ".join(parsed.words).split())
    assert "blockshake: fake, configuration-4" in said
    assert "blockshake study FILE --case configuration-4" in said
    assert {"answer", "figures", "structures", "responses", "models", "limits", "origin"} <= set(parsed.ids)
    before = said[: said.index("Configuration used")]
    assert "configuration-1" not in before


def test_missing_results_are_named(copied, tmp_path):
    fake = copied
    missing = fake.results / "envelopes" / "ls-dem" / "configuration-1.nc"
    missing.unlink()
    made = [tmp_path / f"a.{kind}" for kind in ("html", "pdf")]
    with pytest.raises(InputError, match=r"envelopes/ls-dem/configuration-1\.nc"):
        make_report(fake.study, fake.results, *made)
    assert not (tmp_path / "a.html").exists()


def test_one_friction_alone_is_said_to_be_the_search_of_the_paper(fake):
    content = load_content(fake.study, fake.results)
    whole = calibration(content).blocks[0].text
    assert "over a range: friction, concrete on concrete; restitution C_res; " in whole
    assert "Zhou" not in whole
    name = "friction.concrete.concrete"
    one = {**content.calibration, "parameters": {name: content.calibration["parameters"][name]}}
    assert (
        "is the search of Zhou et al. (2023)" in calibration(replace(content, calibration=one)).blocks[0].text
    )


def test_the_calibration_says_what_all_tests_tell_and_what_they_do_not(document):
    section = next(section for section in document.sections if section.key == "calibration")
    said = next(block.items for block in section.blocks if block.kind == "items")
    assert said[0].startswith("friction, concrete on concrete: between 0.")
    assert (
        said[1] == "restitution C_res: the tests tell nothing about it; 0.5 is neither borne out nor refused."
    )
    assert said[-1].startswith("2 tests of 2 are synthetic")
    answers, tests = (block for block in section.blocks if block.kind == "table")
    row = dict(zip(answers.header, answers.rows[1], strict=True))
    assert row["NSCD rigid"] == "in none of its tests"
    assert row["All"].startswith("unknown (p ")
    assert "2 of 4 are below 0.05" in tests.caption
    assert "4 runs ended for a numerical reason" in tests.caption
    assert len(tests.rows) == 4


def test_a_study_without_a_calibration_has_no_such_section(fake):
    study = {name: value for name, value in fake.study.items() if name != "calibration"}
    assert calibration(load_content(study, fake.results)) is None


def test_bands_that_are_lines_are_counted(fake):
    case = load_content(fake.study, fake.results).cases["configuration-1"]
    markers = face_markers(case.structure).values()
    assert not band_remarks(case, markers)
    spread = case.responses["nscd-rigid"].sensitivity["spread"]
    spread.loc[{"quantity": "history", "marker": "block-1-face"}] = 1e-6
    (said,) = [block.text for block in band_remarks(case, markers)]
    assert said.startswith("NSCD rigid: the samples of 1 of 3 blocks differ by less")
    assert "close to lines" in said


def test_study_without_measured_tests_tells_of_its_samples_alone(fake):
    study = {**fake.study, "cases": [{**case, "measured": None} for case in fake.study["cases"]]}
    document = compose(load_content(study, fake.results))
    tables = [block for section in document.sections for block in section.blocks if isinstance(block, Table)]
    said = " ".join([table.caption + " ".join(table.header) for table in tables])
    assert "peak displacement along x relative to the slab" in said
    assert "virtual test" not in said
