"""One bearing on hexahedra and on tetrahedra."""

import dataclasses

import pytest

import exudyn_ehd as ehd
from tests.solid_tetrahedra import tet_mesh

# kernels of an element are compiled for it alone, which takes longer than these tests
pytestmark = pytest.mark.slow

POLYMER = ehd.SaintVenantKirchhoff(youngs_modulus=5e9, poisson_ratio=0.3, density=1400.0)
CYLINDER = ehd.HollowCylinder(inner_radius=0.03, thickness=0.01, length=0.04, axial=4, radial=2, circumferential=32)
COARSE = dataclasses.replace(CYLINDER, axial=2, radial=1, circumferential=20)


@pytest.mark.parametrize(
    ("kind", "cylinder", "options"),
    [
        (ehd.ModalBush, COARSE, {"tolerance": 0.05}),
        (ehd.ModalBush, CYLINDER, {}),
        (ehd.ANCFBush, CYLINDER, {}),
    ],
    ids=["modal, coarse", "modal", "nodal"],
)
def test_hexahedra_and_tetrahedra_bear_a_load_alike(kind, cylinder, options, measured):
    """Tilted, on a bore that deflects by a fifth of the clearance."""
    found = []
    for mesh in (cylinder, tet_mesh(cylinder)):
        bearing = ehd.JournalBearing(
            journal_radius=0.03 - 3e-5,
            length=0.04,
            radial_clearance=3e-5,
            lubricant=ehd.Lubricant(viscosity=0.02),
            film=ehd.FiniteLength(n_theta=60, n_z=10),
            bush=kind(mesh=mesh, material=POLYMER, **options),
        )
        found.append(ehd.equilibrium(bearing, load=(1200.0, -3800.0), speed=300.0, tilt=(1e-4, -5e-5)).film)
    hexahedra, tetrahedra = found
    assert hexahedra.bore_displacement.max() > 0.15 * 3e-5
    for name in ("minimum_gap", "peak_pressure", "friction_torque"):
        measured(name, abs(getattr(tetrahedra, name) / getattr(hexahedra, name) - 1.0), 0.01)
