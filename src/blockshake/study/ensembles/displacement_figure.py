"""Displacement of the blocks, ensembles beside a measured curve (the paper's Figs. 11 to 14), in print and to zoom."""

import base64
import json

from matplotlib.lines import Line2D
from matplotlib.patches import Patch

from blockshake.pages.drawing import BLACK, GREY, LIGHT_GREY, MEASURED, RED, column_title, new_figure
from blockshake.pages.wording import model_label

# of a curve; in print a fifth of a point apart or more, and finer ones only make files large
_MOST_POINTS = 500
_ROW, _HEAD = 150, 110  # pixels of a row on a screen, and of titles and axis
_LOOKS = {
    "smallest to largest": {"fill": "tonexty", "fillcolor": LIGHT_GREY, "line": {"width": 1, "color": RED}},
    "5 to 95 %": {"fill": "tonexty", "fillcolor": GREY, "line": {"width": 0}},
}


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
        Light grey from the smallest to the largest of the samples, bounds in red, darker grey
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
        entries[_word(synthetic)] = Line2D([], [], **MEASURED)
    figure.legend(entries.values(), entries.keys(), loc="outside upper center", ncols=len(entries))
    return figure


def _word(synthetic):
    """Name of the measured curve."""
    return "virtual test (synthetic)" if synthetic else "measured"


def _draw_ensemble(axes, envelope):
    stride = max(1, envelope.sizes["time"] // _MOST_POINTS)
    thinned = envelope.isel(time=slice(None, None, stride))
    bounds = 1e3 * thinned["marker_envelope"]
    inner = 1e3 * thinned["marker_displacement"]
    for low, high, color in (
        (bounds.sel(bound="lower"), bounds.sel(bound="upper"), LIGHT_GREY),
        (inner.sel(quantile=0.05), inner.sel(quantile=0.95), GREY),
    ):
        axes.fill_between(thinned["time"], low, high, color=color, linewidth=0.0)
    for bound in ("lower", "upper"):
        axes.plot(
            envelope["time"], 1e3 * envelope["marker_envelope"].sel(bound=bound), color=RED, linewidth=0.6
        )


def interactive_displacements(envelopes, measured, markers, labels, frame, synthetic):
    """JSON of a plotly figure with the curves of `plot_displacements`, whose arguments these are."""
    data, axes, last = [], {}, len(markers) - 1
    for row, (marker, label) in enumerate(zip(markers, labels, strict=True)):
        at = {"frame": frame, "marker": marker}
        for column, envelope in enumerate(envelopes.values()):
            index = row * len(envelopes) + column
            panel = {"xaxis": f"x{_suffix(index)}", "yaxis": f"y{_suffix(index)}", "showlegend": index == 0}
            data += _band(envelope.sel(axis="x", **at), panel)
            if measured is not None and marker in measured["marker"].values:
                curve = measured["displacement"].sel(**at)
                look = {"line": {"width": 1.2, "color": BLACK, "dash": "dash"}}
                look |= dict.fromkeys(("name", "legendgroup"), _word(synthetic))
                data.append(_trace(measured["time"], curve, panel | look))
            along, up = {"showticklabels": row == last}, {"showticklabels": column == 0}
            along |= {"title": {"text": "time [s]"}} if row == last else {}
            along |= {"matches": "x"} if index else {}
            up |= (
                {"matches": f"y{_suffix(index - column)}"}
                if column
                else {"title": {"text": f"{label}<br>[mm]"}}
            )
            axes |= {f"xaxis{_suffix(index)}": along, f"yaxis{_suffix(index)}": up}
    titles = [
        {
            "text": column_title(model_label(model), len(envelopes)).replace("\n", "<br>"),
            "showarrow": False, "xref": f"x{_suffix(column)} domain", "yref": "paper",
            "x": 0.5, "y": 1.0, "yanchor": "bottom",
        }
        for column, model in enumerate(envelopes)
    ]  # fmt: skip
    layout = axes | {
        "grid": {"rows": len(markers), "columns": len(envelopes), "pattern": "independent", "xgap": 0.06, "ygap": 0.12},
        "legend": {"orientation": "h", "x": 0.0, "y": 1.0, "yanchor": "top", "yref": "container"},
        "template": {"layout": {"plot_bgcolor": "#fff"}}, "annotations": titles, "hovermode": "x",
        "height": _HEAD + _ROW * len(markers), "margin": {"l": 70, "r": 10, "t": 70, "b": 45}, "font": {"size": 11},
    }  # fmt: skip
    return json.dumps({"data": data, "layout": layout})


def _suffix(index):
    """End of the name of an axis: the first one has none, the second one is number 2."""
    return str(index + 1) if index else ""


def _band(envelope, panel):
    """Traces of the bounds and of the quantiles, each lower one before the upper one that fills down to it."""
    bounds, inner = envelope["marker_envelope"], envelope["marker_displacement"]
    pairs = {
        "smallest to largest": (bounds.sel(bound="lower"), bounds.sel(bound="upper")),
        "5 to 95 %": (inner.sel(quantile=0.05), inner.sel(quantile=0.95)),
    }
    traces = []
    for name, (low, high) in pairs.items():
        line = _LOOKS[name]["line"]
        common = panel | {"name": name, "legendgroup": name}
        traces.append(_trace(envelope["time"], low, common | {"line": line, "showlegend": False}))
        traces.append(_trace(envelope["time"], high, common | _LOOKS[name]))
    return traces


def _trace(time, values, look):
    """A curve [mm] over evenly spaced times, thinned, in single precision."""
    stride = max(1, len(time) // _MOST_POINTS)
    thinned = 1e3 * values.transpose("time").to_numpy()[::stride]
    step = float(time[1] - time[0]) * stride
    return {
        "type": "scatter", "mode": "lines", "x0": float(time[0]), "dx": step,
        "y": {"dtype": "f4", "bdata": base64.b64encode(thinned.astype("<f4").tobytes()).decode()},
        "hovertemplate": "%{y:.2f} mm at %{x:.2f} s", **look,
    }  # fmt: skip
