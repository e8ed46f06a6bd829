"""The plan of a campaign as one call: structure, motions and sensors in, files and a result out."""

import logging
from collections.abc import Sequence
from dataclasses import dataclass

from blockshake.diagnosis.planning.nominal_tests import load_planned
from blockshake.diagnosis.planning.page import matrix_rows, write_plan
from blockshake.diagnosis.planning.plan import Addition, Detectability, plan_of
from blockshake.files import AnyPath, check_output
from blockshake.tables.shown import Shown


@dataclass(frozen=True, repr=False)
class CampaignPlan(Shown):
    """Sizes from which a campaign tells causes apart, and measurements that would add to it."""

    structure: str
    effects: dict[str, Detectability]
    additions: list[Addition]  # the one that separates most pairs first

    def _words(self) -> str:
        return f"{self.structure}: {len(self.effects)} effects, {len(self.additions)} measurements more"

    def _rows(self) -> list[tuple[str, ...]]:
        return matrix_rows(self.effects)


def plan_campaign(
    structure: AnyPath,
    motions: Sequence[str],
    output: AnyPath,
    sensors: AnyPath | None = None,
    duration: float | None = None,
) -> CampaignPlan:
    """Compute which causes motions and sensors would tell apart, and what one measurement more adds.

    Simulates nominal tests; the log states how far it is.

    Parameters
    ----------
    structure : str or path
        As `load_structure` takes it.
    motions : list of str
        A test each, ``NAME`` or ``NAME@SCALE``: a shipped name or a file.
    output : str or path
        Folder for ``plan.json`` and ``plan.html``.
    sensors : str or path, optional
        File of sensors and their noise; by default those of the structure, or usual ones where it has none.
    duration : float, optional
        Of every test; by default its motion's [s].

    Returns
    -------
    CampaignPlan

    Raises
    ------
    InputError
        A file that is wrong, a motion twice, or sensors that show no effect.

    Examples
    --------
    >>> import blockshake
    >>> plan = blockshake.plan_campaign("configuration-1", ["alkion@2.5"], "my-plan", duration=8.0)
    >>> plan.additions[0].pairs >= plan.additions[-1].pairs
    True
    """
    check_output(f"{output}/plan.json")
    planned = load_planned(structure, motions, sensors, duration)
    detectable, additions = plan_of(planned, logging.getLogger("blockshake").info)
    write_plan(output, planned, detectable, additions)
    return CampaignPlan(planned.structure.file.name, detectable, additions)
