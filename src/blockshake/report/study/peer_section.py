"""Annex on NSCD beside LMGC90, the program of the paper: recorded histories, residuals and cost."""

import json

from blockshake.report.document.blocks import Figure, Section, Table, Text
from blockshake.report.document.drawing import svg_of
from blockshake.report.document.units import MICROSECONDS, quantity
from blockshake.report.document.wording import SQUARED, given, model_label, number, share_words
from blockshake.report.study.figures.peer import plot_peer
from blockshake.study.peer_record import GOAL, PROGRAMS, TARGET, largest_residual, speed


def peer(content):
    """Histories of both programs and the cost of their steps; None where the study has no NSCD."""
    if "nscd-rigid" not in content.study["models"]:
        return None
    record = content.peer
    versions, structures = json.loads(record.attrs["versions"]), record["structure"].values
    blocks = (
        Text(
            "LMGC90 is the program of Zhou et al. (2023). This annex is no result of this study: both programs were "
            f"run side by side on {record.attrs['date']} ({record.attrs['machine']}; {record.attrs['lmgc90']}, "
            f"blockshake {versions['blockshake']}, numba {versions['numba']}) and recorded, because LMGC90 is no part "
            "of blockshake. Both have the same shapes, poses, densities and coefficient of friction, no restitution, "
            f"a slab moved at {given(record.attrs['frequency'])} Hz from rest, and a step of "
            f"{quantity(record.attrs['time_step'], 's')}."
        ),
        Figure(
            "Top block relative to the slab by both programs, and the difference: "
            + "; ".join(
                f"{name} are {structure}"
                for name, structure in zip(record["history"].values, structures, strict=True)
            )
            + ".",
            svg_of(plot_peer, record),
        ),
        _agreement(record),
        Text(
            "Both programs use the time-stepping of Moreau and Jean at the same step, and share its error in time. "
            "Agreement at one step tells whether both solve the same equations; it tells neither whether the step is "
            "small enough nor whether real blocks move so."
        ),
        _cost(record),
        Text(_residual_words(record)),
    )
    return Section(f"Annex: {model_label('nscd-rigid')} beside LMGC90", "peer", blocks)


def _agreement(record):
    rows = []
    for name in record["history"].values:
        one = record.sel(history=name)
        end = one["displacement"].dropna("time")["time"][-1]
        peaks = (number(1e3 * one["peak"].sel(program=program), 4) for program in PROGRAMS)
        excess = f"{100.0 * float(one['excess']):.4f}"
        rows.append((str(name), given(end), *peaks, excess, number(1e3 * one["largest_difference"], 2)))
    return Table(
        "Peak of the top block, and largest difference of any block at any time.",
        (
            "Structure",
            "Time [s]",
            "Peak [mm]",
            "Peak, LMGC90 [mm]",
            "Excess, LMGC90 [%]",
            "Largest difference [mm]",
        ),
        tuple(rows),
        "lrrrrr",
    )


def _cost(record):
    rows = []
    for name in record["case"].values:
        one = record.sel(case=name)
        theirs, ours = one.sel(program="LMGC90"), one.sel(program="blockshake")
        rows.append((
            str(name), number(MICROSECONDS.factor * theirs["step_time"]),
            number(MICROSECONDS.factor * ours["step_time"]), number(one["times_faster"], 2),
            f"{float(theirs['residual']):.0e}", f"{float(ours['residual']):.0e}",
        ))  # fmt: skip
    found = speed(record)
    return Table(
        "CPU time of a step, medians of runs in turn on one core, and the largest relative residual of the contact "
        "law: of LMGC90 over the steps looked at, of blockshake over the whole run. Configurations are shaken at "
        f"{given(record.attrs['frequency'])} Hz and 1.5 m/s{SQUARED}, walls are at rest. The time of LMGC90 includes "
        "the copying of contacts by the package that it comes in. The target, "
        f"{given(TARGET)} times faster, is met in {share_words(found.on_target, found.cases)} cases; the goal, "
        f"{given(GOAL)} times, in {share_words(found.on_goal, found.cases)}.",
        (
            "Case", f"LMGC90 [{MICROSECONDS.name}]", f"blockshake [{MICROSECONDS.name}]", "Times faster",
            "Residual, LMGC90", "Residual, blockshake",
        ),
        tuple(rows), "lrrrrr",
    )  # fmt: skip


def _residual_words(record):
    found = largest_residual(record)
    return (
        "The residual of LMGC90 is computed by blockshake from the contacts that LMGC90 reports. It is largest in "
        f"{found.case} ({found.largest:.0e}; median of the cases {found.median:.0e}). The gap that LMGC90 reports in a "
        "step in which a contact closes enters this residual, so that a large one need not be an error of the program."
    )
