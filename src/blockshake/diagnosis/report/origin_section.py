"""Last section of a diagnosis: tests, assumptions, and the files and programs from which all this comes."""

from blockshake.dynamics.load_motion import provenance
from blockshake.pages.blocks import Items, Section, Table
from blockshake.pages.origin import command_blocks, digests_table, versions_table
from blockshake.pages.wording import given
from blockshake.pages.words import Words

_TESTED = Words(__name__)


def origin_section(diagnosed):
    """Tests of the campaign, motions, digests, versions."""
    blocks = [
        Items(_assumed(diagnosed)),
        _tests_table(diagnosed),
        *command_blocks(f"snakemake -c2 diagnose --config campaign=FOLDER effort={diagnosed.effort}"),
        digests_table(diagnosed.digests),
        versions_table(diagnosed.versions),
    ]
    return Section("Tests, assumptions, origin", "origin", tuple(blocks))


def _assumed(diagnosed):
    motions = [
        f"{name}{' (SYNTHETIC)' if one.get('synthetic') else ''}"
        + (f": {provenance(one)}" if one["source"] != name or one["format"] != "csv" else "")
        for name, one in diagnosed.motions.items()
    ]
    return _TESTED.items("assumed", diagnosed.verdict.runs, motions, diagnosed.parity.falls)


def _tests_table(diagnosed):
    rows = []
    for test in diagnosed.campaign.tests.values():
        use = "judged by" if test.name in diagnosed.decision.tests else "left out"
        if test.name in diagnosed.decision.silent:
            use += " the slab alone: no joint moved"
        if test.role == "sealed":
            read = diagnosed.verdict.gain or diagnosed.verdict.row_gain
            use = "sealed: read for the skill score alone" if read else "sealed: not read"
        rows.append((test.name, test.motion, given(test.scale), test.role, use))
    words = _TESTED.tests(diagnosed.campaign.name)
    return Table(words, ("Test", "Motion", "Scale", "Role", "Use"), tuple(rows), "llrll")
