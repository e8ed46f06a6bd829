"""Section of the report on sensitivities, where the answer is known."""

from dataclasses import replace

import numpy as np
import pytest
import xarray as xr

from blockshake.geometry.structure import load_structure
from blockshake.pages.rows import bodies_by_height, face_markers
from blockshake.study.report.content import load_content
from blockshake.study.sensitivity.figure import plot_sensitivity
from blockshake.study.sensitivity.findings import sentence, shared_words
from blockshake.study.sensitivity.section import sensitivities
from blockshake.study.sensitivity.sensitivity import QUANTITIES

NOISE = 1e-4  # m
FRICTION, VISCOUS = "friction.concrete.concrete", "materials.concrete.viscous_modulus"


def made_up(share=0.6, correlation=-0.7, spread=0.01, level=0.3, shared=0.01):
    """Sensitivity of two blocks to friction, with a control without effect."""
    pairs = ("quantity", "marker", "parameter")
    shape = (len(QUANTITIES), 2, 2)
    first, rank = np.zeros(shape), np.zeros(shape)
    first[..., 0], rank[..., 0] = share, correlation
    rank[0] = np.nan
    levels = np.full(len(QUANTITIES), level)
    result = xr.Dataset(
        {
            "first_order": (pairs, first),
            "first_order_interval": (("bound", *pairs), np.stack([first - 0.1, first + 0.1])),
            "first_order_chance": ("quantity", levels),
            "rank_correlation": (pairs, rank),
            "rank_correlation_interval": (("bound", *pairs), np.stack([rank - 0.2, rank + 0.2])),
            "rank_correlation_chance": ("quantity", np.where(np.arange(len(QUANTITIES)) == 0, np.nan, level)),
            "explained": (("quantity", "marker"), np.full(shape[:2], 0.42)),
            "spread": (("quantity", "marker"), np.full(shape[:2], spread)),
            "used": ("quantity", np.full(len(QUANTITIES), 50)),
            "correlation": (("parameter", "other"), [[1.0, shared], [shared, 1.0]]),
            "control": ("parameter", [0, 1]),
        },
        coords={
            "quantity": list(QUANTITIES), "marker": ["low-face", "high-face"], "parameter": [FRICTION, VISCOUS],
            "bound": ["lower", "upper"],
        },
    )  # fmt: skip
    return result


def test_the_dominating_variable_is_named_with_its_interval_and_the_level_of_chance():
    words = sentence(made_up(), "block-2", "high-face")
    assert "differ by 10 mm" in words
    assert "alone: friction, concrete on concrete 0.60 [0.50, 0.70] (share; chance reaches 0.30)" in words
    assert "follows friction, concrete on concrete -0.70 [-0.90, -0.50]" in words
    assert "explain 42 % of the ranks" in words
    assert "viscous" not in words


def test_a_share_of_too_few_samples_for_limits_stands_without_them():
    few = made_up()
    few["first_order_interval"][:] = np.nan
    words = sentence(few, "block-2", "high-face")
    assert "alone: friction, concrete on concrete 0.60 (share; chance reaches 0.30)" in words


def test_nothing_is_named_within_chance():
    words = sentence(made_up(share=0.2, correlation=0.25), "block-2", "high-face")
    assert "No variable is shown to explain any of that alone" in words
    assert "No variable is shown to steer the peak" in words


def with_sensitivities(fake, **found):
    """Content of the first case alone, with the `sensitivity` of its markers by some models."""
    content = load_content(fake.study, fake.results)
    case = content.cases["configuration-1"]
    markers = {"low-face": "block-1-face", "high-face": "block-3-face"}
    for model, one in zip(list(case.responses), found.values(), strict=False):
        own = one.assign_coords(marker=[markers[name] for name in one["marker"].values])
        own = own.reindex(marker=[*markers.values(), "block-2-face"], fill_value=0.0)
        case.responses[model] = replace(case.responses[model], sensitivity=own)
    responses = dict(list(case.responses.items())[: len(found)])
    return replace(content, cases={case.name: replace(case, responses=responses)})


def test_models_by_which_nothing_is_explained_share_a_line_and_have_no_figure(fake):
    nothing = made_up(share=0.2, correlation=0.25)
    content = with_sensitivities(fake, a=nothing, b=nothing, c=made_up(spread=2.5e-5))
    items, figures = (
        [one for one in sensitivities(content).blocks if one.kind == kind] for kind in ("items", "figure")
    )
    assert items[-1].items == (
        "No variable explains more than chance does: LS-DEM (samples of block-3 differ by 10 mm), "
        "NSCD rigid (samples of block-3 differ by 10 mm).",
        "Nothing is there to explain by NSCD elastic: the samples differ by less than the noise of a marker, 0.100 mm.",
    )
    assert figures == []
    content = with_sensitivities(fake, a=made_up(), b=nothing)
    items, figures = (
        [one for one in sensitivities(content).blocks if one.kind == kind] for kind in ("items", "figure")
    )
    assert items[-1].items[0].startswith("LS-DEM: the samples of block-3 differ by 10 mm")
    assert len(figures) == 2


def test_figure_shows_every_variable_with_interval_and_level():
    figure = plot_sensitivity(
        {"ls-dem": made_up(), "nscd-rigid": made_up(spread=1e-6)},
        {"low": "low-face", "high": "high-face"},
        NOISE,
        "first_order",
    )
    assert len(figure.axes) == 2  # the model whose samples differ, two blocks
    axes = figure.axes[0]
    dots = [line for line in axes.lines if line.get_marker() == "o"]
    assert [tuple(np.ravel(dot.get_xydata())) for dot in dots] == [(0.6, 0.0), (0.0, 1.0)]
    assert [dot.get_markerfacecolor() == "white" for dot in dots] == [False, True]
    band = axes.patches[0]
    assert band.get_x() == pytest.approx(-0.3)
    assert band.get_width() == pytest.approx(0.6)
    assert axes.get_yticklabels()[0].get_text() == "friction, concrete on concrete"
    quiet = {"nscd-rigid": made_up(spread=1e-6)}
    assert plot_sensitivity(quiet, {"low": "low-face"}, NOISE, "first_order") is None


@pytest.mark.parametrize(
    ("shared", "words"),
    [
        (0.2, "no two variables have r squared beyond 0.05"),
        (
            -0.5,
            "1 of 1 pair of variables shares its indices, r squared beyond 0.05: friction, concrete on concrete and "
            "viscous modulus of concrete, r -0.50",
        ),
        (np.nan, "too few completed samples for an index"),
    ],
)
def test_variables_that_share_an_index_are_named(shared, words):
    assert shared_words(made_up(shared=shared)) == words


def test_how_many_samples_an_index_rests_on_stands_beside_it(fake):
    """The made-up configuration 4 by rigid NSCD one of six samples collapsed and one failed."""
    content = load_content(fake.study, fake.results)
    told = next(block.items for block in sensitivities(content).blocks if block.kind == "items")
    assert told[-1].startswith("Too few completed samples for any sensitivity: ")
    assert "configuration-4 by NSCD rigid (4)" in told[-1]
    assert any(words.startswith("configuration-1 by LS-DEM, configuration-1 by NSCD rigid") for words in told)


def test_columns_are_one_body_of_each_height_from_the_lowest():
    structure = load_structure("configuration-3")
    bodies = bodies_by_height(structure, face_markers(structure))
    assert bodies == ["wall-a-1", "wall-a-2", "wall-a-3", "wall-a-4", "top"]
    assert bodies_by_height(structure, face_markers(structure), most=3) == ["wall-a-1", "wall-a-3", "top"]
