"""Nominal tests of a plan: simulated once with all sensors that are thought of, and seen by those that are chosen."""

from dataclasses import dataclass

import numpy as np

from blockshake.diagnosis.nominal.nominal_model import draw_nominal
from blockshake.diagnosis.nominal.planned_test import PlannedTest
from blockshake.diagnosis.nominal.simulated_test import simulated_test
from blockshake.dynamics.load_motion import load_motion
from blockshake.errors import Argument, InputError
from blockshake.files import load_yaml
from blockshake.forces.seen.reconstructed_test import reconstruct_test, why_not_reconstructed
from blockshake.geometry.schema import Accelerometer, Marker
from blockshake.geometry.structure import Structure, build_structure, load_structure
from blockshake.measurement.campaigns.campaign import Sensors
from blockshake.measurement.motion.body_frame import without_outliers
from blockshake.measurement.motion.fall import find_fall, until_fall
from blockshake.measurement.sensors.markers import driven_marker
from blockshake.simulation.simulate import check_run
from blockshake.validation import Strict, validated

SOLVER = "nscd-rigid"
_USUAL = {
    "face": (0.0, -0.5, 0.0),
    "lower": (-0.35, -0.5, -0.4),
    "upper": (0.35, -0.5, 0.4),
    "end": (0.5, 0.0, 0.0),
}
_TOP = (0.5, 0.0, 0.43)  # of an accelerometer; places over the edges of the body's box


class SensorFile(Strict):
    """A file of sensors: markers and accelerometers as in a structure file, their noise as in a campaign."""

    markers: tuple[Marker, ...] = ()
    accelerometers: tuple[Accelerometer, ...] = ()
    sensors: Sensors = Sensors()


@dataclass(frozen=True)
class PlannedCampaign:
    """The campaign that is requested."""

    structure: Structure  # with every sensor, chosen or only thought of
    sensors: Sensors  # their noise
    chosen: frozenset  # frozenset of str; names of the chosen markers and accelerometers
    # str to frozenset of str; in words one sensor more, and the names of its markers or accelerometers
    more: dict
    motions: dict  # str to GroundMotion; by name of the test, scaled
    duration: float | None  # of every test, the motion's own without one [s]

    def simulated(self, test, number, factor=1.0):
        """Readings of all sensors in a test by a nominal model of a number, the motion times a factor."""
        motion = self.motions[test].scaled(factor)
        markers = tuple(marker.name for marker in self.structure.file.markers)
        duration = self.duration or motion.duration
        planned = PlannedTest(self.structure, motion, duration, self.sensors, markers)
        return simulated_test(planned, draw_nominal(self.structure, SOLVER, number), accelerometers=True)

    def seen(self, name, readings, more=frozenset()):
        """`ReconstructedTest` of the chosen sensors and ``more``; None where no forces can be read."""
        structure, names = _with_sensors(self.structure, self.chosen | more), self.chosen | more
        readings = readings.sel(marker=[one for one in readings["marker"].values if one in names])
        if "channel" in readings.dims:
            kept = [one for one in readings["channel"].values if one.rpartition("-")[0] in names]
            readings = readings.sel(channel=kept) if kept else readings.drop_dims(["time_acc", "channel"])
        readings = until_fall(readings, find_fall(readings, structure, self.sensors))
        if why_not_reconstructed(readings, structure):
            return None
        return reconstruct_test(name, without_outliers(readings, structure), structure, self.sensors)


def _with_sensors(structure, names):
    mapping = structure.file.model_dump(mode="json")
    for kind in ("markers", "accelerometers"):
        mapping[kind] = [one for one in mapping[kind] if one["name"] in names]
    return structure.with_mapping(mapping)


def load_planned(structure, motions, sensors=None, duration=None):
    """`PlannedCampaign` of a structure, motions as ``NAME`` or ``NAME@SCALE``, and a file of sensors.

    Without a file the sensors are those of the structure file; where that has none, four markers and an accelerometer
    on every body.

    Raises
    ------
    InputError
        A file that is wrong or not there, a motion that is named twice, sensors on bodies that the structure lacks, a
        slab without a marker along x, or a duration that is no time.
    """
    if duration is not None and not 0.0 < duration < np.inf:
        raise InputError(Argument("duration"), duration, "expected a positive number of seconds")
    loaded, where = load_structure(structure), sensors or structure
    mapping = loaded.file.model_dump(mode="json")
    noise = Sensors()
    if sensors is not None:
        given = validated(SensorFile, load_yaml(sensors), sensors)
        mapping |= given.model_dump(mode="json", include={"markers", "accelerometers"})
        noise = given.sensors
    elif not mapping["markers"]:
        usual = [_usual(body, loaded.solids[body.shape]) for body in loaded.file.bodies]
        mapping |= {kind: [one for of_body in usual for one in of_body[kind]] for kind in usual[0]}
    chosen = frozenset(one["name"] for kind in ("markers", "accelerometers") for one in mapping[kind])
    more = {}
    for body in loaded.file.bodies:
        added = _usual(body, loaded.solids[body.shape], "more-")
        for kind, words in (("markers", "four more markers"), ("accelerometers", "one more accelerometer")):
            mapping[kind] = [*mapping[kind], *added[kind]]
            more[f"{words} on {body.name}"] = frozenset(one["name"] for one in added[kind])
    whole = build_structure(mapping, str(where), loaded.folder)
    driven_marker(_with_sensors(whole, chosen))
    scaled = {}
    for entry in motions:
        test, motion = _motion(entry)
        if test in scaled:
            raise InputError(Argument("motions"), entry, "expected every motion and scale once")
        scaled[test] = motion
        check_run(whole, motion, SOLVER, {}, None, duration or motion.duration, None)
    return PlannedCampaign(whole, noise, chosen, more, scaled, duration)


def _motion(entry):
    name, at, scale = entry.rpartition("@")
    try:
        name, scale = (name, float(scale)) if at else (entry, 1.0)
    except ValueError:
        raise InputError(
            Argument("motions"), entry, "expected NAME or NAME@SCALE, such as alkion@2.5"
        ) from None
    motion = load_motion(name, scale)
    return f"{motion.name}@{scale:g}", motion


def _usual(body, solid, prefix=""):
    """Markers on a face and an end, and an accelerometer near the top, of one body."""
    edges = np.ptp(solid.vertices, axis=0)
    markers = [
        {"name": f"{prefix}{body.name}-{name}", "body": body.name, "position": (edges * place).tolist()}
        for name, place in _USUAL.items()
    ]
    top = {
        "name": f"{prefix}{body.name}-acc",
        "body": body.name,
        "position": (edges * _TOP).tolist(),
        "axes": ["x", "z"],
    }
    return {"markers": markers, "accelerometers": [top]}
