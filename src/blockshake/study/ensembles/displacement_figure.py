"""Displacement of the blocks, ensembles next to a measured curve (the paper's Figs. 11 to 14)."""

from matplotlib.lines import Line2D
from matplotlib.patches import Patch

from blockshake.pages.drawing import GREY, LIGHT_GREY, MEASURED, RED, column_title, new_figure
from blockshake.pages.wording import model_label
from blockshake.study.ensembles.envelope import STILL

_MOST_POINTS = 500  # of a curve; in print a fifth of a point apart or more: finer ones only make files large


def plot_displacements(envelopes, measured, markers, labels, frame, synthetic):
    """Displacement along x over time, one row a marker, one column a model.

    Parameters
    ----------
    envelopes : dict of str to xarray.Dataset
        By model, from `envelope`.
    measured : xarray.Dataset or None
        ``displacement(frame, time, marker)`` [m], along x.
    markers, labels : list of str
        From the top row down: markers, and what the rows are called.
    frame : str
        ``inertial`` or ``slab``.
    synthetic : bool
        The measured curve is a virtual test's.

    Returns
    -------
    matplotlib.figure.Figure
        Light grey from the smallest to the largest of the samples, bounds in red where they part, darker grey
        between the quantiles 5 and 95 %, the measured curve dashed.
    """
    figure = new_figure(0.020 + (0.029 if len(markers) < 6 else 0.0255) * len(markers))
    panels = figure.subplots(len(markers), len(envelopes), sharex=True, sharey="row", squeeze=False)
    for column, (model, envelope) in zip(panels.T, envelopes.items(), strict=True):
        for axes, marker in zip(column, markers, strict=True):
            at = {"frame": frame, "marker": marker}
            _draw_ensemble(axes, envelope.sel(axis="x", **at))
            if measured is not None and marker in measured["marker"].values:
                axes.plot(measured["time"], 1e3 * measured["displacement"].sel(**at), **MEASURED)
        counted, samples = (int(envelope.attrs[name]) for name in ("counted", "samples"))
        words = f"{model_label(model)}\n{counted} of {samples} samples"
        column[0].set_title(column_title(words, len(envelopes)))
        column[-1].set_xlabel("time [s]")
    panels[0, 0].set_xlim(0.0, float(next(iter(envelopes.values()))["time"][-1]))
    for axes, label in zip(panels[:, 0], labels, strict=True):
        axes.set_ylabel(f"{label}\n[mm]")
    figure.align_ylabels(panels[:, 0])
    entries = {
        "smallest to largest": Patch(facecolor=LIGHT_GREY, edgecolor="none"),
        "bounds": Line2D([], [], color=RED, linewidth=0.8),
        "5 to 95 % of the samples": Patch(facecolor=GREY, edgecolor="none"),
    }
    if measured is not None:
        entries["virtual test (synthetic)" if synthetic else "measured"] = Line2D([], [], **MEASURED)
    figure.legend(entries.values(), entries.keys(), loc="outside upper center", ncols=len(entries))
    return figure


def _draw_ensemble(axes, envelope):
    stride = max(1, envelope.sizes["time"] // _MOST_POINTS)
    thinned = envelope.isel(time=slice(None, None, stride))
    bounds = 1e3 * thinned["marker_envelope"]
    inner = 1e3 * thinned["marker_displacement"]
    for low, high, color, edge in (
        (bounds.sel(bound="lower"), bounds.sel(bound="upper"), LIGHT_GREY, 0.0),
        (inner.sel(quantile=0.05), inner.sel(quantile=0.95), GREY, 0.6),  # a closed band is a line
    ):
        axes.fill_between(thinned["time"], low, high, color=color, linewidth=edge)
    width = envelope["marker_envelope"].sel(bound="upper") - envelope["marker_envelope"].sel(bound="lower")
    for bound in ("lower", "upper") if float(width.max()) > STILL else ():  # bounds of a line hide it
        axes.plot(
            envelope["time"], 1e3 * envelope["marker_envelope"].sel(bound=bound), color=RED, linewidth=0.6
        )
