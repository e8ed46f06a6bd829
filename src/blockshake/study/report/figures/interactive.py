"""Displacement of the blocks to zoom into and to read values from, in the page alone; the print has the drawing."""

import base64
import json

from blockshake.pages.drawing import BLACK, GREY, LIGHT_GREY, RED
from blockshake.pages.wording import model_label

_MOST_POINTS = 500  # a curve
_ROW, _HEAD = 150, 110  # pixels of a row, and of titles and axis
_LOOKS = {
    "smallest to largest": {"fill": "tonexty", "fillcolor": LIGHT_GREY, "line": {"width": 1, "color": RED}},
    "5 to 95 %": {"fill": "tonexty", "fillcolor": GREY, "line": {"width": 0}},
}


def interactive_displacements(envelopes, measured, markers, labels, frame, synthetic):
    """JSON of a plotly figure with the curves of `plot_displacements`, whose arguments these are."""
    word = "virtual test (synthetic)" if synthetic else "measured"
    data, axes, last = [], {}, len(markers) - 1
    for row, (marker, label) in enumerate(zip(markers, labels, strict=True)):
        at = {"frame": frame, "marker": marker}
        for column, envelope in enumerate(envelopes.values()):
            place = row * len(envelopes) + column
            own = {"xaxis": f"x{_suffix(place)}", "yaxis": f"y{_suffix(place)}", "showlegend": place == 0}
            data += _band(envelope.sel(axis="x", **at), own)
            if measured is not None and marker in measured["marker"].values:
                curve = measured["displacement"].sel(**at)
                look = {"name": word, "line": {"width": 1.2, "color": BLACK, "dash": "dash"}}
                data.append(_trace(measured["time"], curve, own | look | {"legendgroup": word}))
            along, up = {"showticklabels": row == last}, {"showticklabels": column == 0}
            along |= {"title": {"text": "time [s]"}} if row == last else {}
            along |= {"matches": "x"} if place else {}
            up |= (
                {"matches": f"y{_suffix(place - column)}"}
                if column
                else {"title": {"text": f"{label}<br>[mm]"}}
            )
            axes |= {f"xaxis{_suffix(place)}": along, f"yaxis{_suffix(place)}": up}
    titles = [
        {
            "text": model_label(model), "showarrow": False, "xref": f"x{_suffix(column)} domain", "yref": "paper",
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


def _suffix(place):
    """End of the name of an axis: the first one has none, the second one is number 2."""
    return str(place + 1) if place else ""


def _band(envelope, own):
    """Traces of the bounds and of the quantiles, each lower one before the upper one that fills down to it."""
    bounds, inner = envelope["marker_envelope"], envelope["marker_displacement"]
    pairs = {
        "smallest to largest": (bounds.sel(bound="lower"), bounds.sel(bound="upper")),
        "5 to 95 %": (inner.sel(quantile=0.05), inner.sel(quantile=0.95)),
    }
    traces = []
    for name, (low, high) in pairs.items():
        line = _LOOKS[name]["line"]
        common = own | {"name": name, "legendgroup": name}
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
