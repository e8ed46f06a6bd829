"""Impacts in the published sets of drops and tosses: tables of the page that bench/measured.py writes."""

from dataclasses import replace

import numpy as np

from blockshake.measurement.campaigns.campaign import load_campaign
from blockshake.statistics.intervals import quantile_interval
from blockshake_flight.arcs import find_arcs
from blockshake_flight.impacts import find_impacts, impact_law, summary
from blockshake_flight.replay import FlightModel, filmed_replay, start_arc
from blockshake_flight.tracked_test import load_tracked

ELLIPSE = (0.035, 0.025)  # m, half axes
LS_DEM = {
    "parameters": {
        "ls_dem.normal_stiffness": 2e9,
        "ls_dem.shear_stiffness": 1e9,
        "ls_dem.node_spacing": 10.0,
    },
    "time_step": 2e-5,
}
SOLVERS = {"nscd-rigid": (200, {}), "ls-dem": (40, LS_DEM)}  # open tests that are run, and settings


def impacts_table(name, source, evidence):
    """Table of what impacts keep by kind of contact, with intervals of 95 % of the medians, if there are any."""
    kinds, body = evidence["kind"].to_numpy(), name.split("-")[0]
    both = evidence["restitution"].to_numpy(), evidence["ratio"].to_numpy()
    rows = [
        (f"{kind} of the {body}", *(values[kinds == kind] for values in both))
        for kind in ("corner", "edge", "face")
    ]
    if name == "square-drops":
        rows.append(("ellipse", *_ellipse(source).T))
    cells = [
        f"| {words} | {np.isfinite(kept).sum()} | {_median_words(kept)} | {_median_words(ratio)} |"
        for words, kept, ratio in rows
        if np.isfinite(kept).any()
    ]
    if not cells:
        return
    table = [
        "| contact | impacts | restitution | tangential over normal impulse |",
        "| --- | --- | --- | --- |",
    ]
    words = "Impacts by momentum balance: medians with their intervals of 95 %, and quartiles in brackets."
    yield words
    yield "\n".join(table + cells)


def _median_words(values):
    values = values[np.isfinite(values)]
    lower, middle, upper = np.quantile(values, (0.25, 0.5, 0.75))
    low, high = quantile_interval(values, np.array([0.5]))[:, 0]
    sure = f" {low:.2f} to {high:.2f}" if np.isfinite(low) else ""
    return f"{middle:.2f},{sure} ({lower:.2f} to {upper:.2f})"


def _ellipse(source):
    """Restitution and ratio of impulses, (n_impacts, 2), of the impacts of an ellipse that its authors do not doubt.

    States are place, angle and their rates before and after, the angle positive about -y; the contact's arm is what
    the rate of the angle adds to its velocity along the normal and the tangent.
    """
    inertia = np.eye(3) * (ELLIPSE[0] ** 2 + ELLIPSE[1] ** 2) / 4.0
    with np.load(source / "ellipse_impacts.npz") as file:
        sure = ~file["flags"].any(axis=1)
        states, normal, tangent = (file[key][sure] for key in ("states", "normal", "tangent"))
    return np.array([
        impact_law(
            np.array([state[3], 0.0, state[4]]), np.array([state[9], 0.0, state[10]]),
            np.array([0.0, -state[5], 0.0]), np.array([0.0, -state[11], 0.0]),
            np.array([up[2], 0.0, -along[2]]), inertia,
        )
        for state, up, along in zip(states, normal, tangent, strict=True)
    ])  # fmt: skip


def faces_table(folder, gain):
    """Table of what faces that come down in rocking keep: measured, and by both solvers, read by the same program."""
    campaign = load_campaign(folder)
    posed = load_tracked(campaign, list(campaign.open))
    arcs, _ = find_arcs(posed)
    tests = [(test, arc) for test in posed.tests if (arc := start_arc(test, arcs)) is not None]
    own = gain.sel(kind="recalibrated")
    model = FlightModel(
        float(own["friction"]),
        float(own["restitution"]),
        inertia=tuple(np.log(own["inertia"]).to_numpy().tolist()),
    )
    rows = [_faces_row("measured", posed, arcs)]
    for solver, (count, options) in SOLVERS.items():
        runs = [filmed_replay(posed, test, arc, model, solver, **options) for test, arc in tests[:count]]
        again = replace(posed, tests=runs)
        words = f"{solver}, restitution {model.restitution:.2f}, {len(runs)} tests"
        rows.append(_faces_row(words, again, find_arcs(again)[0]))
    return "\n".join([
        "Faces that come down while the body rocks on the ground, by the same reading in all rows: "
        "share that returns to the edge it came from, and spin kept (negative: returned), quartiles. "
        f"LS-DEM has {LS_DEM['parameters']['ls_dem.normal_stiffness']:g} N/m3 and three nodes a side.", "",
        "| | faces | returned | spin kept |", "| --- | --- | --- | --- |", *rows,
    ])  # fmt: skip


def _faces_row(words, posed, arcs):
    own = summary(find_impacts(posed, arcs)).get("face", {})
    if "returned" not in own:
        return f"| {words} | 0 | | |"
    returned, kept = own["returned"], own["kept"]
    return (
        f"| {words} | {returned['count']} | {returned['share']:.0%} | {kept['median']:.2f} "
        f"({kept['lower']:.2f} to {kept['upper']:.2f}) |"
    )
