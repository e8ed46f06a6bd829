"""The plan as files and as a page: JSON, and one HTML page with the matrix and the ranked additions."""

from blockshake.diagnosis.planning.plan import CAMPAIGNS, OF_ADDITIONS
from blockshake.diagnosis.wording import name_of, named_place, size_words
from blockshake.effects.registry import EFFECTS
from blockshake.files import write_json
from blockshake.pages.blocks import Document, Section, Table, Text, numbered
from blockshake.pages.wording import number, sentence_case
from blockshake.pages.writing import write_html

_SHOWN = 3  # pairs of an addition


def write_plan(folder, planned, detectable, additions):
    """Write ``plan.json`` and ``plan.html`` of what `plan_of` gave."""
    effects = {
        name: {
            "size": EFFECTS[name].parameters[0].name,
            "unit": EFFECTS[name].parameters[0].unit,
            "place": one.place,
            "limits": one.limits,
            "told_apart": {rival: size for rival, size in one.apart.items() if rival},
        }
        for name, one in detectable.items()
    }
    ranked = [
        {**one._asdict(), "separates": [[name, rival or "nothing"] for name, rival in one.separates]}
        for one in additions
    ]
    tests = list(planned.motions)
    plan = {"structure": planned.structure.file.name, "tests": tests, "effects": effects, "additions": ranked}
    write_json(f"{folder}/plan.json", plan)
    write_html(f"{folder}/plan.html", _document(planned, detectable, additions))


def matrix_rows(detectable):
    """Header and rows of the matrix: by rival, the size from which each effect is distinguished from it."""
    rivals = dict.fromkeys([None, *(rival for one in detectable.values() for rival in one.apart)])
    rows = [("distinguished from", *detectable)]
    for rival in rivals:
        cells = [_cell(name, one, rival) for name, one in detectable.items()]
        rows.append(("nothing" if rival is None else name_of(rival), *cells))
    return rows


def _cell(name, one, rival):
    if not one.apart:
        return "not seen"
    if rival == name or (rival is not None and rival not in one.apart):
        return ""
    size = one.apart[rival]
    return "never" if size is None else size_words(size, EFFECTS[name].parameters[0].unit, 2)


def addition_rows(additions):
    """Header and rows of the additions, the one that separates most pairs first."""
    rows = [("one measurement more", "pairs", "separates above all")]
    for one in additions:
        pairs = [
            f"{name_of(name)} from {name_of(rival) if rival else 'nothing'}" for name, rival in one.separates
        ]
        rows.append((one.words, number(one.pairs, 2), "; ".join(pairs[:_SHOWN])))
    return rows


def _document(planned, detectable, additions):
    header, *rows = matrix_rows(detectable)
    bodies = planned.structure.body_names
    places = "; ".join(
        f"{name_of(name)}: {named_place(one.place, bodies)}"
        for name, one in detectable.items()
        if one.place != "all"
    )
    matrix = (
        Text(
            "SYNTHETIC: simulated nominal tests and the information of their rows. No structure was simulated with a "
            "cause in it.",
            strong=True,
        ),
        Table(
            f"Sizes from which each effect (column) is seen, and distinguished from each rival (row), in nine of ten "
            f"campaigns: "
            f"averaged over {CAMPAIGNS} nominal campaigns and the noise of the sensors, with the needs and odds of the "
            "diagnosis. Never: not within the prior of the size. Empty: it shows in other readings, and is "
            "distinguished "
            f"as soon as it is seen. Where the tests tell least of it{f' ({places})' if places else ''}.",
            ("Distinguished from", *(sentence_case(name_of(name))[:-1] for name in header[1:])),
            tuple(rows),
            "l" * len(header),
        ),
    )
    head, *ranked = addition_rows(additions)
    more = Table(
        f"One measurement more, ranked by the pairs that it separates. Pairs: sum over effects of their "
        f"visible size and all rivals of the chance more to tell them apart, mean of {OF_ADDITIONS} nominal campaigns. "
        "Static tests tell of the effect where the tests tell least of it.",
        tuple(sentence_case(words)[:-1] for words in head),
        tuple(ranked),
        "lrl",
        (0.4, 0.1, 0.5),
    )
    sections = (
        Section("Effects that are seen and distinguished", "matrix", matrix),
        Section("One measurement more", "more", (more,)),
    )
    subtitle = f"{planned.structure.file.name}, tests {', '.join(planned.motions)}"
    return numbered(Document("blockshake: plan of a campaign", subtitle, sections))
