"""Our nonsmooth contact dynamics and a recorded run of LMGC90: one column a structure, difference below."""

import numpy as np

from blockshake.report.document.drawing import BLACK, BLUE, RED, new_figure
from blockshake.report.document.wording import SQUARED, given
from blockshake.study.peer_record import PROGRAMS

_THEIRS = {"color": RED, "linestyle": (0, (4, 2)), "linewidth": 1.0}


def plot_peer(record):
    """Figure of the top block of every history of `load_peer_record` by both programs, and of theirs less ours."""
    figure = new_figure(0.085)
    panels = figure.subplots(
        2, record.sizes["history"], sharex="col", squeeze=False, height_ratios=(1.6, 1.0)
    )
    for (upper, lower), name in zip(panels.T, record["history"].values, strict=True):
        one = record.sel(history=name)
        one = one.isel(time=np.isfinite(one["displacement"]).all("program").to_numpy())
        ours, theirs = (1e3 * one["displacement"].sel(program=program) for program in PROGRAMS)
        upper.plot(one["time"], ours, color=BLACK, label="blockshake")
        upper.plot(one["time"], theirs, **_THEIRS, label="LMGC90, recorded")
        lower.plot(one["time"], 1e3 * one["difference"], color=BLUE)
        upper.set_title(f"{name}, {given(one['acceleration'])} m/s{SQUARED}")
        lower.set_xlabel("time [s]")
        lower.set_xlim(0.0, float(one["time"][-1]))
    panels[0, 0].set_ylabel("top block over the slab\n[mm]")
    panels[1, 0].set_ylabel("LMGC90 less\nblockshake [mm]")
    figure.align_ylabels(panels[:, 0])
    handles, labels = panels[0, 0].get_legend_handles_labels()
    figure.legend(handles, labels, loc="outside upper center", ncols=2)
    return figure
