"""Section on the shares of the variance that the variables have, by a surrogate of the runs."""

import numpy as np

from blockshake.pages.blocks import Section, Table, Text
from blockshake.pages.wording import MISSING, model_label, number
from blockshake.pages.words import Words

_OF_VARIANCE = Words(__name__)
_SHARES_SHOWN = 3  # variables of a response


def shares(content):
    """Shapley effects and Sobol indices of every case and model; None where no case has runs enough for any."""
    rows = []
    for stripe in content.stripes:
        for model, response in stripe.responses.items():
            for output in response.indices["output"].values:
                one = response.indices.sel(output=output)
                if np.isfinite(one["left_out"]):
                    rows.append((stripe.name, model_label(model), str(output), *_row(one)))
    if not rows:
        return None
    heads = ("Case", "Model", "Response", "Left out", "Held out", "Shapley effects", "Total indices")
    return Section("Shares of the variables", "shares", (
        Text(_OF_VARIANCE.method()), Table(_OF_VARIANCE.table(), heads, tuple(rows), "lllrrll"),
    ))  # fmt: skip


def _row(one):
    """Quality of the surrogate, and the largest shares in words."""
    quality = [number(float(one[name]), 2) for name in ("left_out", "held_out")]
    if one["shapley"].isnull().all():
        return *quality, "cannot be determined", MISSING
    return *quality, *(_largest(one, name) for name in ("shapley", "total"))


def _largest(one, name):
    values, limits = one[name].to_numpy(), one[f"{name}_interval"].transpose("parameter", "bound").to_numpy()
    order = [] if np.isnan(values).all() else np.argsort(-values, kind="stable")[:_SHARES_SHOWN]
    names = one["parameter"].values
    return _OF_VARIANCE.largest([(str(names[at]), values[at], *limits[at]) for at in order])
