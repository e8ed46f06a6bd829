"""Campaigns of other laboratories, from folder to verdict at quick effort, against what was hidden in them."""

import os
from pathlib import Path

import pytest

from blockshake import diagnose

SHARED = Path(os.environ.get("BLOCKSHAKE_SHARED", Path(__file__).parents[3] / "shared")) / "campaigns"
pytestmark = [
    pytest.mark.slow,
    pytest.mark.skipif(not SHARED.is_dir(), reason="the open campaigns are not at hand"),
]
# decision, effects of the answer, and form from outside; a word of the place of the first
TRUTHS = {
    "abroad-clean-a": ("none", set(), None, ""),
    "abroad-clean-b": ("none", set(), None, ""),
    "abroad-clean-c": ("none", set(), None, ""),
    "uneven-noise": ("none", set(), None, ""),
    "example-clean": ("none", set(), None, ""),
    "loop-clean": ("named", {"table-pitch"}, None, ""),  # its virtual table pitches by 0.02 mrad per m/s2
    "abroad-clock": ("named", {"clock-lag"}, None, ""),
    "abroad-gain": ("named", {"sensor-gain"}, None, "block-3"),
    "abroad-crushing": ("unknown", set(), "changed-edge", "slab"),
    "two-blocks-eccentric": ("named", {"eccentricity"}, None, "block-2"),
    "two-blocks-eccentric-rigid": ("named", {"eccentricity"}, None, "block-2"),
    "example-pitch": ("named", {"table-pitch"}, None, ""),
    "example-edge": ("named", {"reduced-bearing"}, None, "slab"),
    "example-spring": ("named", {"base-compliance"}, None, ""),
    "example-soft-joint": ("named", {"joint-compliance"}, None, "block-1"),
    "example-eccentric": ("named", {"eccentricity"}, None, "block-3"),
    "example-stop": ("named", {"stopper-contact"}, None, "block-3"),
    "example-vertical": ("named", {"vertical-motion"}, None, ""),
    "example-push": ("unknown", set(), "push", "block-2"),
    "example-knock": ("unknown", set(), "blow", "block-3"),
    "example-crushing": ("unknown", set(), "changed-edge", "slab"),
    "example-gain": ("named", {"sensor-gain"}, None, "block-3"),
    "example-gain-eccentric": ("combination", {"sensor-gain", "eccentricity"}, None, ""),
}


@pytest.mark.parametrize("name", TRUTHS)
def test_an_open_campaign_is_answered_as_its_truth_says(name, tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    verdict = diagnose(SHARED / name, tmp_path / "out", "quick", cores=2)
    decision, causes, form, place = TRUTHS[name]
    assert verdict.decision == decision
    assert set(verdict.causes) == causes
    assert (verdict.outside.form if verdict.outside else None) == form
    assert place in str(verdict.model_dump(mode="json"))
