"""Seeded stochastic records that stand in for waveforms that may not be redistributed, and the file that defines one.

Windowed noise takes the Fourier shape of a point source and is then matched to a target response
spectrum. The method, its sources and the figures reached are in docs/guide/motions.md.
"""

from functools import lru_cache
from itertools import pairwise
from typing import Annotated, Literal

import numpy as np
import scipy
from pydantic import Field, model_validator
from scipy import fft
from scipy.special import gammainc, ndtri

from blockshake.dynamics.baseline import fast_length, high_pass
from blockshake.dynamics.intensity import DAMPING, pseudo_acceleration
from blockshake.dynamics.motion import ground_motion
from blockshake.files import load_yaml
from blockshake.validation import Count, Positive, Strict, validated

_MOST_STEPS = 200_000  # a quarter of an hour at 200 Hz; each round of matching walks through all
InnerFraction = Annotated[Positive, Field(lt=1)]
_ROUNDS = 30  # of spectral matching; the spread about the target falls to 0.035 in ln and no further
_ORDER = 4  # of the Butterworth high-pass, which is applied forwards and backwards
_TAPERED = 0.02  # share of the motion under the half-cosine at each end
_MATCHED_PERIODS = np.geomspace(0.04, 4.0, 60)  # s; shorter ones follow the peak acceleration


class Ordinate(Strict):
    """One point of the target response spectrum."""

    period: Positive = Field(description="[s]")
    acceleration: Positive = Field(description="pseudo-acceleration at 5 % damping [m/s2]")
    published: bool = Field(False, description="from a publication; otherwise inferred")


class Source(Strict):
    """Point source that gives the Fourier spectrum its first shape."""

    moment_magnitude: Annotated[Positive, Field(lt=10)]
    epicentral_distance: Positive = Field(description="[m]; stated for the record, the model does not use it")
    stress_drop: Positive = Field(description="[Pa]")
    shear_wave_velocity: Positive = Field(description="at the source [m/s]")
    kappa: Positive = Field(description="high-frequency decay exp(-pi kappa f) [s]")


class Envelope(Strict):
    """Saragoni-Hart window of the noise."""

    significant_duration: Positive = Field(description="between 5 and 95 % of the window's energy [s]")
    peak: InnerFraction = Field(description="time of the peak as a share of the window's length [1]")
    level: InnerFraction = Field(description="height at the window's end as a share of the peak [1]")


class SyntheticMotion(Strict):
    """The whole file."""

    name: str
    synthetic: Literal[True]
    description: str
    seed: Count
    time_step: Positive = Field(description="[s]")
    duration: Positive = Field(description="[s]")
    peak_acceleration: Positive = Field(description="of the finished record, exact [m/s2]")
    high_pass_frequency: Positive = Field(description="corner below which the motion has nothing [Hz]")
    source: Source
    envelope: Envelope
    target_spectrum: tuple[Ordinate, ...] = Field(min_length=2)

    @model_validator(mode="after")
    def _consistent(self):
        periods = [ordinate.period for ordinate in self.target_spectrum]
        if any(later <= earlier for earlier, later in pairwise(periods)):
            raise ValueError("expected target_spectrum in order of rising period")
        if not 100.0 <= self.duration / self.time_step <= _MOST_STEPS:
            raise ValueError(f"expected a duration of 100 to {_MOST_STEPS} time steps")
        if self.high_pass_frequency * self.duration < 0.1:
            raise ValueError("expected high_pass_frequency of a period of at most ten durations")
        return self


def load_synthetic(path):
    """Checked parameters of a synthetic motion.

    Raises
    ------
    InputError
        Missing file, unknown or missing key, value of the wrong type or out of range.
    """
    return validated(SyntheticMotion, load_yaml(path), path)


@lru_cache(maxsize=8)
def synthesise(parameters):
    """Ground motion along x from the parameters of a synthetic record, a `SyntheticMotion`.

    Returns
    -------
    GroundMotion
        A motion of kind ``acceleration``; velocity and displacement end at zero; the peak acceleration is
        ``parameters.peak_acceleration``. Same parameters, same motion: the noise comes from the raw
        bits of PCG64, which numpy keeps stable between versions, not from its distributions.

    Notes
    -----
    Boore (2003), Simulation of ground motion using the stochastic method, Pure Appl. Geophys. 160, for noise, window
    and point source; the spectral matching multiplies Fourier amplitudes by the ratio of target to response spectrum at
    the period of each frequency and keeps phases, after Gasparini and Vanmarcke (1976), SIMQKE. Path attenuation and
    site amplification are not modelled: the matching gives what they would.
    """
    step = parameters.time_step
    time = step * np.arange(round(parameters.duration / step) + 1)
    noise = standard_normal(parameters.seed, len(time)) * window(time, parameters.envelope)
    length = fft.next_fast_len(2 * len(time), real=True)
    frequency = fft.rfftfreq(length, step)
    acceleration = _filtered(noise, source_shape(frequency, parameters.source), length)
    acceleration = _in_round(acceleration, parameters)
    target = target_acceleration(parameters, _MATCHED_PERIODS)
    for _ in range(_ROUNDS):
        segments = np.full(len(time) - 1, step), acceleration[:-1], acceleration[1:]
        ratio = target / pseudo_acceleration(*segments, _MATCHED_PERIODS, DAMPING)
        gain = np.interp(np.log(np.maximum(frequency, 1e-6)), -np.log(_MATCHED_PERIODS[::-1]), ratio[::-1])
        acceleration = _in_round(_filtered(acceleration, gain, length), parameters)
    acceleration = _in_round(taper_ends(acceleration - np.mean(acceleration)), parameters)
    corner = parameters.high_pass_frequency
    attributes = {
        "source": f"stochastic method, seed {parameters.seed}: {' '.join(parameters.description.split())}",
        "format": "synthetic",
        "synthetic": True,
        "baseline": f"high-pass at {corner:g} Hz both ways, zero end velocity and displacement",
    }
    return ground_motion(parameters.name, time, {"x": acceleration}, "acceleration", attributes)


def target_acceleration(parameters, periods):
    """Target pseudo-acceleration, straight in log-log between the file's points [m/s2]."""
    points = [(np.log(point.period), np.log(point.acceleration)) for point in parameters.target_spectrum]
    return np.exp(np.interp(np.log(periods), *zip(*points, strict=True)))


def standard_normal(seed, count):
    """Normal deviates by inversion of the uniform numbers in PCG64's raw bits, shape (count,)."""
    bits = np.random.PCG64(seed).random_raw(count) >> np.uint64(11)
    return ndtri((bits.astype(float) + 0.5) / 2.0**53)


def window(time, envelope):
    """Saragoni-Hart window ``(t / t_peak)^b exp(b (1 - t / t_peak))``, peak 1.

    Boore (2003), after Saragoni and Hart (1974): ``b = -peak ln(level) / (1 + peak (ln(peak) - 1))``, and ``t_peak`` is
    set so that the window's square gathers 5 to 95 % of its integral, a gamma function, in the significant duration.
    """
    peak, level = envelope.peak, envelope.level
    b = -peak * np.log(level) / (1.0 + peak * (np.log(peak) - 1.0))
    quantiles = [
        scipy.optimize.brentq(lambda x, share=share: gammainc(2.0 * b + 1.0, x) - share, 0.0, 100.0)
        for share in (0.05, 0.95)
    ]
    peak_time = 2.0 * b * envelope.significant_duration / (quantiles[1] - quantiles[0])
    scaled = time / peak_time
    return scaled**b * np.exp(b * (1.0 - scaled))


def source_shape(frequency, source):
    """Acceleration spectrum of a point source in its shape only, shape as ``frequency`` [1].

    Boore (2003), after Brune (1970), in SI: omega-squared, corner frequency ``0.49 beta (stress_drop / M0)^(1/3)``,
    seismic moment ``M0 = 10^(1.5 Mw + 9.05)`` N m, and the decay ``exp(-pi kappa f)``.
    """
    moment = 10.0 ** (1.5 * source.moment_magnitude + 9.05)
    corner = 0.49 * source.shear_wave_velocity * (source.stress_drop / moment) ** (1.0 / 3.0)
    return frequency**2 / (1.0 + (frequency / corner) ** 2) * np.exp(-np.pi * source.kappa * frequency)


def _filtered(values, gain, length):
    return fft.irfft(fft.rfft(values, length) * gain, length)[: len(values)]


def _in_round(acceleration, parameters):
    """High-passed, closed and scaled; the taper waits for the end, else it would sharpen the onset."""
    step, corner = parameters.time_step, parameters.high_pass_frequency
    length = fast_length(len(acceleration) + 2 * int(np.ceil(1.5 * _ORDER / corner / step)))
    filtered = high_pass(acceleration, step, corner, _ORDER, length)[: len(acceleration)]
    closed = close_integrals(filtered, step)
    return closed * (parameters.peak_acceleration / np.abs(closed).max())


def taper_ends(values):
    """Values under a half-cosine rise and fall over 2 % of their number at each end."""
    count = max(1, round(_TAPERED * len(values)))
    rise = 0.5 * (1.0 - np.cos(np.pi * np.arange(count) / count))
    tapered = np.array(values, dtype=float)
    tapered[:count] *= rise
    tapered[-count:] *= rise[::-1]
    return tapered


def close_integrals(acceleration, time_step):
    """Subtract the linear function of time that leaves no end velocity and no end displacement."""
    velocity, displacement = end_of_motion(acceleration, time_step)
    duration = time_step * (len(acceleration) - 1)
    # a0 T + a1 T^2 / 2 = velocity and a0 T^2 / 2 + a1 T^3 / 6 = displacement
    slope = (6.0 * velocity * duration - 12.0 * displacement) / duration**3
    offset = velocity / duration - slope * duration / 2.0
    return acceleration - (offset + slope * time_step * np.arange(len(acceleration)))


def end_of_motion(acceleration, time_step):
    """End velocity and displacement of an acceleration that is linear between rows, from rest."""
    before, after = acceleration[:-1], acceleration[1:]
    velocity = np.concatenate([[0.0], np.cumsum(time_step * (before + after) / 2.0)])
    moved = time_step * velocity[:-1] + time_step**2 * (2.0 * before + after) / 6.0
    return float(velocity[-1]), float(np.sum(moved))
