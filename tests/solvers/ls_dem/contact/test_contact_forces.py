import numpy as np
import pytest

from blockshake.geometry.structure import build_structure, load_structure
from blockshake.solvers.ls_dem.contact.contact_law import normal_force
from blockshake.solvers.ls_dem.interfaces import (
    assemble_interfaces,
    damping_ratio,
    dashpot_coefficient,
    in_series,
)
from blockshake.solvers.ls_dem.parameters import LsDemParameters

PARAMETERS = LsDemParameters()


@pytest.mark.parametrize(
    ("phi", "closing", "force"),
    [
        (-1e-3, 0.0, 2000.0),  # k_n of 2e6 N/m
        (-1e-3, -0.1, 2500.0),  # approaching: the dashpot of 5,000 N s/m adds
        (-1e-3, 0.1, 1500.0),  # parting: it takes away
        (-1e-3, 1.0, 0.0),  # and never pulls
        (0.0, -0.1, 0.0),
        (1e-3, -0.1, 0.0),
    ],
)
def test_equation_2_node_by_node(phi, closing, force):
    """Zhou et al. (2023), Eq. (2), with the normal out of the other body and no tension."""
    assert normal_force(phi, 1.0, closing, 2.0e6, 5.0e3, 0.0) == pytest.approx(force, rel=1e-12)


def test_equation_2_as_printed_may_pull_while_inside():
    assert normal_force(-1e-3, 1.0, 1.0, 2.0e6, 5.0e3, -np.inf) == pytest.approx(-3000.0, rel=1e-12)
    assert normal_force(1e-3, 1.0, 1.0, 2.0e6, 5.0e3, -np.inf) == 0.0


def test_like_on_like_has_the_stiffness_given_and_unlike_ones_act_in_series():
    """Configuration 4: steel of 2.1e11 Pa on concrete of 3.45e10 Pa (docs/guide/contracts.md, parameters)."""
    structure = load_structure("configuration-4")
    interfaces = assemble_interfaces(structure, PARAMETERS)
    names = structure.body_names
    wall, beam, top = names.index("wall-a-4"), names.index("beam-1"), names.index("top")
    assert in_series(interfaces.k_n, wall, top) == pytest.approx(2.16e10, rel=1e-12)
    assert in_series(interfaces.k_s, wall, top) == pytest.approx(9.0e9, rel=1e-12)
    # half of each block's own compliance: 1/k = (1/k_concrete + 1/k_steel) / 2
    ratio = 2.1e11 / 3.45e10
    assert in_series(interfaces.k_n, wall, beam) == pytest.approx(
        2.0 / (1.0 + 1.0 / ratio) * 2.16e10, rel=1e-12
    )
    shear_ratio = ratio * 1.2 / 1.3
    assert in_series(interfaces.k_s, wall, beam) == pytest.approx(
        2.0 / (1.0 + 1.0 / shear_ratio) * 9.0e9, rel=1e-12
    )
    assert in_series(interfaces.k_s, beam, wall) == in_series(interfaces.k_s, wall, beam)


@pytest.mark.parametrize(("bodies", "share"), [((0, 1), 1.0), ((1, 2), 0.5)])
def test_the_mass_of_a_contact_is_that_of_a_central_impact(bodies, share):
    """Eq. (3), both sides together: 2 zeta sqrt(m k) of the interface; the slab is driven, so infinitely heavy."""
    structure = load_structure("configuration-1")
    interfaces = assemble_interfaces(structure, PARAMETERS)
    assert interfaces.damping_ratio == damping_ratio(0.5)
    area, k_n = 1.28, 2.16e10
    of_both_sides = 2.0 * area * dashpot_coefficient(interfaces, *bodies, 0.3, k_n, area)
    mass = share * structure.mass[1]
    assert of_both_sides == pytest.approx(2.0 * 0.3 * np.sqrt(mass * k_n * area), rel=1e-12)


def test_the_order_of_bodies_does_not_change_the_stiffness():
    """The reference material is that of most free mass: concrete, though a steel beam came first."""
    structure = load_structure("configuration-4")
    bodies = list(structure.file.bodies)
    beam = next(index for index, body in enumerate(bodies) if body.name == "beam-1")
    order = [0, beam, *(index for index in range(1, len(bodies)) if index != beam)]
    mapping = structure.file.model_dump()
    mapping["bodies"] = [mapping["bodies"][index] for index in order]
    other = build_structure(mapping, "test", ".")
    for name in ("k_n", "k_s"):
        expected = getattr(assemble_interfaces(structure, PARAMETERS), name)[order]
        np.testing.assert_allclose(
            getattr(assemble_interfaces(other, PARAMETERS), name), expected, rtol=1e-12
        )
