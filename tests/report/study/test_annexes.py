from fake_study import MODELS
from page import texts

from blockshake.report.document.wording import number
from blockshake.report.study.closing_sections import limits
from blockshake.report.study.content import load_content
from blockshake.report.study.convergence_section import convergence as annex
from blockshake.report.study.peer_section import peer
from blockshake.study.convergence.table import load_convergence
from blockshake.study.peer_record import load_peer_record


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


def test_annex_has_the_recorded_comparison_with_lmgc90_and_its_date(text):
    record = load_peer_record()
    annex = text[text.rindex("Annex: NSCD rigid beside LMGC90") :]
    assert f"side by side on {record.attrs['date']}" in annex
    for case in record["case"].values:
        one = record.sel(case=case)
        theirs, ours = (number(1e6 * one["step_time"].sel(program=name)) for name in ("LMGC90", "blockshake"))
        assert f"{case} {theirs} {ours} {number(one['times_faster'], 2)}" in annex
    nine = record.sel(history="nine blocks")
    peak = 1e3 * float(abs(nine["displacement"].sel(program="LMGC90")).max())
    assert f"{peak:.1f}" in annex
    assert number(1e3 * nine["largest_difference"], 2) in annex


def test_study_without_nscd_has_no_annex_on_lmgc90(fake):
    study = {**fake.study, "models": {"ls-dem": MODELS["ls-dem"]}}
    assert peer(load_content(study, fake.results, fake.logs)) is None
