"""The section that holds the models against each other states what its files say."""

from dataclasses import replace

import fake_study
import numpy as np
import pytest

from blockshake.simulation.models import MODELS
from blockshake.study.comparison.section import case_words, models
from blockshake.study.comparison.tables import MOVING, block_tables, other_settings_table, pairs_table
from blockshake.study.report.content import load_content

FIRST, LAST = "configuration-1", "configuration-4"


@pytest.fixture
def content(fake):
    return load_content(fake.study, fake.results)


def test_every_block_has_its_numbers_by_every_model(content):
    case = content.cases[FIRST]
    peak, moving = block_tables(case)
    assert [row[0] for row in peak.rows] == ["block-3", "block-2", "block-1"]
    labels = [f"{model.label} (n = {4 if 'elastic' in name else 10})" for name, model in MODELS.items()]
    assert peak.header == ("Block", "Virtual test (synthetic)", *labels)
    at = case.differences.sel(marker="block-3-face", model="ls-dem")
    low, high = (1e3 * float(one) for one in at["peak_interval"])
    assert peak.rows[0][2] == f"{1e3 * float(at['peak']):.1f} [{low:.1f}, {high:.1f}]"
    assert float(at["peak"]) == float(
        case.responses["ls-dem"].envelope["peak"].sel(frame="slab", marker="block-3-face", quantile=0.5)
    )
    # the smallest and the largest of four samples hold the median in 88 of 100 cases: no limits
    assert "which fewer than 6 samples do not bear" in peak.caption
    few = case.differences["peak"].sel(marker="block-3-face", model="nscd-elastic")
    assert f"{1e3 * float(few):.1f}" in peak.rows[0]
    assert "LS-DEM (" not in peak.caption
    # the made-up blocks and the virtual test sway until the end
    assert moving.text.startswith(
        f"{FIRST}: the residual displacement is unknown, for every block moves. Still"
    )


def test_a_residual_is_that_of_a_block_at_rest(content):
    case = content.cases[FIRST]
    for model, one in case.responses.items():
        one.envelope["still_moving"][:] = 0.5 if model == "ls-dem" else 0.4  # of the samples
    case.measured["displacement"][:] = 1e-3 * (np.arange(case.measured.sizes["time"]) % 2)[:, None]  # noise
    _, residual = block_tables(replace(case, marker_noise=2e-4))
    top = case.differences.sel(marker="block-3-face", model="nscd-elastic")
    words = f"{1e3 * float(case.measured['residual'].sel(frame='slab', marker='block-3-face')):.1f}"
    assert residual.rows[0][1] == words
    assert residual.rows[0][2] == MOVING
    assert residual.rows[0][4] == f"{1e3 * float(top['residual']):.1f}"


def test_one_sample_has_medians(content):
    peak, _ = block_tables(content.cases[LAST])
    top = content.cases[LAST].differences["peak"].sel(model="nscd-elastic", marker="top-face")
    assert peak.rows[0][peak.header.index("NSCD elastic (n = 1)")] == f"{1e3 * float(top):.1f}"
    assert "NSCD elastic (" not in peak.caption


def test_every_pair_and_every_model_has_a_row(content):
    assert len(pairs_table(content).rows) == 2 * 6
    rows = {row[:2]: row for row in pairs_table(content).rows}
    assert rows[LAST, "LS-DEM and NSCD elastic"][2:4] == ("none", "none")


def test_pairs_beyond_chance_are_counted(content):
    case = content.cases[FIRST]
    case.differences["distance_chance"][:] = 0.0
    assert "6 of 6 pairs of models have ensembles farther apart" in case_words(case)
    case.differences["distance_chance"][:] = 1.0
    assert "0 of 6 pairs of models have ensembles farther apart" in case_words(case)
    case.differences["distance_chance"][:] = np.nan
    assert f"{FIRST}: too few samples to tell the ensembles of any two models apart." in case_words(case)


def test_a_study_without_tests_has_no_scores_and_one_of_one_model_no_section(fake, content):
    untested = {**fake.study, "cases": [{**case, "measured": None} for case in fake.study["cases"]]}
    assert "scores" in [block.key for block in models(content).blocks if block.kind == "heading"]
    section = models(load_content(untested, fake.results))
    assert "scores" not in [block.key for block in section.blocks if block.kind == "heading"]
    alone = {**fake.study, "models": {"ls-dem": fake.study["models"]["ls-dem"]}}
    assert models(load_content(alone, fake.results)) is None


PRINTED = "ls-dem-as-printed"


@pytest.fixture
def printed(tmp_path, monkeypatch):
    """A made-up study with one solver twice: as printed its blocks sway by a tenth more."""
    settings = {"time_step": 1e-5, "parameters": {"ls_dem.pulling": True}}
    rigid = {name: fake_study.MODELS[name] for name in ("ls-dem", "nscd-rigid")}
    monkeypatch.setattr(fake_study, "MODELS", {**rigid, PRINTED: settings})
    monkeypatch.setattr(fake_study, "STRENGTH", {**fake_study.STRENGTH, PRINTED: 0.9})
    return fake_study.FakeStudy(tmp_path)


def test_every_departure_has_its_price_by_configuration_in_one_table(printed):
    content = load_content(printed.study, printed.results)
    table = other_settings_table(content)
    tops = f"{FIRST}, block-3", f"{LAST}, top"
    assert [row[:3] for row in table.rows] == [(name, "LS-DEM as printed", "10") for name in tops]
    at = content.cases[FIRST].differences.sel(marker="block-3-face")
    _, _, _, peak, change, *_ = table.rows[0]
    assert peak == f"{1e3 * float(at['peak'].sel(model='ls-dem')):.1f}"
    low, high = (1e3 * float(one) for one in at["peak_change_interval"].sel(model=PRINTED))
    assert change == f"{1e3 * float(at['peak_change'].sel(model=PRINTED)):.1f} [{low:.1f}, {high:.1f}]"
    assert table in models(content).blocks
