from dataclasses import replace

from page import texts

from blockshake.pages.blocks import Heading
from blockshake.study.report.content import load_content
from blockshake.study.report.opening_sections import motions, structures


def test_a_structure_of_two_cases_is_shown_once(fake):
    found = load_content(fake.study, fake.results, fake.logs)
    found.cases["stronger"] = replace(found.cases["configuration-1"], name="stronger")
    blocks = structures(found).blocks
    headings = [block.text for block in blocks if isinstance(block, Heading)]
    assert headings[0] == "configuration-1, stronger"
    assert len(headings) == len(fake.study["cases"])


def test_a_record_is_said_with_its_format_and_baseline(fake):
    found = load_content(fake.study, fake.results, fake.logs)
    name = next(iter(found.motions))
    record = {"source": "r.AT2", "format": "PEER NGA AT2", "baseline": "corrected, not at rest"}
    found.motions[name] = found.motions[name].assign_attrs(synthetic=0, **record)
    said = " ".join(texts(motions(found)))
    assert f"{name}: r.AT2 (PEER NGA AT2); baseline: corrected, not at rest." in said
