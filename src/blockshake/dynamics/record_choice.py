"""Records chosen from many, so that their spectra have the mean and the scatter of a target."""

from typing import Annotated, Any, Literal

import numpy as np
from pydantic import Field, model_validator

from blockshake.dynamics.intensity import response_spectrum
from blockshake.errors import InputError
from blockshake.tables.units import unit_size
from blockshake.validation import Finite, NotNegative, Positive, Strict, Whole

_OFFSETS = np.linspace(-2.0, 2.0, 17)  # of a record's level, in deviations of the target
_SWEEPS = 50  # of exchanges; a handful is enough


class TargetSpectrum(Strict):
    """A target spectrum at 5 % damping, along x, and how many records are chosen to it."""

    count: Annotated[Whole, Field(ge=2, le=200)] = Field(description="of the records that are chosen [1]")
    periods: tuple[Positive, ...] = Field(min_length=2, description="at which spectra are compared [s]")
    median: tuple[Positive, ...] = Field(
        description="pseudo-acceleration at each period, the mean in logarithms, in `unit` [m/s2]"
    )
    deviation: tuple[NotNegative, ...] = Field(
        (),
        description="standard deviation of the natural logarithm at each period; none: as little as possible [1]",
    )
    unit: Literal["m/s2", "cm/s2", "g"] = Field("m/s2", description="of the median")
    largest_scale: Annotated[Finite, Field(ge=1.0)] = Field(
        4.0,
        description="factor by which a record is scaled at most, up or down, where no level sets its scale [1]",
    )

    @model_validator(mode="before")
    @classmethod
    def _in_si(cls, given: Any):
        """The median in m/s2, so that a mapping that is read again is the same."""
        if not isinstance(given, dict) or given.get("unit") not in ("cm/s2", "g"):
            return given
        size = float(unit_size("acceleration", given["unit"], "", "unit"))
        median = given.get("median")
        if not isinstance(median, (list, tuple)) or not all(type(one) in (int, float) for one in median):
            return given
        return given | {"unit": "m/s2", "median": [size * one for one in median]}

    @model_validator(mode="after")
    def _is_whole(self):
        if len(self.median) != len(self.periods) or len(self.deviation) not in (0, len(self.periods)):
            raise ValueError("expected a median, and a deviation if any, for each period")
        return self


def choose(target, records, motions, where, at_level=False):
    """Records that are chosen to a target, each with its scale.

    Parameters
    ----------
    target : TargetSpectrum
    records, motions : list
        `SetRecord` and `GroundMotion` of all that there are.
    where : str
        Set that an error names.
    at_level : bool
        A level sets the scale of each record afterwards: the choice is by shape alone.

    Returns
    -------
    tuple of SetRecord
        In the order of ``records``; of no event more than one.

    Raises
    ------
    InputError
        A motion that does not move along x, or too few events whose records need no larger scale.

    Notes
    -----
    Spectra are compared as natural logarithms, their mean and standard deviation with the target's, at all periods
    alike. Each record is offered at several levels about the one that fits the median best. Records are added one by
    one, the best next, and then exchanged while that helps (Jayaram, Lin and Baker 2011, the greedy improvement). The
    same files give the same choice.
    """
    deviation = np.array(target.deviation or np.zeros(len(target.periods)))
    departures, places, scales, events = [], [], [], []
    names = {}
    for place, (record, motion) in enumerate(zip(records, motions, strict=True)):
        spectrum = response_spectrum(motion, target.periods)
        if spectrum.min() <= 0.0:
            raise InputError(record.path, "", "expected a motion along x, to be chosen by its spectrum")
        shape = np.log(spectrum / target.median)
        event = names.setdefault(event_of(record, motion), len(names))
        for offset in (0.0,) if at_level or not deviation.any() else _OFFSETS * deviation.mean():
            scale = float(np.exp(offset - shape.mean()))
            if at_level or 1.0 / target.largest_scale <= scale <= target.largest_scale:
                departures.append(shape - shape.mean() + offset)
                places.append(place), scales.append(scale), events.append(event)
    if len(set(events)) < target.count:
        wrong = f"expected at least {target.count} events whose records need no larger scale, not {len(set(events))}"
        raise InputError(where, "", wrong)
    chosen = _greedy(np.array(departures), np.array(events), deviation, target.count)
    order = sorted(chosen, key=lambda one: places[one])
    return tuple(records[places[one]]._replace(scale=scales[one]) for one in order)


def mean_and_scatter(target, motions):
    """Mean and standard deviation of the logarithms of spectra over the target's median, float64 (n_periods,) each."""
    spectra = np.array([response_spectrum(motion, target.periods) for motion in motions])
    departures = np.log(spectra / target.median)
    return departures.mean(axis=0), departures.std(axis=0, ddof=1)


def event_of(record, motion):
    """Event of a record: that of its table, else of the file's header, else the record itself."""
    chosen_words = motion.attributes
    # a header of PEER has name, date, station and direction, with commas between
    named = (
        chosen_words.get("event_id")
        or ",".join(str(chosen_words.get("event", "")).split(",")[:2]).strip().lower()
    )
    return record.event or named or record.path


def _greedy(departures, events, deviation, count):
    """Rows of departures from the target's median whose mean is near 0 and whose scatter is near the target's."""
    chosen = []
    for _ in range(count):
        chosen.append(_best(departures, events, deviation, chosen)[0])
    for _ in range(_SWEEPS):
        before = list(chosen)
        for place in range(count):
            others = chosen[:place] + chosen[place + 1 :]
            best, misfits = _best(departures, events, deviation, others)
            if misfits[best] < misfits[chosen[place]] - 1e-12:
                chosen[place] = best
        if chosen == before:
            break
    return chosen


def _best(departures, events, deviation, others):
    """The row that goes best with others, and the misfit with each row; infinite for a second one of an event."""
    number = len(others) + 1
    rest = departures[others]
    mean = (departures + rest.sum(axis=0)) / number
    squares = (departures**2 + (rest**2).sum(axis=0)) / number - mean**2
    scatter = np.sqrt(np.maximum(squares, 0.0) * number / max(number - 1, 1))
    misfits = (mean**2 + (scatter - (deviation if number > 1 else 0.0)) ** 2).sum(axis=1)
    misfits[np.isin(events, events[others])] = np.inf
    return int(np.argmin(misfits)), misfits
