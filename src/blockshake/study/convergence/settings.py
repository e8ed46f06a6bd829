"""The convergence study in a study's configuration."""

from typing import Annotated

from pydantic import Field

from blockshake.simulation.limits import LONGEST_STEP
from blockshake.solvers.ls_dem.parameters import LARGEST_INSET
from blockshake.validation import Positive, Strict


class Convergence(Strict):
    """The short runs that show how LS-DEM's numerical parameters act, varied one at a time."""

    structure: str = Field(description="shipped name or file; one block of it rocks, and all of it is shaken")
    acceleration: Positive = Field(
        2.5,
        description="amplitude of one cycle of sine along x; it should rock the stack and not topple it [m/s2]",
    )
    frequency: Positive = Field(1.5, description="of that cycle [Hz]")
    duration: Positive = Field(4.0, description="simulated time [s]")
    time_steps: tuple[Annotated[Positive, Field(le=LONGEST_STEP)], ...] = Field(
        (1e-5, 2e-5, 5e-5, 1e-4),
        min_length=2,
        description="of LS-DEM; the smallest is what the others are held against [s]",
    )
    node_spacings: tuple[Positive, ...] = Field(
        (0.05, 0.1, 0.2, 0.4), min_length=2, description="of the surfaces; likewise [m]"
    )
    perimeter_insets: tuple[Annotated[Positive, Field(le=LARGEST_INSET)], ...] = Field(
        (0.0015, 0.003, 0.006, 0.012),
        min_length=2,
        description="of the outermost nodes of a face, over its narrower width; likewise [1]",
    )
    grid_spacings: tuple[Positive, ...] = Field(
        (0.005, 0.01, 0.02, 0.04),
        min_length=1,
        description="of the sampled distance, beside the exact one [m]",
    )

    @property
    def numerical(self):
        """Values by parameter of LS-DEM."""
        return {
            "node_spacing": self.node_spacings,
            "perimeter_inset": self.perimeter_insets,
            "grid_spacing": self.grid_spacings,
        }
