"""A commanded test as it is simulated: all that its simulations depend on."""

from dataclasses import dataclass, replace
from typing import NamedTuple

import numpy as np

from blockshake.dynamics.motion import GroundMotion
from blockshake.errors import InputError
from blockshake.files import content_digest
from blockshake.geometry.structure import Structure
from blockshake.measurement.campaigns.campaign import Sensors, load_test
from blockshake.measurement.campaigns.clocks import reading_rate, simulation_start, since
from blockshake.measurement.campaigns.commanded_motion import commanded_motion
from blockshake.measurement.campaigns.initial_poses import initial_poses
from blockshake.measurement.campaigns.recorded_test import structure_at_start
from blockshake.measurement.motion.fall import find_fall, until_fall
from blockshake.measurement.sensors.markers import RATE, unread_directions

_SAME_READING = 1e-3  # steps, within which two readings are at one time


class Clock(NamedTuple):
    """Times at which a test was read, counted from `simulation_start`.

    ``late``: start of the command, less than a step [s]; ``rate`` of the markers [Hz]; ``first``: the first reading,
    where the record begins after the command [s].
    """

    late: float = 0.0
    rate: float = RATE
    first: float = 0.0


_SIMULATED = Clock()


@dataclass(frozen=True)
class PlannedTest:
    """A commanded test. Of the readings only their times enter."""

    structure: Structure  # the campaign's, its blocks where the test found them
    motion: GroundMotion  # commanded, scaled
    duration: float  # [s]
    sensors: Sensors  # whose noise is read
    markers: tuple[str, ...]  # that were read
    unread: tuple[tuple[str, str], ...] = ()  # marker and axis of the directions that were not measured
    clock: Clock = _SIMULATED

    @property
    def driving(self):
        """The commanded motion on the clock of the readings."""
        return self.motion.delayed(self.clock.late)

    @property
    def peak_acceleration(self):
        """Peak acceleration of the commanded motion along x [m/s2]."""
        return float(np.abs(self.motion.evaluate(self.motion.table.breaks, derivative=2)[:, 0]).max())

    @property
    def digest(self):
        """Digest of the content: equal for equal tests, whatever their files are called."""
        return content_digest(
            self.structure.digest,
            *(part.tobytes() for part in self.motion.table),
            self.duration,
            self.sensors.model_dump(),
            self.markers,
            self.unread,
            self.clock,
        )


def planned_test(campaign, name, structure):
    """A test that is not sealed as it is simulated: as long and with the markers that were read in it.

    Of a test in which a block falls it is the part before.

    Raises
    ------
    InputError
        A commanded motion that is neither shipped nor in the campaign's folder, or bad readings.
    """
    test = load_test(campaign, name)
    test = until_fall(test, find_fall(test, structure, campaign.sensors))
    late = -simulation_start(test["time"].to_numpy())
    test = since(test, -late)
    time, rate = test["time"].to_numpy(), reading_rate(test["time"].to_numpy())
    return PlannedTest(
        structure=initial_poses(structure, test),
        motion=planned_motion(campaign, name),
        duration=float(np.ceil(time[-1] * rate - _SAME_READING) / rate),
        sensors=campaign.sensors,
        markers=tuple(map(str, test["marker"].values)),
        unread=tuple(unread_directions(test)),
        clock=Clock(late, rate, float(time[0])),
    )


def planned_sealed(campaign, name, tests, structure):
    """A sealed test as it is simulated: as long and with the sensors as an open one, from where its blocks stood.

    Of its file the survey alone is read, which is known before the test.

    ``tests``: open `PlannedTest` by name; of these the longest under the same motion, or else the longest.
    """
    motion = campaign.tests[name].motion
    like = max(
        tests, key=lambda opened: (campaign.tests[opened].motion == motion, tests[opened].duration, opened)
    )
    like = tests[like]
    return replace(
        like,
        structure=structure_at_start(campaign.folder / campaign.tests[name].file, structure),
        motion=planned_motion(campaign, name),
        clock=like.clock._replace(first=0.0),
    )


def planned_motion(campaign, name):
    """Commanded `Motion` of a test.

    Raises
    ------
    InputError
        It is neither shipped nor in the campaign's folder.
    """
    motion = commanded_motion(campaign, campaign.tests[name])
    if motion is None:
        raise InputError(
            campaign.folder / "campaign.yaml",
            f"tests.{name}.motion",
            f"expected a shipped motion or a file in the folder, found {campaign.tests[name].motion}",
        )
    return motion
