"""Statements on the specimens, the ground motions, the tests and their instruments."""

from itertools import pairwise
from pathlib import Path

from blockshake.dynamics.motion import CHANNELS
from blockshake.geometry.reference_block import reference_body
from blockshake.geometry.structure import load_structure
from blockshake.measurement.campaigns.campaign import load_campaign
from blockshake.measurement.sensors import accelerometers
from blockshake.report.document.wording import given, model_label, number, percent, sentence_case
from blockshake.report.study.statements.statement import against_tests, compared, judged, unjudged
from blockshake.study.ensembles.case_input import MEASURED

HEIGHTS = {"configuration-1": 4.8, "configuration-2": 6.4, "configuration-3": 7.2, "configuration-4": 7.4}
MAKE_UP = {  # walls, blocks and beams, in the text of the section
    "configuration-1": (1, 3, 0),
    "configuration-2": (1, 4, 0),
    "configuration-3": (2, 9, 0),
    "configuration-4": (2, 9, 4),
}
TALLEST, MOST_BLOCKS = 7.6, 9  # m and 1, in the text of the section
PEAKS = {"alkion": 1.176, "basso-tirreno": 1.585}  # m/s2, Table 1
FIRST_LEVEL, INCREMENT = 0.5, 0.25
INSTRUMENTS = {"accelerometers": 21, "displacement transducers": 4, "markers": 101}
_ABOUT = 0.05  # from a step of the levels that is printed with "about"
_SAME = 0.005  # relative difference of two printed numbers that are one and the same


def alike_blocks(content):
    """Blocks of one size with one chamfer."""
    sizes, chamfers = set(), set()
    for case in content.cases.values():
        file = case.structure.file
        material = file.bodies[reference_body(case.structure)].material
        for body in file.bodies:
            if not body.driven and body.material == material:
                shape = file.shapes[body.shape]
                sizes.add(
                    " x ".join(map(given, sorted(shape.box))) + " m" if shape.box else f"mesh {shape.mesh}"
                )
                chamfers.add(shape.chamfer)
    words = f"Sizes of the blocks: {', '.join(sorted(sizes))}; chamfers: {', '.join(map(given, sorted(chamfers)))} m."
    return judged(len(sizes) == 1 and chamfers == {0.02}, words)


def heights(content):
    """Heights in the captions, and the number of blocks."""
    del content
    found = {name: _height(load_structure(name)) for name in HEIGHTS}
    blocks = max(len(_blocks(load_structure(name))) for name in HEIGHTS)
    told = ", ".join(f"{name} {number(height)} m" for name, height in found.items())
    holds = all(abs(found[name] / height - 1.0) < _SAME for name, height in HEIGHTS.items())
    return judged(
        holds and blocks == MOST_BLOCKS, f"Structure files: {told}; at most {blocks} concrete blocks."
    )


def tallest(content):
    """Largest height in the text."""
    del content
    height = max(_height(load_structure(name)) for name in HEIGHTS)
    return judged(
        abs(height / TALLEST - 1.0) < _SAME,
        f"The tallest structure file has {number(height)} m, {number(abs(TALLEST - height), 2)} m off the text; the "
        f"caption of Fig. 4 has {given(max(HEIGHTS.values()))} m, and the files follow the captions.",
    )


def _height(structure):
    """Of the highest point above the lowest free body's foot [m]."""
    points = [
        structure.position[body, 2] + structure.solid(body).vertices[:, 2]
        for body in (~structure.driven).nonzero()[0]
    ]
    return float(max(one.max() for one in points) - min(one.min() for one in points))


def _blocks(structure):
    """Free bodies of the material that most of the free mass is of."""
    bodies = structure.file.bodies
    material = bodies[reference_body(structure)].material
    return [body for body in bodies if not body.driven and body.material == material]


def stoppers(content):
    """Retaining systems that do not interfere."""
    count = sum(len(case.structure.file.stoppers) for case in content.cases.values())
    return unjudged(
        f"The structures of this study have {count} stoppers; readings at the real ones would tell whether they "
        "were touched."
    )


def along_one_axis(content):
    """A table that shakes along one axis."""
    cases = compared(content)
    if not cases:
        return unjudged("This study has no measured test.")
    unread = [case.name for case in cases if case.base.attrs.get("unread")]
    if unread:
        return unjudged(f"No marker reads all axes of the slab of {', '.join(unread)}.")
    told, largest = [], 0.0
    for case in cases:
        moved = abs(case.base["displacement"]).max("time")
        aside = float(max(moved.sel(channel=one) for one in CHANNELS if one not in ("x", "pitch_y")))
        share = aside / float(moved.sel(channel="x"))
        largest = max(largest, share)
        told.append(
            f"{case.name} {percent(share)} %, pitch {number(1e3 * moved.sel(channel='pitch_y'))} mrad"
        )
    words = f"Displacement of the slab across x or upright, over that along x: {'; '.join(told)}."
    return against_tests(cases, largest < 0.05, f"{words} 5 % counts as none.")


def peaks(content):
    """Peak ground accelerations of Table 1."""
    found = {
        name: content.motions[name].attrs["peak_acceleration"] for name in PEAKS if name in content.motions
    }
    if not found:
        return unjudged("This study has none of the two motions.")
    synthetic = [name for name in found if content.motions[name].attrs.get("synthetic")]
    words = ", ".join(f"{name} {number(peak, 4)} m/s2" for name, peak in found.items())
    words = f"Peak accelerations at 100 %: {words}."
    if synthetic:
        return unjudged(f"{words} Synthetic, and scaled to those peaks: {', '.join(synthetic)}.")
    holds = all(abs(peak / PEAKS[name] - 1.0) < _SAME for name, peak in found.items())
    return unjudged(words) if holds and len(found) < len(PEAKS) else judged(holds, words)


def records(content):
    """Histories of Fig. 5."""
    synthetic = sorted(name for name in content.motions if content.motions[name].attrs.get("synthetic"))
    if synthetic:
        return unjudged(
            f"The histories of {', '.join(synthetic)} are synthetic: the records may not be redistributed."
        )
    return unjudged("The paper prints the histories as drawings alone.")


def ladder(content):
    """Levels of the ladder and of the tests, and collapse at the level of the study."""
    settings = content.study["ladder"]
    first, increment = settings["first"], settings["increment"]
    told = []
    for case in content.cases.values():
        for model, one in case.responses.items():
            share, (low, high) = (
                one.envelope["collapse_probability"], one.envelope["collapse_probability_interval"].values,
            )  # fmt: skip
            told.append(
                f"{case.name} at {given(case.settings['scale'])}, {model_label(model)}: {percent(share)} % "
                f"[{percent(low)}, {percent(high)}]"
            )
    limit = settings["largest_drift"]
    drift = f"{given(limit)} m" if limit else "half a block's smaller width"
    words = (
        f"The ladder starts at {given(first)} and rises by {given(increment)}. The paper names no criterion of a "
        f"potential collapse; the ladder ends at a drift of {drift}. Share of the samples that fall at "
        f"the level of the study: {'; '.join(told)}."
    )
    near = f"Steps of {given(INCREMENT - _ABOUT)} to {given(INCREMENT + _ABOUT)} count as about {given(INCREMENT)}."
    if first != FIRST_LEVEL or abs(increment - INCREMENT) > _ABOUT:
        return judged(False, f"{words} {near}")
    cases, holds = compared(content), True
    for case in cases:
        for motion in sorted({test.motion for test in _tests(content, case)}):
            levels = sorted(
                {round(abs(test.scale), 6) for test in _tests(content, case) if test.motion == motion}
            )
            steps = [after - before for before, after in pairwise(levels)]
            holds = (
                holds and levels[0] == FIRST_LEVEL and all(abs(one - INCREMENT) <= _ABOUT for one in steps)
            )
            words += f" Tests of {case.name} by {motion}: {', '.join(map(given, levels))}."
    return against_tests(cases, holds, f"{words} {near}")


def make_up(content):
    """Walls, their blocks and beams."""
    del content
    told, found = [], {}
    for name in MAKE_UP:
        structure = load_structure(name)
        blocks = _blocks(structure)
        lowest = min(structure.position[~structure.driven, 2])
        walls = sum(
            structure.position[structure.body_names.index(body.name), 2] < lowest + 1e-6 for body in blocks
        )
        others = int((~structure.driven).sum()) - len(blocks)
        found[name] = (walls, len(blocks), others)
        told.append(f"{name} {walls}, {len(blocks)} and {others}")
    return judged(
        found == MAKE_UP, f"Walls, concrete blocks and beams of the structure files: {', '.join(told)}."
    )


def low_tests(content):
    """Sinusoidal tests of low intensity between the strong ones."""
    cases = compared(content)
    if not cases:
        return unjudged("This study has no measured test.")
    campaigns = {case.name: load_campaign(case.settings["measured"]["campaign"]) for case in cases}
    found = {
        name: [test for test in campaign.tests.values() if test.motion == "sine"]
        for name, campaign in campaigns.items()
    }
    words = ", ".join(f"{name} {len(tests)}" for name, tests in found.items())
    words = f"Sinusoidal tests in the campaigns: {words}."
    if all(found.values()):
        return unjudged(f"{words} No study reads frequencies or damping from them.")
    return against_tests(cases, False, words)


def instruments(content):
    """Numbers of sensors."""
    files = [case.structure.file for case in content.cases.values()]
    counts = {
        "accelerometers": max(sum(len(sensor.axes) for sensor in file.accelerometers) for file in files),
        "displacement transducers": max(len(file.displacement_transducers) for file in files),
        "markers": max(len(file.markers) for file in files),
    }
    words = ", ".join(f"{name} {counts[name]} of {count}" for name, count in INSTRUMENTS.items())
    return judged(
        all(counts[name] >= count for name, count in INSTRUMENTS.items()),
        sentence_case(f"most channels of a structure file of this study: {words}"),
    )


def rates(content):
    """Rates of the readings and the filter."""
    output = content.study["output_rate"]
    words = (
        f"Accelerometers are read at {given(accelerometers.RATE)} Hz behind a low-pass of "
        f"{given(accelerometers.CUTOFF)} Hz, markers at {given(output)} Hz."
    )
    return judged((accelerometers.RATE, accelerometers.CUTOFF, output) == (512.0, 50.0, 200.0), words)


def measured_input(content):
    """The measured displacement of the slab as the input."""
    inputs = {case.name: case.settings["input"] for case in content.cases.values()}
    words = ", ".join(f"{name} by the {kind} motion" for name, kind in inputs.items())
    if MEASURED in inputs.values():
        words += (
            ". Other than in the paper, the measured displacement is smoothed, has its pitch with it, and is drawn "
            "anew for each sample from its uncertainty, which envelopes hold too"
        )
    return judged(set(inputs.values()) == {MEASURED}, f"The models are driven: {words}.")


def strongest_tests(content):
    """Tests with the largest accelerations."""
    cases = compared(content)
    if not cases:
        return unjudged("This study has no measured test.")
    told, holds = [], True
    for case in cases:
        tests = _tests(content, case)
        peaks = {test.name: abs(test.scale) * _peak(content, test.motion) for test in tests}
        strongest = max(tests, key=lambda test: peaks[test.name])
        chosen, own = case.settings["measured"]["test"], content.peak_acceleration(case)
        holds = holds and own >= (1.0 - _SAME) * peaks[strongest.name]
        words = (
            f"{case.name} {chosen} with {number(own)} m/s2, the strongest of the campaign {strongest.name} "
            f"({strongest.role}) with {number(peaks[strongest.name])} m/s2"
        )
        opened = [test.name for test in tests if test.role != "sealed"]
        if strongest.name not in opened and opened:
            best = max(opened, key=peaks.get)
            words += f", of its open tests {best} with {number(peaks[best])} m/s2"
        told.append(words)
    return judged(holds, f"Commanded peaks: {'; '.join(told)}.")


def _tests(content, case):
    """Tests of a case's campaign by the motions of the study, the case's own among them."""
    tests = load_campaign(case.settings["measured"]["campaign"]).tests.values()
    return [test for test in tests if Path(test.motion).stem in content.motions]


def _peak(content, motion):
    return content.motions[Path(motion).stem].attrs["peak_acceleration"]
