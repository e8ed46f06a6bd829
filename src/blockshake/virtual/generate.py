"""A virtual campaign: ladders of strong tests climbed on the virtual table, written as a laboratory would."""

import json
from pathlib import Path

import numpy as np

from blockshake.dynamics.load_motion import load_motion
from blockshake.dynamics.system import Status
from blockshake.files import content_digest, write_dataset, write_json
from blockshake.geometry.structure import load_structure
from blockshake.measurement.campaigns.campaign_folder import (
    motion_in_folder,
    structure_in_folder,
    write_campaign_file,
)
from blockshake.measurement.sensors.markers import driven_marker
from blockshake.study.ensembles.ensemble import relative_to_slab
from blockshake.virtual.shake_table import shake
from blockshake.virtual.truth import hidden_effect, true_parameters

DECIMALS = {"m": 5, "m s-2": 3}  # digits kept of a reading: a tenth and a twentieth of its usual noise
_PLACES = 4  # stream of the seed
_HEADER = "# SYNTHETIC: simulated runs seen through noisy sensors. Nothing here was measured.\n"


def generate_campaign(settings, structure, folder, truth, source, progress):
    """Make the folder of a campaign and, apart, that of its truth.

    Parameters
    ----------
    settings : VirtualCampaign
    structure : str
        Shipped name or file.
    folder, truth : str or path
        The second holds ``truth.json`` and, by test, what happened.
    source : str
        Digest of the sources that compute; tests that another digest made are made anew.
    progress : callable
        Called with a line of text after each test.

    Notes
    -----
    A motion's ladder ends with the first test in which a marker drifts too far, as read; one in which a block
    fell, whose markers fell with it, is not part of the campaign. The stack is put back before each test. Tests that
    an earlier call has finished are kept.
    """
    folder, truth = Path(folder), Path(truth)
    loaded = load_structure(structure)
    called_structure = structure_in_folder(structure, loaded, folder)
    table = _Table(settings, loaded, folder, truth, source, progress)
    tests = []
    for motion in settings.motions:
        called = motion_in_folder(motion, folder)
        for scale in settings.intensities.scales.tolist():
            entry = {
                "name": f"{Path(motion).stem}-{round(100 * scale):03d}", "motion": called, "scale": scale,
                "baseline": settings.baseline,
            }  # fmt: skip
            drift = table.test(entry, load_motion(motion, scale, settings.baseline))
            if drift is not None:
                tests.append(entry)
            if drift is None or drift > settings.intensities.largest_drift:
                break
    noise = settings.instruments
    sensors = {"marker_noise": noise.marker_noise, "accelerometer_noise": noise.accelerometer_noise}
    if loaded.file.displacement_transducers:
        sensors["transducer_noise"] = noise.transducer_noise
    write_campaign_file(folder, _HEADER, settings.name, called_structure, sensors, with_roles(tests))
    write_json(
        truth / "truth.json",
        {
            "effect": table.effect, "parameters": table.parameters, "structure": structure,
            "settings": settings.model_dump(mode="json"), "source": source,
        },
    )  # fmt: skip


def with_roles(tests):
    """Strong tests, motion by motion and rising, with what each may be used for.

    Every motion's strongest is sealed; the strongest but one of the last motion is for selection; the others are
    for fitting. A motion of one test only has it for fitting.
    """
    roles = ["fit"] * len(tests)
    for index, test in enumerate(tests):
        same = np.flatnonzero([other["motion"] == test["motion"] for other in tests])
        if len(same) > 1 and index == same[-1]:
            roles[index] = "sealed"
        elif len(same) > 2 and index == len(tests) - 2:
            roles[index] = "select"
    return [{**test, "role": role} for test, role in zip(tests, roles, strict=True)]


class _Table:
    """The table and its truth."""

    def __init__(self, settings, structure, folder, truth, source, progress):
        self.settings, self.structure, self.folder, self.truth = settings, structure, folder, truth
        self.source, self.progress = source, progress
        self.effect = hidden_effect(settings.hidden, structure, settings.seed)
        self.parameters = true_parameters(structure, settings.seed)
        self.count = 0

    def test(self, entry, motion):
        """Largest drift read in a test [m], or None where a block fell or the run failed."""
        self.count += 1
        places = self._places()
        made_by = content_digest(
            self.source, self.settings.model_dump(mode="json"), self.parameters, self.effect, self.count,
            places.tobytes(), *(part.tobytes() for part in motion.table),
        )  # fmt: skip
        entry["file"] = f"{entry['name']}.nc"
        path, record = self.folder / entry["file"], self.truth / f"{entry['name']}.json"
        happened = json.loads(record.read_text()) if record.exists() else {}
        if happened.get("made_by") != made_by or (
            happened["status"] == Status.COMPLETED and not path.exists()
        ):
            happened = {"made_by": made_by, **self._shake(path, entry, motion, places)}
            write_json(record, happened)
        self.progress(
            f"{entry['name']}: {happened['status']}, largest drift {1e3 * happened['drift']:.1f} mm"
        )
        return happened["drift"] if happened["status"] == Status.COMPLETED else None

    def _shake(self, path, entry, motion, places):
        test, run = shake(
            self.structure, self.parameters, self.effect, motion, self.settings, places, self.settings.duration,
            int(content_digest(self.settings.seed, self.count), 16),
        )  # fmt: skip
        test.attrs |= {"motion": entry["motion"], "motion_scale": entry["scale"]}
        if run.attrs["status"] == Status.COMPLETED:
            write_dataset(path, test, DECIMALS)
        slab = driven_marker(self.structure)
        drift = np.abs(relative_to_slab(test["marker_displacement"], slab).sel(axis="x")).max()
        return {
            "status": run.attrs["status"],
            "reason": run.attrs["reason"],
            "drift": float(drift),
            "places": places.tolist(),
        }

    def _places(self):
        """Places of the blocks as they are put back before a test, but for a little along x and y."""
        generator = np.random.default_rng([self.settings.seed, _PLACES, self.count])
        places = np.zeros((len(self.structure.driven), 3))
        places[~self.structure.driven, :2] = generator.normal(
            0.0, self.settings.misplacement, ((~self.structure.driven).sum(), 2)
        )
        return places
