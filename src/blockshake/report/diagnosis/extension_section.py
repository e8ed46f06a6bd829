"""Fifth page of a diagnosis: what the extension adds to the model, from the registry."""

from blockshake.diagnosis.libraries.candidates import effect_of
from blockshake.effects.registry import EFFECTS
from blockshake.report.diagnosis.forces_section import FORCE_LAWS
from blockshake.report.diagnosis.verdict import single_size
from blockshake.report.diagnosis.wording import acting, estimate_words, place_words, title_of
from blockshake.report.document.blocks import Heading, Items, Section, Table, Text
from blockshake.report.document.units import interval, quantity, with_unit
from blockshake.report.document.wording import MISSING


def extension_section(found):
    """Equation, parameters, place, source and limits of every cause."""
    verdict = found.verdict
    blocks = [Text(_opening(found))]
    for name in verdict.causes:
        blocks.append(Heading(title_of(name).capitalize(), f"extension-{name}"))
        if name not in EFFECTS:
            blocks.append(
                Text("A sensor fault; it has no model in the registry and was taken out of the readings.")
            )
            continue
        effect = EFFECTS[name]
        place = place_words(verdict.location.get(name, {}))
        confused = ", ".join(title_of(one) for one in effect.confused_with) or "nothing in the registry"
        blocks += [
            Items(
                (
                    f"Equation: {effect.equation}.",
                    f"Acts {acting(name)}{f', at {place}' if place else ''}.",
                    f"Source: {effect.source}.",
                    f"Leaves nearly the same in the data: {confused}; told apart by {effect.told_apart_by}.",
                )
            ),
            _parameters(found, name),
        ]
    if found.size is not None:
        blocks.append(Text(_sized(found)))
    if verdict.causes:
        blocks.append(
            Text(
                "Limits: the equation was tried within its prior only, on these motions, this structure and up to the "
                "intensity of these tests; another form of the same effect would leave nearly the same in the data."
            )
        )
    return Section("The extension", "extension", tuple(blocks))


def _opening(found):
    kind, physical = found.verdict.decision, found.decision.causes
    if kind == "none":
        return "The model was not extended: these tests show nothing that it lacks."
    if kind == "unknown" and found.gain is not None:
        outside = found.verdict.outside
        return (
            f"The cause is unknown. The model was extended by an empirical force on {outside.bodies[0]}, "
            f"{FORCE_LAWS[outside.law]}, as the laws of the joints describe it: an equation of what acts, not a cause."
        )
    if kind == "unknown":
        return "The model was not extended: the cause is unknown, and an extension by a wrong cause misleads."
    if not physical:
        return "The model was not extended: the fault is in the sensors and was taken out of the readings."
    by = f"one effect: {title_of(physical[0])}."
    if kind == "ambiguous":
        by = f"the likeliest of the set ({title_of(physical[0])}); the others are not excluded and stand below."
    if found.decision.decision == "combination":
        by = "both effects together."
    if found.gain is None:
        return f"No extended model was simulated. It would be the nominal one extended by {by}"
    return f"The model was extended by {by}"


def _sized(found):
    name, first = effect_of(found.size.key), EFFECTS[effect_of(found.size.key)].parameters[0]
    error = found.size.error * abs(first.visible - first.null)
    return (
        f"How sure the size of {title_of(name)} is: {found.size.draws} draws with it were simulated by each solver "
        f"and test, and each was judged by the others. The estimates missed the sizes that were simulated by "
        f"{quantity(error, first.unit)} (root mean square)."
    )


def _parameters(found, name):
    informed = {key: value.informed for key, value in found.decision.parameters.get(name, {}).items()}
    rows = []
    for place, item in enumerate(EFFECTS[name].parameters):
        rows.append((
            item.name, item.meaning, *_estimate(found, name, item, place, informed),
            with_unit(interval(item.lower, item.upper, item.unit), item.unit), quantity(item.null, item.unit),
        ))  # fmt: skip
    return Table(
        f"Parameters of {title_of(name)}: estimate with its 90 % interval, what it rests on, prior, value of the "
        "nominal model.",
        ("Parameter", "Meaning", "Estimate", "Rests on", "Prior", "Nominal"),
        tuple(rows),
        "lllllr",
    )


def _estimate(found, name, item, place, informed):
    """Estimate of a parameter, and what it rests on."""
    own = found.verdict.parameters.get(name, {}).get(item.name)
    if own:
        return estimate_words(own), "the tests" if informed.get(item.name, True) else "the prior alone"
    if place == 0 and name in found.decision.sizes:
        return f"about {single_size(found, name)}", "the tests, beside the first effect; no interval"
    return MISSING, "drawn from the prior"
