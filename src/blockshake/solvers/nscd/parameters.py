"""Numerical parameters of nonsmooth contact dynamics, of rigid and of deformable blocks."""

from typing import Annotated

from pydantic import Field

from blockshake.validation import Finite, Positive, ProperFraction, Strict


class StepParameters(Strict):
    """Numerical parameters of a step, whether blocks deform or not."""

    theta: Annotated[Finite, Field(ge=0.5, le=1.0)] = Field(
        0.5, description="weight of the velocity at the end of a step [1]; 0.5 conserves energy, Jean (1999)"
    )
    tolerance: Positive = Field(
        1e-8,
        description="residual of complementarity and Coulomb's cone relative to the impulses [1]; chosen: "
        "faster than 1e-6 on configurations 3 and 4 in moderate motion, where clean states warm-start the next step",
    )
    max_iterations: Annotated[int, Field(ge=1)] = Field(
        500, description="Newton steps and sweeps over the contacts allowed in one step [1]; chosen"
    )
    impact_parts: Annotated[int, Field(ge=1, le=1000)] = Field(
        1, description="parts into which a step is cut in which bodies meet [1]; 1 takes it whole"
    )


class NscdParameters(StepParameters):
    """Numerical parameters of rigid nonsmooth contact dynamics; each is set as ``nscd.NAME``."""

    shrink: ProperFraction = Field(
        0.0,
        description="contact areas are scaled about their centroid by one minus this [1]; Zhou et al. (2023) "
        "shrink by an amount they do not state",
    )


class DeformableParameters(StepParameters):
    """Numerical parameters of both deformable models; each is set as ``nscd_deformable.NAME``."""

    mesh_size: Positive = Field(0.2, description="edge of the hexahedra, about [m]; Zhou et al. (2023)")
    contact_spacing: Positive = Field(
        0.6,
        description="largest distance of contact points in a joint, and of the shapes that carry them [m], 10 gives "
        "the four corners; chosen, docs/theory/nscd-deformable.md",
    )
    modes: Annotated[int, Field(ge=0)] = Field(
        40,
        description="free modes of each shape besides the static ones [1], as many as the mesh has or more give the "
        "full mesh; chosen, docs/theory/nscd-deformable.md",
    )
    elastic_theta: Annotated[float, Field(ge=0.5, le=1.0)] = Field(
        0.6,
        description="weight of the end of a step in the deformation [1]; chosen, docs/theory/nscd-deformable.md",
    )
