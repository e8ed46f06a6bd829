"""A force from outside in words: where, when, how large, and the next best forms."""

from blockshake.diagnosis.laws.findings import OutsideForce
from blockshake.report.diagnosis.forces_section import described

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
