from page import texts

from blockshake.report.study.closing_sections import limits
from blockshake.report.study.content import load_content
from blockshake.report.study.convergence_section import convergence as annex
from blockshake.study.convergence.table import load_convergence


def test_annex_has_the_numbers_of_the_convergence_table_and_marks_defaults(fake, text):
    table = load_convergence(fake.results / "convergence.csv")
    value = table.set_index(["parameter", "setting", "observable"])["value"][
        "node_spacing", 0.2, "peak_drift"
    ]
    row = text[text.index("node spacing 200 mm *") :]
    assert f"{1e3 * value:.2f}" in row[:120]
    assert "grid spacing exact *" in text
    assert "node spacing 50 mm 250000.00" in text  # sink, in micrometres


def test_study_without_convergence_has_no_annex_and_says_so(fake):
    study = {name: value for name, value in fake.study.items() if name != "convergence"}
    content = load_content(study, fake.results, fake.logs)
    assert annex(content) is None
    said = texts(limits(content))
    assert sum("The convergence with time step" in item and "annex" not in item for item in said) == 1


def test_findings_on_numerical_parameters_follow_the_table(fake, document):
    section = next(one for one in document.sections if one.key == "convergence")
    (items,) = [block.items for block in section.blocks if block.kind == "items"]
    assert any("default node spacing of 200 mm differs from the finest setting" in one for one in items)
    content = load_content(fake.study, fake.results, fake.logs)
    residual = content.convergence["observable"] == "energy_residual"
    content.convergence.loc[residual, "value"] = content.convergence.loc[residual, "setting"] ** 2
    (items,) = [block.items for block in annex(content).blocks if block.kind == "items"]
    assert any("goes with the time step to the power 2.0" in one for one in items)
