from dataclasses import replace

from page import texts

from blockshake.pages.blocks import Heading
from blockshake.study.report.content import load_content
from blockshake.study.report.opening_sections import motions, probability_table, structures


def test_a_structure_of_two_cases_is_shown_once(fake):
    found = load_content(fake.study, fake.results)
    found.cases["stronger"] = replace(found.cases["configuration-1"], name="stronger")
    blocks = structures(found).blocks
    headings = [block.text for block in blocks if isinstance(block, Heading)]
    assert headings[0] == "configuration-1, stronger"
    assert len(headings) == len(fake.study["cases"])


def test_a_record_is_said_with_its_format_and_baseline(fake):
    found = load_content(fake.study, fake.results)
    name = next(iter(found.motions))
    record = {"source": "r.AT2", "format": "PEER NGA AT2", "baseline": "corrected, not at rest"}
    found.motions[name] = found.motions[name].assign_attrs(synthetic=0, **record)
    said = " ".join(texts(motions(found)))
    assert f"{name}: r.AT2 (PEER NGA AT2); baseline: corrected, not at rest." in said


def test_collapse_and_quantiles_are_those_of_the_files_with_limits(fake):
    content = load_content(fake.study, fake.results)
    table = probability_table(content.stripes)
    rows = {row[:2]: row[2:] for row in table.rows}
    # one collapsed and one failed of six: 1 of 5 counts; Clopper and Pearson's limits of 1 and of 2 of 6
    counted, collapse, drift, *_ = rows["configuration-4, top-face", "NSCD rigid"]
    assert counted == "5 + 1 failed"
    assert collapse == "20.0 [0.4, 77.7]"
    assert drift == collapse  # a collapse is a drift beyond all limits, and no other sample drifts by 400 mm
    assert rows["configuration-1, block-3-face", "LS-DEM"][:2] == ("10", "0.0 [0.0, 30.8]")
    envelope = content.cases["configuration-1"].responses["ls-dem"].envelope
    peak = envelope["peak"].sel(frame="slab", marker="block-3-face", quantile=0.5)
    assert rows["configuration-1, block-3-face", "LS-DEM"][3].startswith(f"{1e3 * float(peak):.1f} [")
    # ten samples bear no limits of the quantile 95 %, of which no column is left, and five none of a median
    assert [name for name in table.header if "95" in name] == []
    assert {len(row) for row in table.rows} == {len(table.header)} == {len(table.align)}
    assert rows["configuration-4, top-face", "NSCD rigid"][3] == "none"
    assert "95 % needs 59" in table.caption
