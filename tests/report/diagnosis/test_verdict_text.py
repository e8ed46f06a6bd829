import json
from dataclasses import replace

import numpy as np
import pytest
import xarray as xr
from fake_diagnosis import FakeDiagnosis
from fake_findings import OPEN, SEALED, gain_finding

from blockshake.diagnosis.verdict.ladder import ONE_OF, PROBABLE
from blockshake.files import write_dataset, write_json
from blockshake.report.diagnosis.content import load_diagnosed
from blockshake.report.diagnosis.report import compose_diagnosis
from blockshake.report.diagnosis.verdict import statement
from blockshake.report.diagnosis.verdict_section import verdict_section


@pytest.fixture(scope="module")
def named(tmp_path_factory):
    return load_diagnosed(*FakeDiagnosis(tmp_path_factory.mktemp("named"), "named").arguments())


def test_a_sensor_fault_alone_is_probable_and_named_without_simulation(tmp_path):
    fake = FakeDiagnosis(tmp_path, "none", findings=[gain_finding()])
    one = load_diagnosed(*fake.arguments())
    assert one.verdict.decision == "named"
    assert statement(one).startswith(
        "Probable: sensor fault: gain of a marker (marker block-2-face), error 0.0300"
    )
    shown = [block for section in compose_diagnosis(one).sections for block in section.blocks]
    items = " ".join(item for block in shown if block.kind == "items" for item in block.items)
    assert "without any simulation" in items
    assert "Excluded, by simulated tests of which nine in ten showed such a size" in items
    assert any(block.kind == "table" and block.caption.startswith("Faults of sensors") for block in shown)


def test_sealed_tests_that_a_sensor_s_gain_was_measured_on_are_not_called_unread(tmp_path):
    fake = FakeDiagnosis(tmp_path, "none", findings=[gain_finding()])
    verdict = json.loads((fake.results / "verdict.json").read_text())
    contrast = {"estimate": 1.0, "lower": 0.9, "upper": 1.0}
    verdict["gain"] = dict.fromkeys(("recalibrated", "nominal", "discrepancy"), contrast)
    write_json(fake.results / "verdict.json", verdict)
    kinds = ["nominal", "extended", "discrepancy"]
    scores = xr.Dataset(
        {"score": (("test", "kind"), np.full((2, 3), 1e-4), {"units": "m"}), "floor": ("test", [1e-5, 1e-5])},
        {"test": list(SEALED), "kind": kinds},
        {"where": "block-2-face"},
    )
    write_dataset(fake.results / "gain.nc", scores)
    document = compose_diagnosis(load_diagnosed(*fake.arguments()))
    (table,) = (
        block for section in document.sections for block in section.blocks
        if getattr(block, "header", ())[-1:] == ("Use",)
    )  # fmt: skip
    uses = {row[0]: row[-1] for row in table.rows}
    assert {uses[name] for name in SEALED} == {"sealed: read for the gain alone"}


def test_a_cause_that_was_not_simulated_is_not_called_an_extended_model(tmp_path):
    fake = FakeDiagnosis(tmp_path, "named", extended=False)
    document = compose_diagnosis(load_diagnosed(*fake.arguments()))
    section = next(one for one in document.sections if one.key == "extension")
    assert section.blocks[0].text.startswith("No extended model was simulated.")


def test_a_set_beside_a_sensor_fault_stays_a_set(tmp_path):
    fake = FakeDiagnosis(tmp_path, "ambiguous", extended=False, findings=[gain_finding()])
    one = load_diagnosed(*fake.arguments())
    assert one.verdict.decision == "combination"
    assert (one.verdict.word, one.verdict.missing) == (ONE_OF, ())
    words = statement(one)
    assert (
        words.index("joint of low friction")
        < words.index("friction that falls")
        < words.index("sensor fault")
    )
    assert "do not tell them apart" in words


def test_without_a_sealed_test_no_cause_is_established(tmp_path):
    one = load_diagnosed(*FakeDiagnosis(tmp_path, "named", extended=False).arguments())
    assert one.verdict.missing == ("no gain was measured on a sealed test",)
    section = next(section for section in compose_diagnosis(one).sections if section.key == "gain")
    assert "no sealed test" in section.blocks[0].text


def test_an_extension_that_loses_is_not_called_established(tmp_path):
    one = load_diagnosed(*FakeDiagnosis(tmp_path, "named", gaining=False).arguments())
    assert one.verdict.word == PROBABLE
    assert any("nothing or a loss" in reason for reason in one.verdict.missing)


@pytest.mark.parametrize(
    ("attributes", "synthetic"),
    [
        ({"synthetic": 1}, True),
        ({"source": "synthetic: computed, not measured"}, True),
        ({"title": "Synthetic shake-table test"}, True),
        ({"synthetic": 0, "title": "test of 3 May", "source": "optical system"}, False),
    ],
)
def test_a_test_is_synthetic_if_its_file_says_so(tmp_path, attributes, synthetic):
    fake = FakeDiagnosis(tmp_path, "none")
    for name in OPEN:
        path = fake.campaign / f"{name}.nc"
        test = xr.load_dataset(path)
        test.attrs = attributes
        test.to_netcdf(path)
    assert load_diagnosed(*fake.arguments()).synthetic is synthetic


def test_what_was_measured_is_not_called_synthetic(named):
    section = verdict_section(replace(named, synthetic=False))
    words = " ".join(block.caption if block.kind == "figure" else "" for block in section.blocks)
    assert not [block for block in section.blocks if block.kind == "text" and "SYNTHETIC" in block.text]
    assert "virtual" not in words
    assert "measured curve" in words
