import matplotlib.colors
import numpy as np
import pytest
from fake_diagnosis import FakeDiagnosis
from fake_findings import OPEN

from blockshake.diagnosis.laws.findings import LawFinding
from blockshake.diagnosis.verdict.verdict import Estimate
from blockshake.report.diagnosis.content import load_diagnosed
from blockshake.report.diagnosis.figures.atlas import plot_atlas
from blockshake.report.diagnosis.figures.candidates import plot_candidates
from blockshake.report.diagnosis.figures.evidence import plot_constancy, plot_features
from blockshake.report.diagnosis.figures.forces import plot_work
from blockshake.report.diagnosis.figures.joint import plot_joints
from blockshake.report.diagnosis.wording import beyond, estimate_words, place_words, quantity, title_of
from blockshake.report.document.drawing import RED


@pytest.fixture(scope="module")
def found(tmp_path_factory):
    return load_diagnosed(
        *FakeDiagnosis(tmp_path_factory.mktemp("named"), "named", extended=False).arguments()
    )


@pytest.fixture(scope="module")
def joints(found):
    return [str(name) for name in found.misfit["joint"].values]


def test_red_is_what_leaves_the_band_and_nothing_else(found, joints):
    figure = plot_joints(found.misfit, found.readings, OPEN[1], joints, None, "measured")
    axes = figure.axes[0]  # slip of the highest joint
    (red,) = [line for line in axes.lines if matplotlib.colors.same_color(line.get_color(), RED)]
    measured = found.readings["slip"].sel(test=OPEN[1], joint=joints[-1])
    band = found.misfit["slip"].sel(test=OPEN[1], joint=joints[-1])
    outside = (measured < band.sel(quantile=0.05)) | (measured > band.sel(quantile=0.95))
    assert 0 < int(outside.sum()) < outside.size
    np.testing.assert_array_equal(np.isfinite(red.get_ydata()), outside)
    np.testing.assert_allclose(red.get_ydata()[outside], 1e3 * measured[outside])


def test_energy_of_the_joints_stands_beside_that_of_the_draws(found, joints):
    """The mean of the draws and two standard deviations, beyond the end of the test."""
    taken = LawFinding(
        name="joint1.work.taken", unit="J", joint=joints[0], value=0.0, error=0.0, measured={}, errors={},
        expected={OPEN[0]: 3000.0}, spreads={OPEN[0]: 400.0}, departures={}, together=0.0, broken=False,
    )  # fmt: skip
    axes = plot_work(found.forces, (taken,)).axes[0]
    curve = next(line for line in axes.lines if line.get_label() == joints[0])
    history = found.forces["work"].sel(test=OPEN[0], joint=joints[0])
    np.testing.assert_allclose(curve.get_ydata(), 1e-3 * history)
    ((dot, _, (bar,)),) = axes.containers
    assert dot.get_xdata()[0] > float(history["time"].max())
    assert dot.get_ydata()[0] == pytest.approx(3.0)
    np.testing.assert_allclose(bar.get_segments()[0][:, 1], [2.2, 3.8])


def test_horizon_is_shaded_to_the_end(found, joints):
    def shaded(horizon):
        axes = plot_joints(found.misfit, found.readings, OPEN[0], joints, horizon, "measured").axes[0]
        return [patch.get_extents().transformed(axes.transData.inverted()) for patch in axes.patches]

    assert shaded(None) == []
    (area,) = shaded(2.0)
    assert (area.x0, area.x1) == pytest.approx((2.0, float(found.readings["time"][-1])))
    assert shaded(99.0) == []  # predictable to the end


def test_atlas_has_a_number_in_every_cell_beyond_the_limit(found, joints):
    residual = found.misfit["residual"]
    limit = 0.6 * float(np.abs(residual).max())
    lowered = found.misfit.assign(limit=("test", np.full(len(OPEN), limit)))
    figure = plot_atlas(lowered, list(OPEN), joints)
    for axes, test in zip(figure.axes, OPEN, strict=False):
        own = residual.sel(test=test)
        assert len(axes.texts) == int((np.abs(own) > limit).sum())
        image = axes.collections[0].get_array()
        # the uppermost row is the highest joint's slip, its first column the quiet phase's positive side
        first = own.sel(joint=joints[-1], quantity="slip", phase="quiet", side="+")
        assert image[0, 0] == pytest.approx(float(first))
        below = own.sel(joint=joints[-1], quantity="rotation", phase="after", side="-")
        assert image[1, 5] == pytest.approx(float(below))


def test_forest_has_the_placebos_line_and_both_solvers(found):
    rows = found.decision.candidates[:4]
    figure = plot_candidates(rows, [row.key for row in rows], ["table-pitch"], found.decision.placebo)
    axes = figure.axes[0]
    lines = {line.get_label(): line for line in axes.lines}
    assert lines["best of the placebos"].get_xdata()[0] == found.decision.placebo
    np.testing.assert_array_equal(lines["both solvers"].get_xdata(), [row.log_ratio for row in rows])
    np.testing.assert_array_equal(lines["LS-DEM alone"].get_xdata(), [row.by_model["ls-dem"] for row in rows])
    assert len(axes.patches) == 1  # one cause is shaded


def test_features_are_drawn_before_and_after(found):
    rows = found.evidence.isel(row=slice(5))
    axes = plot_features(rows, list("abcde"), "with it").axes[0]
    lines = {line.get_label(): line for line in axes.lines}
    np.testing.assert_array_equal(lines["nominal model"].get_xdata(), rows["nominal"])
    np.testing.assert_array_equal(lines["with it"].get_xdata(), rows["extended"])


def test_sizes_of_each_test_stand_on_an_axis_as_wide_as_the_prior():
    panel = {
        "title": "a", "axis": "b", "tests": ["one", "two"], "estimate": [1.0, 2.0], "lower": [0.5, 1.0],
        "upper": [1.5, 2.5], "all": (1.4, 1.0, 1.8), "ends": (5.0, -5.0),
    }  # fmt: skip
    axes = plot_constancy([panel]).axes[0]
    assert axes.get_xlim() == pytest.approx((-5.4, 5.4))
    assert [label.get_text() for label in axes.get_yticklabels()] == ["one", "two"]
    segments = axes.collections[0].get_segments()
    np.testing.assert_allclose([segment[:, 0] for segment in segments], [[0.5, 1.5], [1.0, 2.5]])


def test_quantities_are_printed_in_units_that_are_read_easily():
    assert quantity(6e-4, "rad s2/m") == "0.600 mrad per m/s²"
    assert quantity(3e-10, "m3/N") == "0.300 mm/MPa"  # 1 m3/N = 1 m/Pa = 1e9 mm/MPa
    assert quantity(1e7, "N/m") == "10 MN/m"
    assert quantity(0.25, "1") == "0.250"
    assert quantity(15.0, "Hz") == "15 Hz"
    assert estimate_words(Estimate(estimate=0.05, lower=0.04, upper=0.06, unit="m")) == "50 (40 to 60) mm"


def test_places_and_exclusions_in_words():
    assert place_words({"joint": ["slab", "block-1"]}) == "joint slab / block-1"
    assert place_words({"body": "block-1", "axis": "+x"}) == "block-1, +x"
    assert place_words({}) == ""
    assert beyond("table-pitch", 3e-4) == "beyond ±0.300 mrad per m/s²"
    assert beyond("weak-joint", 0.6) == "below 0.600"
    assert beyond("reduced-bearing", 0.03) == "beyond 30 mm"
    assert (title_of("clock-lag"), title_of("channel-swap")) == ("lag of the optical clock", "channel swap")
