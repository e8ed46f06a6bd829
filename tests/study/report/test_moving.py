import base64
import json

import numpy as np
import pytest

from blockshake.study.ensembles.moving import (
    MAGNIFICATIONS,
    moving_samples,
    plot_still,
    usual_magnification,
)
from blockshake.study.ensembles.shown_samples import shown_markers
from blockshake.study.report.content import load_content


@pytest.fixture(scope="module")
def case(fake):
    return load_content(fake.study, fake.results, "configuration-4").cases["configuration-4"]


def unpacked(packed, shape):
    whole = np.frombuffer(base64.b64decode(packed["data"]), dtype="<i2").reshape(shape)
    return np.where(whole == -32768, np.nan, packed["unit"] * whole)


def test_page_has_the_motion_of_the_files(case):
    moving = json.loads(moving_samples(case))
    shown = case.responses["ls-dem"].shown
    bodies = len(case.structure.mass)
    first = unpacked(moving["samples"][0]["shift"], (moving["frames"], bodies, 3))
    np.testing.assert_allclose(first, shown["shift"].isel(sample=0), atol=1e-5)
    read = shown_markers(case.test, shown["time"].to_numpy())
    markers = unpacked(moving["measured"]["shift"], read.shape)
    np.testing.assert_allclose(markers, read, atol=1e-5)


def test_samples_are_named_with_their_model_and_their_end(case):
    labels = [one["label"] for one in json.loads(moving_samples(case))["samples"]]
    assert labels[0].startswith("LS-DEM, sample 4: median, ")
    assert sum("the only sample" in one for one in labels) == 1  # of elastic NSCD
    assert any(one.endswith("collapsed at 1 s") for one in labels) == any(
        "collapsed" in one.shown["status"] for one in case.responses.values()
    )


def test_marker_that_nobody_read_is_not_shown(case):
    read = case.test["marker_displacement"]
    blind = read.where((read["marker"] != "top-face") | (read["time"] < 0.5))
    test = case.test.assign(marker_displacement=blind)
    row = list(test["marker"].values).index("top-face")
    moving = json.loads(moving_samples(type(case)(**{**vars(case), "test": test})))
    shift = unpacked(moving["measured"]["shift"], (moving["frames"], test.sizes["marker"], 3))
    assert np.isfinite(shift[0, row]).all()
    assert np.isnan(shift[-1, row]).all()


def test_still_has_a_panel_for_every_model_with_markers(case):
    figure = plot_still(case)
    assert [axes.get_title().split("\n")[0] for axes in figure.axes] == [
        "LS-DEM", "NSCD rigid", "NSCD elastic", "NSCD viscoelastic",
    ]  # fmt: skip
    assert all(len(axes.lines) == 1 and len(axes.collections) == 1 for axes in figure.axes)
    assert usual_magnification(case) in MAGNIFICATIONS


def test_case_without_a_test_has_blocks_alone(fake):
    study = {**fake.study, "cases": [{**case, "measured": None} for case in fake.study["cases"]]}
    untested = load_content(study, fake.results, "configuration-1").cases["configuration-1"]
    assert json.loads(moving_samples(untested))["measured"] is None
    assert not any(axes.lines for axes in plot_still(untested).axes)
