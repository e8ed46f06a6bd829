"""The report's annex on NSCD beside LMGC90, the paper's program: histories, residuals, cost; all of it recorded."""

import json

import numpy as np

from blockshake.report.blocks import Figure, Section, Table, Text
from blockshake.report.drawing import PAGE_WIDTH, svg_of
from blockshake.report.peer_figure import plot_peer
from blockshake.report.wording import given, model_label, number

_TARGET, _GOAL = 3, 10  # times faster


def peer(content):
    """Histories of both programs and what their steps cost; None where the study has no NSCD."""
    if "nscd-rigid" not in content.study["models"]:
        return None
    record = content.peer
    versions, frequency = json.loads(record.attrs["versions"]), given(record.attrs["frequency"])
    blocks = (
        Text(
            f"LMGC90 is the program of Zhou et al. (2023). What stands here is no result of this study: both programs "
            f"were run side by side on {record.attrs['date']} ({record.attrs['machine']}; {record.attrs['lmgc90']}, "
            f"blockshake {versions['blockshake']}, numba {versions['numba']}) and recorded, because a study does not "
            "have LMGC90 at hand. Same shapes, poses, densities, one coefficient of friction (0.75), no restitution, "
            f"a slab moved at {frequency} Hz from rest, a step of {given(1e3 * record.attrs['time_step'])} ms."
        ),
        Figure(
            "Top block with respect to the slab, both programs, and their difference. Three blocks are configuration "
            "1; nine blocks, two walls and a bridging block, are configuration 3.",
            svg_of(plot_peer, record),
            PAGE_WIDTH,
        ),
        _agreement(record),
        Text(
            "How to read it: both programs use Moreau's and Jean's scheme at the same step and share its error in "
            "time, which after the first impact falls only in proportion to the step. Agreement at one step shows that "
            "the same equations are solved, neither that the step is small enough nor that real blocks do this."
        ),
        _cost(record),
        Text(
            "The residual is our measure, put on what LMGC90 reports of its contacts. Where it is far above LMGC90's "
            "usual 1e-4, one step stands out; whether the program or the measure (which gap is reported in a step "
            "where a contact closes) is the cause is not known."
        ),
    )
    return Section(f"Annex: {model_label('nscd-rigid')} beside LMGC90", "peer", blocks)


def _agreement(record):
    rows = []
    for name in record["history"].values:
        one = record.sel(history=name)
        curves = one["displacement"].dropna("time")
        peaks = {
            program: 1e3 * float(np.abs(curves.sel(program=program)).max())
            for program in ("blockshake", "LMGC90")
        }
        rows.append(
            (
                str(name),
                given(curves["time"][-1]),
                number(peaks["blockshake"], 4),
                number(peaks["LMGC90"], 4),
                f"{100.0 * (peaks['LMGC90'] / peaks['blockshake'] - 1.0):.4f}",
                number(1e3 * one["largest_difference"], 2),
            )
        )
    return Table(
        "Peak of the top block, and largest difference of any block at any time.",
        ("Structure", "Time [s]", "Peak [mm]", "LMGC90's [mm]", "Its excess [%]", "Largest difference [mm]"),
        tuple(rows),
        "lrrrrr",
    )


def _cost(record):
    rows = []
    for name in record["case"].values:
        one = record.sel(case=name)
        theirs, ours = one.sel(program="LMGC90"), one.sel(program="blockshake")
        rows.append(
            (
                str(name),
                number(1e6 * theirs["step_time"]),
                number(1e6 * ours["step_time"]),
                number(one["times_faster"], 2),
                f"{float(theirs['residual']):.0e}",
                f"{float(ours['residual']):.0e}",
            )
        )
    return Table(
        f"CPU time of a step, medians of runs in turn on one core, and the worst relative residual of the contact law: "
        f"LMGC90's of the steps looked at, ours of the whole run. Configurations: {given(record.attrs['frequency'])} "
        f"Hz, 1.5 m/s\N{SUPERSCRIPT TWO}; walls at rest. LMGC90's time has in it the copying of contacts by the "
        f"package it comes in. Target: {_TARGET} times faster everywhere, {_GOAL} as the goal.",
        (
            "Case",
            "LMGC90 [\N{MICRO SIGN}s]",
            "blockshake [\N{MICRO SIGN}s]",
            "Times faster",
            "Residual, LMGC90",
            "Residual",
        ),
        tuple(rows),
        "lrrrrr",
    )
