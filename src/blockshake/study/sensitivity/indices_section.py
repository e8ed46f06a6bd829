"""Section on the shares of the variance that the variables have, by a surrogate of the runs."""

import numpy as np

from blockshake.pages.blocks import Section, Table, Text
from blockshake.pages.wording import MISSING, model_label, number, parameter_label

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
    words = (
        "Shares of the variance of a response, by a Gaussian process through its runs. Shapley effects sum to 1 and "
        "part what variables that depend on each other explain together (Owen 2014). The total Sobol index, of "
        "independent variables alone, holds all interactions. Brackets: 95 %, of the surrogate's error and of the "
        "sampling. The surrogate's quality is the share of the variance that it predicts of runs left out one by one, "
        "and of every fifth run by the others. Below 0.7, as near a collapse, the shares cannot be determined."
    )
    heads = ("Case", "Model", "Response", "Left out", "Held out", "Shapley effects", "Total indices")
    return Section("Shares of the variables", "shares", (
        Text(words), Table("The three largest shares of each response.", heads, tuple(rows), "lllrrll"),
    ))  # fmt: skip


def _row(one):
    """Quality of the surrogate, and the largest shares in words."""
    quality = [number(float(one[name]), 2) for name in ("left_out", "held_out")]
    if one["shapley"].isnull().all():
        return *quality, "cannot be determined", MISSING
    return *quality, *(_largest(one, name) for name in ("shapley", "total"))


def _largest(one, name):
    values, limits = one[name].to_numpy(), one[f"{name}_interval"].transpose("parameter", "bound").to_numpy()
    if np.isnan(values).all():
        return "variables depend on each other"
    return "; ".join(
        f"{parameter_label(str(one['parameter'].values[place]))} {values[place]:.2f} "
        f"[{limits[place, 0]:.2f}, {limits[place, 1]:.2f}]"
        for place in np.argsort(-values, kind="stable")[:_SHARES_SHOWN]
    )
