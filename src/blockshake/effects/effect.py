"""Definition of an effect: equation, parameters, place, rows, and the effects it is mistaken for."""

from collections.abc import Callable
from dataclasses import dataclass, replace
from typing import Literal, NamedTuple

import numpy as np

from blockshake.dynamics.motion import GroundMotion
from blockshake.geometry.structure import Structure
from blockshake.measurement.sensors.instruments import Instruments


@dataclass(frozen=True)
class Experiment:
    """One test as a solver and the sensors are given it; an effect turns one into another."""

    structure: Structure
    motion: GroundMotion
    instruments: Instruments

    def with_parameters(self, **changed):
        """Change parameters of the structure, by dotted name: ``**{"name.of.one": value}``."""
        return replace(self, structure=self.structure.with_parameters(changed))

    def with_instruments(self, **changed):
        """Add faults to the instruments, or replace those of the same name."""
        return replace(self, instruments=Instruments(**{**self.instruments.model_dump(), **changed}))

    def with_motion(self, channel, polynomials):
        """Add polynomials to one channel of the motion, with coefficients as in `MotionTable`."""
        coefficients = self.motion.table.coefficients.copy()
        coefficients[:, channel] += polynomials
        table = self.motion.table._replace(coefficients=coefficients)
        return replace(self, motion=replace(self.motion, table=table))


@dataclass(frozen=True)
class EffectParameter:
    """One number of an effect."""

    name: str
    unit: str
    meaning: str
    null: float  # at which the effect is absent, or, of a parameter that has no such value, its usual one
    # lower, upper: ends of the prior, uniform between them
    lower: float
    upper: float
    # a size at which a test that moves the blocks should show it; half of it is the small size of the tests
    visible: float


class DesignMatrix(NamedTuple):
    """Rows of the forces that one variant of an effect makes in a test, given the measured motion."""

    values: dict  # str to float; parameters that are not amplitudes, at one point of their grid
    rows: np.ndarray  # float64 (n_rows, n_amplitudes); per unit of each amplitude
    # of float; standard deviations of the amplitudes' priors, about zero; None where the rows have no
    # amplitude
    scales: tuple | None
    positive: bool  # the first amplitude is not negative
    most: float = np.inf  # magnitude of the size, beyond which no structure has it


@dataclass(frozen=True)
class Effect:
    """An entry of the registry."""

    name: str  # as in ``verdict.json``
    title: str  # as in reports
    # where: on the ``input``, the ``contact``, the ``geometry``, a ``force`` or the ``observation``
    acts: Literal["input", "contact", "geometry", "force", "observation"]
    # equation, source: law of the effect, and its literature
    equation: str
    source: str
    # the first is the size: at its null value nothing is changed, whatever the others
    parameters: tuple[EffectParameter, ...]
    confused_with: tuple[str, ...]  # names of effects that leave nearly the same
    distinguished_by: str  # the measurement that tells them apart
    places: Callable  # of a structure: where the effect may be, list of dict (``{}`` where it has no place)
    # of an experiment, the values by parameter name, and the place: the experiment with the effect
    act: Callable
    # of a `ReconstructedTest` and a place of the evidence: `DesignMatrix` of all variants of the effect there, the same
    # variants in every test. None where the effect shows elsewhere than in the forces of joints
    columns: Callable | None = None
    # of the structure: places of the evidence, those of ``places`` by default
    seen_at: Callable | None = None
    # of a `ReconstructedTest`, a place of the evidence and the values of a fit: the rows of that variant, (n_rows,
    # n_amplitudes). By default those of ``columns`` with these values
    variant: Callable | None = None
    # turns, lifts: of a `SlabMotion`: `DesignMatrix` of its rotation, and covariances of its vertical displacement
    turns: Callable | None = None
    lifts: Callable | None = None
    # of a variant's values, amplitudes, and places between two points of the grid, -0.5 to 0.5, float64
    # arrays: the parameters, dict of str to float or array
    reads: Callable | None = None
    # of an experiment, parameters that ``reads`` gave, and a place of the evidence: the experiment with the
    # effect. By default ``act`` at that place
    extends: Callable | None = None

    def rows_of(self, seen, place, values):
        """Rows of the variant with the values of a fit, (n_rows, n_amplitudes)."""
        if self.variant:
            return self.variant(seen, place, values)
        return next(variant.rows for variant in self.columns(seen, place) if variant.values == values)
