"""Last page of a diagnosis: what was not tested, what was assumed, and from what files all this comes."""

import numpy as np

from blockshake.dynamics.provenance import provenance
from blockshake.effects.registry import EFFECTS
from blockshake.parity.parity import LEVEL
from blockshake.report.diagnosis.verdict import chance_words
from blockshake.report.diagnosis.wording import title_of
from blockshake.report.document.blocks import Items, Section, Table, Text
from blockshake.report.document.origin import command_blocks, digests_table, versions_table
from blockshake.report.document.units import quantity
from blockshake.report.document.wording import given, number, sentence_case

# of an estimate by its quantity, for a marker or a displacement transducer, and for an accelerometer channel
_UNITS = {
    "place": ("m", "m"), "reference place": ("m", "m"), "slip": ("m", "m"), "drift": ("m/s", "m/s3"),
    "lag": ("s", "s"), "range": ("m", "m/s2"),
}  # fmt: skip
_ROLES = {True: "judged by", False: "left out: the effort allows fewer tests"}


def limits_section(found):
    """Tests, sensors, caveats, effects, assumptions, digests, versions."""
    blocks = [Items(_not_tested(found)), _tests_table(found), Text(_sensors(found)), *_findings(found)]
    if found.verdict.caveats:
        blocks += [Text("Caveats of the verdict:"), Items(tuple(map(sentence_case, found.verdict.caveats)))]
    blocks += [
        *command_blocks(f"snakemake -c2 diagnose --config campaign=FOLDER effort={found.effort}"),
        digests_table(found.digests),
        versions_table(found.versions),
    ]
    return Section("What was not tested, assumptions, origin", "limits", tuple(blocks))


def _not_tested(found):
    considered = found.decision.probabilities
    sensors = [title_of(name) for name, effect in EFFECTS.items() if effect.acts == "observation"]
    removed = [
        title_of(name)
        for name, effect in EFFECTS.items()
        if effect.acts != "observation" and name not in considered
    ]
    motions = [
        f"{name}{' (SYNTHETIC)' if one.get('synthetic') else ''}"
        + (f": {provenance(one)}" if one["source"] != name or one["format"] != "csv" else "")
        for name, one in found.motions.items()
    ]
    items = [
        f"{found.verdict.runs} simulated tests, effort {found.effort}; seeds follow from the names of draws, "
        "candidates and tests, and the same files give the same report.",
        f"Considered: {', '.join(map(title_of, considered))}; by the sensors' checks alone: {', '.join(sensors)}.",
        "Not in the registry, and so never named: cracking and crushing of edges, deformation inside a block, motion "
        "of the foundation beyond pitch and the vertical, wear of joints from test to test, misread time stamps within "
        "a recorder, changes of the structure between tests. If one of these acts, the right answer is 'cause "
        "unknown', and an effect that leaves the same in these data may be named instead.",
        "Assumed: the scatter of the nominal parameters is that of Zhou et al. (2023), Table 2; the two solvers with "
        "their numerics varied span the error of the numerical model; the library's simulated tests and these tests "
        "are exchangeable where nothing is missing. Levels and intervals hold under these assumptions only.",
        "Sizes and intervals are calibrated over the library's sizes together, not at each size.",
    ]
    if motions:
        items.append(
            "Commanded motions, which drive the simulated tests in place of the measured motion of the table: "
            f"{'; '.join(motions)}."
        )
    if removed:
        items.insert(2, f"Taken out of the candidates on purpose: {', '.join(removed)}.")
    if not found.horizon:
        items.append(
            "How long each test can be predicted was not measured, and whole records were judged by their features: "
            "where rocking is chaotic, late features are noise."
        )
    return tuple(items)


def _tests_table(found):
    rows = []
    for test in found.campaign.tests.values():
        use = "sealed: read for the gain alone" if test.role == "sealed" else _ROLES[test.name in found.tests]
        if test.role == "sealed" and found.verdict.gain is None:
            use = "sealed: not read"
        rows.append((test.name, test.motion, given(test.scale), test.role, use))
    header = ("Test", "Motion", "Scale", "Role", "Use")
    words = (
        f"Tests of the campaign {found.campaign.name}. Role, as the campaign says: fit and select are open, to "
        "find the cause by; sealed is kept for the gain."
    )
    return Table(words, header, tuple(rows), "llrll")


def _sensors(found):
    parity = found.parity
    noise = parity.markers["noise"]
    unchecked = noise["marker"].values[np.isnan(noise)].tolist()
    text = (
        f"Sensors' checks, without any simulation: {parity.looked_at} hypotheses on "
        f"{parity.markers.sizes['marker']} markers, {parity.channels.sizes['channel']} accelerometer channels, "
        f"the clocks of {parity.clock.sizes['test']} tests; chance of any false finding {LEVEL:g}. "
    )
    if noise.notnull().any():
        text += f"Noise of the markers {number(1e3 * noise.min(), 2)} to {number(1e3 * noise.max(), 2)} mm. "
    if unchecked:
        text += f"Not checked against others, fewer than three on their body: {', '.join(unchecked)}. "
    lags = np.abs(parity.clock["lag"])
    if lags.size:
        text += f"Largest lag between markers and accelerometers {number(1e3 * lags.max(), 2)} ms. "
    gains = parity.transducers["gain"]
    told, others = (gains["transducer"].values[known].tolist() for known in (gains.notnull(), gains.isnull()))
    if told:
        text += f"Displacement transducers whose gain the markers of their bodies tell: {', '.join(told)}. "
    if others:
        text += (
            f"Displacement transducers whose gain nothing tells, as the markers do not see their ends or these hardly "
            f"moved apart: {', '.join(others)}. "
        )
    if not parity.findings:
        text += "No fault was found."
    return text


def _estimate(finding, channels):
    """Estimate of a finding with its standard error, in the unit of its quantity; by axis where it is a vector."""
    of_marker, of_channel = _UNITS.get(finding.quantity, ("1", "1"))
    unit = of_channel if set(finding.where) <= set(channels) else of_marker
    axes = ("x ", "y ", "z ") if len(finding.estimate) == 3 else ("",)
    return ", ".join(
        f"{axis}{quantity(value, unit)} ({quantity(error, unit, 2)})"
        for axis, value, error in zip(axes, finding.estimate, finding.standard_error, strict=False)
    )


def _findings(found):
    rows = [
        (
            title_of(one.effect),
            ", ".join(one.where),
            one.quantity,
            _estimate(one, found.parity.channels["channel"].values),
            chance_words(one.p).removeprefix("p = ").removeprefix("p "),
            ", ".join(one.tests),
        )
        for one in found.parity.findings
    ]
    if not rows:
        return []
    return [
        Table(
            "Faults of sensors, taken out before anything was simulated; the standard error of each estimate stands in "
            "brackets. The place of a marker or of an end of a displacement transducer is in the frame of its body.",
            ("Fault", "Where", "Quantity", "Estimate", "p", "Tests"),
            tuple(rows),
            "lllrrl",
        )
    ]
