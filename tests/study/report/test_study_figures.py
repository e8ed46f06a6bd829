import matplotlib
import numpy as np
import pytest
import xarray as xr
from matplotlib.collections import FillBetweenPolyCollection

from blockshake.geometry.structure import load_structure
from blockshake.pages.drawing import svg_of
from blockshake.pages.scene.structure_picture import plot_understood
from blockshake.simulation.models import MODELS
from blockshake.study.ensembles.displacement_figure import plot_displacements
from blockshake.study.report.content import load_content
from blockshake.study.report.motion_figure import plot_spectra
from blockshake.study.sampling.section import bin_count


@pytest.fixture(scope="module")
def case(fake):
    return load_content(fake.study, fake.results).cases["configuration-4"]


def drawn(case, markers, frame):
    envelopes = {model: one.envelope for model, one in case.responses.items()}
    return plot_displacements(envelopes, case.measured, markers, markers, frame, synthetic=True)


def test_each_block_has_a_row_and_each_model_a_column(case):
    figure = drawn(case, ["top-face", "wall-a-1-face"], "slab")
    assert len(figure.axes) == 2 * 4
    assert figure.axes[0].get_ylabel() == "top-face\n[mm]"
    titles = [axes.get_title() for axes in figure.axes[:4]]
    assert [title.partition("\n")[0] for title in titles] == [model.label for model in MODELS.values()]
    assert titles[1] == "NSCD rigid\n5 of 6 samples"
    for number, axes in enumerate(figure.axes):
        # the measured curve, and two bounds, but for a band of a single sample, which has no width
        assert len(axes.lines) == (1 if titles[number % 4].endswith("\n1 of 1 samples") else 3)
        assert sum(isinstance(one, FillBetweenPolyCollection) for one in axes.collections) == 2


@pytest.mark.parametrize("frame", ["inertial", "slab"])
def test_curves_are_those_of_the_files_in_mm(case, frame):
    axes = drawn(case, ["wall-b-4-face"], frame).axes[0]
    at = {"frame": frame, "marker": "wall-b-4-face"}
    envelope = case.responses["ls-dem"].envelope.sel(axis="x", **at)
    lower, upper, measured = (line.get_ydata() for line in axes.lines)
    np.testing.assert_array_equal(lower, 1e3 * envelope["marker_envelope"].sel(bound="lower"))
    np.testing.assert_array_equal(upper, 1e3 * envelope["marker_envelope"].sel(bound="upper"))
    np.testing.assert_array_equal(measured, 1e3 * case.measured["displacement"].sel(**at))
    assert axes.lines[2].is_dashed()


def test_legend_calls_a_virtual_test_synthetic(case):
    labels = [text.get_text() for text in drawn(case, ["top-face"], "slab").legends[0].get_texts()]
    assert "virtual test (synthetic)" in labels


def test_spectrum_of_a_recorded_motion_has_no_target():
    motion = xr.Dataset(
        {"pseudo_acceleration": ("period", [1.0, 2.0])},
        coords={"period": [0.1, 1.0]},
        attrs={"name": "own record", "synthetic": 0},
    )
    axes = plot_spectra([motion]).axes[0]
    assert axes.get_title() == "own record"
    assert len(axes.lines) == 1


def test_svg_says_no_date_loads_nothing_and_leaves_the_style_alone():
    before = dict(matplotlib.rcParams)
    svg = svg_of(plot_understood, load_structure("configuration-1"))
    assert svg.startswith("<svg")
    assert svg == svg_of(plot_understood, load_structure("configuration-1"))
    assert "<metadata>" not in svg
    assert "<text" not in svg  # letters are outlines: the same wherever it is opened
    assert dict(matplotlib.rcParams) == before


def test_histograms_have_about_the_root_of_the_samples_as_bins():
    assert [bin_count(size) for size in (10, 50)] == [5, 9]
