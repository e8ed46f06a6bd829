import numpy as np
import pytest
from fake_findings import OPEN, SEALED, departures, misfit, responses

from blockshake.diagnosis.gain.section import plot_drift
from blockshake.diagnosis.misfit.figure import plot_misfit
from blockshake.diagnosis.report.answer_section import plot_forces, plot_slab, shown_bodies, shown_tests

BODIES = ("block-1", "block-2", "block-3")


def curves(axes, label):
    return [line for line in axes.get_lines() if line.get_label() == label]


def test_forces_are_drawn_in_kilonewtons_with_gaps_between_movements():
    shown = departures("named", BODIES)
    figure = plot_forces(shown, list(OPEN[1:]), ["block-1"], "a cause", "measured")
    for axes, test in zip(figure.axes, OPEN[1:], strict=True):
        (measured,), (made,) = curves(axes, "measured"), curves(axes, "a cause")
        own = shown.isel(instant=np.flatnonzero(shown["test"] == test)).sel(body="block-1")
        assert axes.get_title() == test
        known = np.isfinite(measured.get_ydata())
        np.testing.assert_allclose(measured.get_ydata()[known], own["measured"] / 1e3)
        assert np.count_nonzero(~known) == 1  # from 3 to 4 s nothing moves
        assert np.nanmin(made.get_ydata()) == -2.0


def test_without_a_cause_nothing_is_drawn_as_explained():
    figure = plot_forces(departures("none", BODIES), [OPEN[1]], ["block-1"], "", "measured")
    assert [text.get_text() for text in figure.legends[0].get_texts()] == ["noise of the sensors", "measured"]


def test_a_body_whose_force_is_another_s_times_a_factor_is_not_drawn_again():
    shown = departures("named", BODIES)
    base = shown["measured"].sel(body="block-1").to_numpy()
    alike = shown.assign(measured=(("instant", "body"), base[:, None] / np.array([1.0, 2.0, 3.0])))
    assert shown_bodies(alike, []) == ["block-1"]
    assert shown_bodies(alike, ["block-3"]) == ["block-3"]
    unlike = alike["measured"].to_numpy().copy()
    unlike[::2, 1] *= -1.0
    assert shown_bodies(alike.assign(measured=(("instant", "body"), unlike)), []) == ["block-1", "block-2"]


def test_a_body_without_rows_is_not_drawn():
    shown = departures("named", BODIES)
    values = shown["measured"].to_numpy().copy()
    values[:, 0] = np.nan
    assert shown_bodies(shown.assign(measured=(("instant", "body"), values)), ["block-1"])[0] != "block-1"


def test_tests_of_few_instants_are_left_out():
    shown = departures("named", BODIES)
    few = shown.isel(instant=[*range(5), *np.flatnonzero(shown["test"] == OPEN[2])])
    assert shown_tests(shown) == list(OPEN[1:])
    assert shown_tests(few) == [OPEN[2]]
    assert shown_tests(few.isel(instant=slice(5))) == [OPEN[1]]  # no other


def test_the_slab_s_rotation_is_drawn_in_milliradians():
    figure = plot_slab(departures("combination", BODIES), "turn", "pitch", "measured")
    assert len(figure.axes) == len(OPEN)
    assert figure.axes[0].get_ylabel() == "rotation [mrad]"
    assert max(curves(figure.axes[0], "pitch")[0].get_ydata()) == pytest.approx(0.5, rel=1e-3)


def test_drift_with_and_without_the_cause_ends_where_it_can_be_predicted():
    gain = responses(["slab-block-1"], "block-3")
    panels = plot_drift(gain, [SEALED[0]], "measured").axes
    titles = ["without the cause", "without the cause, recalibrated", "with the cause"]
    assert [axes.get_title() for axes in panels] == titles
    without, _, with_it = (max(axes.get_lines()[0].get_ydata()) for axes in panels)
    assert with_it == pytest.approx(1.3 * without)
    for axes in panels:
        shade = axes.patches[-1]
        assert shade.get_x() == 4.0


def test_misfit_has_a_panel_a_history_in_its_unit():
    found = misfit(["slab-block-1"], "block-3")
    figure = plot_misfit(found, [(2, 2), (1, 0)], "measured")
    drift, rotation = figure.axes
    assert drift.get_ylabel() == "drift [mm]"
    assert drift.get_title() == f"{OPEN[2]}, block-3"
    assert rotation.get_ylabel() == "rotation [mrad]"
