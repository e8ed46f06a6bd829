"""A force from outside in words: where, when, how large, and the next best forms."""

import pytest
from fake_diagnosis import FakeDiagnosis
from fake_findings import gain_finding

from blockshake.diagnosis.laws.findings import OutsideForce
from blockshake.report.diagnosis.content import load_diagnosed
from blockshake.report.diagnosis.forces_section import described
from blockshake.report.diagnosis.report import compose_diagnosis

PUSH = OutsideForce(
    bodies=("block-2", "block-1"), height=0.8, law="constant", scores={"constant": 0.0, "steady": 41.0, "spring": 4e3},
    amplitude=-1885.0, lower=-1974.0, upper=-1798.0, unit="N", tests={"t3": {"start": 2.7}, "t4": {"start": 2.28}},
)  # fmt: skip


def test_a_push_is_described_with_its_place_time_and_size():
    words = described(PUSH)
    assert "on block-2 or block-1, here 0.80 m above the mass centre of block-2" in words
    assert "constant from an instant on, -1.89 (-1.97 to -1.80) kN, towards -x" in words
    assert "t3: start 2.70 s; t4: start 2.28 s" in words
    assert "steady throughout by 41" in words


def test_a_spring_through_the_mass_centre_has_a_gap_and_no_direction():
    stop = PUSH.model_copy(
        update={"height": 0.0, "law": "spring", "unit": "N/m", "tests": {"t3": {"gap": 0.028, "side": 1.0}}}
    )
    words = described(stop)
    assert "through the mass centre of block-2" in words
    assert "kN/m" in words
    assert "towards" not in words
    assert "t3: gap 28 mm" in words


@pytest.mark.parametrize("findings", [[], [gain_finding()]])
def test_the_gain_of_a_described_force_is_shown_beside_faults_of_sensors_too(findings, tmp_path):
    """The force extends the model though the cause is unknown; the faults are taken out before."""
    fake = FakeDiagnosis(tmp_path, "unknown", findings=findings, force=PUSH)
    found = load_diagnosed(*fake.arguments())
    assert found.verdict.decision == "unknown"
    assert found.verdict.gain == fake.verdict.gain
    assert found.verdict.gain is not None
    section = next(one for one in compose_diagnosis(found).sections if one.key == "gain")
    scores = next(block for block in section.blocks if block.kind == "table")
    assert [row[0] for row in scores.rows][-1] == "extended"
