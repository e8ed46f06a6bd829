"""Numerical parameters of nonsmooth contact dynamics with deformable blocks."""

from typing import Annotated

from pydantic import Field

from blockshake.validation import Strict

Positive = Annotated[float, Field(gt=0, allow_inf_nan=False)]


class DeformableParameters(Strict):
    """Numerical parameters of both deformable models; each is set as ``nscd_deformable.NAME``."""

    mesh_size: Positive = Field(0.2, description="edge of the hexahedra, about [m]; Zhou et al. (2023)")
    contact_spacing: Positive = Field(
        0.6,
        description="largest distance of contact points in a joint, and of the shapes that carry them [m], 10 gives "
        "the four corners; chosen, docs/nscd-deformable.md",
    )
    modes: Annotated[int, Field(ge=0)] = Field(
        40,
        description="free modes of each shape besides the static ones [1], as many as the mesh has or more give the "
        "full mesh; chosen, docs/nscd-deformable.md",
    )
    theta: Annotated[float, Field(ge=0.5, le=1.0)] = Field(
        0.5,
        description="weight of the end of a step in the rigid motion [1]; 0.5 conserves energy, Jean (1999)",
    )
    elastic_theta: Annotated[float, Field(ge=0.5, le=1.0)] = Field(
        0.6, description="weight of the end of a step in the deformation [1]; chosen, docs/nscd-deformable.md"
    )
    tolerance: Positive = Field(
        1e-8,
        description="residual of complementarity and Coulomb's cone relative to the impulses [1]; as in nscd",
    )
    max_iterations: Annotated[int, Field(ge=1)] = Field(
        500, description="Newton steps and sweeps over the contacts allowed in one step [1]; as in nscd"
    )
    impact_parts: Annotated[int, Field(ge=1, le=1000)] = Field(
        1, description="parts into which a step is cut in which bodies meet [1]; 1 takes it whole"
    )
