"""Real measurements through the whole loop, and their part of the page docs/results/measured.md.

``python bench/measured.py SHARED [--halves 10]`` makes campaigns of the published sets that lie in SHARED/measured by
``examples/measured_flights.py``, diagnoses each as a user would, decides on further random halves, and writes its part
of the page with the figures. A set that is not there is left out.
"""

import argparse
import datetime
import subprocess
import sys
import tempfile
import textwrap
from dataclasses import replace
from pathlib import Path

import numpy as np
import xarray as xr
from measured_impacts import faces_table, impacts_table
from scipy.spatial.transform import Rotation

import blockshake
from blockshake.diagnosis.answer.decision import load_decision
from blockshake.diagnosis.steps import decide
from blockshake.files import load_json, write_text
from blockshake.measurement.campaigns.campaign import load_campaign
from blockshake.pages.drawing import BLUE, GREEN, GREY, ORANGE, save_picture
from blockshake.pages.wording import sentence_case
from blockshake_flight.arcs import find_arcs, noise_of
from blockshake_flight.causes import CAUSES
from blockshake_flight.evidence import FlightFit
from blockshake_flight.figure import plot_accelerations, plot_errors
from blockshake_flight.gain import halves_words
from blockshake_flight.replay import FlightModel, filmed_replay, start_arc
from blockshake_flight.tracked_test import load_tracked
from blockshake_flight.tumbling import tumbling

ROOT = Path(__file__).parents[1]
PAGE = ROOT / "docs" / "results" / "measured.md"
TITLES = {cause.name: cause.title for cause in CAUSES}
COLORS = {"nominal": GREY, "recalibrated": ORANGE, "discrepancy": GREEN, "extended": BLUE}
SETS = {
    "square-drops": (
        "Drops of a square",
        "A square of 60 mm falls between guides onto a flat ground and is filmed in its plane at 250 Hz (Fazeli and "
        "others; published with DAIRLab/ImpactModeling, BSD-3-Clause). Neither its mass nor its depth was published: "
        "the rate of a drag does not depend on them, its damping does. The campaign's mass, friction of 0.3 and "
        "no restitution are guesses.",
        0.06,
    ),
    "cube-tosses": (
        "Tosses of a cube",
        "An acrylic cube of 104.8 mm and 0.37 kg is tossed onto a table and tracked by tags at 148 Hz (Pfrommer, Halm "
        "and Posa 2020, arXiv:2009.11193, BSD-3-Clause). Its authors state moments of inertia of 1.2 times those of "
        "an even cube, alike about all axes, friction of 0.18 and a restitution of 0.125; the campaign states none of "
        "these, and its friction of 0.3 without restitution is a guess.",
        0.1048,
    ),
}
STATED_NOISE = {"square-drops": 5e-5}  # m, of a coordinate, as the data's README states
# mean and standard deviation over 550 tosses with each simulator's own fit, as two public repositories quote the paper
PUBLISHED = (
    "Acosta, Yang and Posa (2022, IEEE RA-L 7(3), arXiv:2110.00541) report for 550 tosses, each simulator with "
    "its own fit, 13.5 +- 8.2 % of the width and 16.5 +- 20.0 degrees (Drake), 14.9 +- 8.9 % and 16.5 +- 20.2 "
    "degrees (Bullet), 25.1 +- 10.8 % and 21.7 +- 21.4 degrees (MuJoCo), as two public repositories quote them."
)


def main(arguments):
    """Write the part of the page."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("shared", type=Path)
    parser.add_argument(
        "--halves", type=int, default=10, help="random halves that are decided on given the first"
    )
    options = parser.parse_args(arguments)
    parts = [made_by()]
    with tempfile.TemporaryDirectory() as folder:
        for name in SETS:
            source = options.shared / "measured" / name
            if source.is_dir():
                parts.append(_part(name, source, Path(folder), options.halves))
    put_section("flights", "\n\n".join(parts))


def put_section(name, text):
    """Put a part of the page that a command writes in place of the one before."""
    begin, end = (f"<!-- {name}: {word} -->" for word in ("begin", "end"))
    before, _, rest = PAGE.read_text(encoding="utf-8").partition(begin + "\n")
    write_text(PAGE, f"{before}{begin}\n{wrapped(text)}\n{end}{rest.partition(end)[2]}")


def made_by():
    """Sentence on the commit of the program that made a page."""
    asked = ["git", "-C", str(ROOT), "describe", "--always", "--abbrev=8", "--dirty", "--exclude=*"]
    commit = subprocess.run(asked, check=True, capture_output=True, text=True).stdout.strip()
    return f"The program was that of commit {commit}."


def wrapped(text):
    """Paragraphs and items of a page in lines of at most 99 signs."""
    lines = []
    for line in text.splitlines():
        after = "  " if line.startswith("- ") else ""
        plain = line.startswith(("|", "#", "![", "```"))
        lines += (
            [line]
            if plain or not line
            else textwrap.wrap(line, 99, subsequent_indent=after, break_on_hyphens=False)
        )
    return "\n".join(lines)


def make_campaign(name, source, target, seed):
    """Folder of a campaign of a published set, half of its tests open; ``target`` is made."""
    command = [
        sys.executable,
        str(ROOT / "examples" / "measured_flights.py"),
        name,
        str(source),
        str(target),
        str(seed),
    ]
    subprocess.run(command, check=True)
    return target


def _part(name, source, folder, halves):
    title, about, width = SETS[name]
    campaign, output = make_campaign(name, source, folder / name, 1), folder / f"{name}-output"
    verdict = blockshake.diagnose(campaign, output, effort="quick")
    decision, gain = load_decision(output / "decision.json"), xr.load_dataset(output / "gain.nc")
    evidence = xr.load_dataset(output / "evidence.nc")
    shown = [axis for axis in "xyz" if np.ptp(evidence["velocity"].sel(axis=axis).to_numpy()) > 0.0]
    save_picture(PAGE.parent / f"{name}-flights.png", plot_accelerations, evidence, shown)
    save_picture(PAGE.parent / f"{name}-errors.png", plot_errors, gain, COLORS)
    others = [
        decide(make_campaign(name, source, folder / f"{name}-{seed}", seed), []).decision
        for seed in range(2, 2 + halves)
    ]
    lines = [
        f"### {title}, {datetime.date.today().isoformat()}", about,
        f"{len(decision.tests)} open and {gain.sizes['test']} predicted sealed tests. The verdict: "
        f"**{verdict.decision}** ({verdict.word}).",
        "\n".join(f"- {line}" for line in causes_in_words(decision, TITLES)),
        f"![acceleration beyond gravity over velocity]({name}-flights.png)",
        *_noise(name, evidence.attrs["noise"]),
        _gains(load_json(output / "verdict.json")), sentence_case(halves_words(gain["of_halves"].to_numpy())),
        "\n".join([_errors(gain, width), _started_again(campaign, decision, gain, width)]),
        f"![errors on sealed tests]({name}-errors.png)",
        _of_halves(others),
        *impacts_table(name, source, evidence),
    ]  # fmt: skip
    if name == "cube-tosses":
        lines.append(PUBLISHED)
    else:
        lines.append(faces_table(campaign, gain))
    return "\n\n".join(lines)


def _noise(name, noise):
    """Sentence on the noise next to the stated one, where one is."""
    if name in STATED_NOISE:
        share = noise / STATED_NOISE[name]
        yield f"Noise of a coordinate in flight: {1e3 * noise:.3g} mm, {share:.2f} of the stated one."


def causes_in_words(decision, titles):
    """A line a cause: sizes with intervals of 90 %, gain and odds; ``titles``: words by name."""
    for part in decision.parts:
        for cause in part.causes:
            sizes = ", ".join(
                f"{name} {one.estimate:.3g} ({one.lower:.3g} to {one.upper:.3g}) {one.unit}"
                for name, one in cause.parameters.items()
            )
            odds = (
                ""
                if cause is part.causes[0]
                else f"; less likely by {np.exp(cause.odds):.2g} times, not distinguished"
            )
            yield f"{titles[cause.name]}: {sizes}; gain {cause.gain:.0f} nats{odds}"


def _gains(verdict):
    rows = ["| rival | gain on sealed paths | interval of 90 % |", "| --- | --- | --- |"]
    for rival in ("nominal", "recalibrated", "discrepancy"):
        one = verdict["gain"][rival]
        rows.append(f"| {rival} | {one['estimate']:.1%} | {one['lower']:.1%} to {one['upper']:.1%} |")
    one = verdict["row_gain"]["recalibrated"]
    rows.append(
        f"| nothing, on the sealed flights alone | {one['estimate']:.1%} | {one['lower']:.1%} to {one['upper']:.1%} |"
    )
    return "\n".join(rows)


def _errors(gain, width):
    rows = [
        "| model | friction | restitution | inertia | early [mm] | path [% of the width] | rotation [degrees] |",
        "| --- | --- | --- | --- | --- | --- | --- |",
    ]
    for kind in gain["kind"].values:
        own = gain.sel(kind=kind)
        inertia = float(np.exp(np.log(own["inertia"]).mean()))
        rows.append(
            f"| {kind} | {float(own['friction']):.3g} | {float(own['restitution']):.2f} | {inertia:.2f} | "
            f"{_error_cells(own['early'], own['place'], own['turn'], width)} |"
        )
    return "\n".join(rows)


def _error_cells(early, place, turn, width):
    values = early * 1e3, place * 100.0 / width, np.degrees(turn)
    return " | ".join(f"{float(np.mean(one)):.1f} +- {float(np.std(one)):.1f}" for one in values)


def _started_again(folder, decision, gain, width):
    """Row of the errors that the extended model has against itself, started within the error of the start.

    At most 60 open tests run once from their first flight and once from that flight with the noise of its readings
    added again, of places and of rotations: no model can be expected to predict the tests better than that.
    """
    campaign = load_campaign(folder)
    posed = load_tracked(campaign, list(campaign.open))
    arcs, _ = find_arcs(posed)
    noise, turned = noise_of(arcs), np.sqrt(np.mean([_turn_noise(posed, arc) ** 2 for arc in arcs]))
    by_name = {cause.name: cause for cause in CAUSES}
    fits = [
        FlightFit(by_name[one.name], one.gain, np.array(one.amplitudes), np.zeros((0, 0)))
        for one in (part.causes[0] for part in decision.parts)
    ]
    own = gain.sel(kind="extended")
    model = FlightModel(
        float(own["friction"]), float(own["restitution"]), tuple(fits),
        inertia=tuple(np.log(own["inertia"]).to_numpy().tolist()),
    )  # fmt: skip
    tests, rows = [(test, arc) for test in posed.tests if (arc := start_arc(test, arcs)) is not None], []
    for number, (test, arc) in enumerate(tests[:: -(-len(tests) // 60)]):
        generator = np.random.default_rng([46, number])
        moved = np.zeros_like(arc.position)
        moved[:, arc.axes] = noise * generator.standard_normal((len(moved), len(arc.axes)))
        turns = (
            turned
            * generator.standard_normal((len(moved), 3))
            * ([1.0] * 3 if len(arc.axes) == 3 else [0.0, 1.0, 0.0])
        )
        again = replace(
            arc, position=arc.position + moved,
            rotation=(Rotation.from_rotvec(turns) * Rotation.from_matrix(arc.rotation)).as_matrix(),
        )  # fmt: skip
        one, other = (filmed_replay(posed, test, start, model) for start in (arc, again))
        away = np.linalg.norm(one.position - other.position, axis=1)
        angle = (Rotation.from_matrix(one.rotation).inv() * Rotation.from_matrix(other.rotation)).magnitude()
        until = np.searchsorted(one.time, arc.time[-1] + 0.1)
        rows.append((away[:until].mean(), away.mean(), angle.mean()))
    words = "the extended model against itself, started again within the noise of the start"
    return f"| {words} | | | | {_error_cells(*np.transpose(rows), width)} |"


def _turn_noise(posed, arc):
    """Noise of a rotation about an axis, from what the tumbling of a flight leaves [rad]."""
    left = (Rotation.from_matrix(arc.rotation) * tumbling(posed, arc)[0].inv()).as_rotvec()
    free = 3 if len(arc.axes) == 3 else 1  # axes about which a flight turns
    return np.sqrt((left**2).sum() / (free * (len(left) - 2)))


def _of_halves(decisions):
    """Answers of other random halves: kinds of answers and first causes."""
    if not decisions:
        return ""
    kinds = {}
    for one in decisions:
        key = f"{one.decision}: {' + '.join(TITLES[part.causes[0].name] for part in one.parts) or 'none'}"
        kinds[key] = kinds.get(key, 0) + 1
    lines = [
        f"- {count} of {len(decisions)}: {key}"
        for key, count in sorted(kinds.items(), key=lambda one: -one[1])
    ]
    return f"{len(decisions)} further random halves were decided on:\n\n" + "\n".join(lines)


if __name__ == "__main__":
    main(sys.argv[1:])
