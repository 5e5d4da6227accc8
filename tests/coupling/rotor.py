"""A rotor of steel under a constant load in one bearing, rigid or with a bush of steel."""

import scenes

import exudyn_ehd as ehd

RADIUS, LENGTH, CLEARANCE = 0.025, 0.05, 25e-6


def rotor(bush=None, **options):
    bearing = ehd.JournalBearing(
        journal_radius=RADIUS,
        length=LENGTH,
        radial_clearance=CLEARANCE,
        lubricant=ehd.Lubricant(viscosity=0.02),
        film=ehd.FiniteLength(n_theta=48, n_z=6),
        bush=bush,
        **options,
    )
    return scenes.loaded_journal(bearing, (600.0, -1800.0, 0.0))


def run(mbs, end_time=2e-3, steps=20):
    mbs.SolveDynamic(scenes.settings(end_time, steps, tolerance=1e-8))


def steel_bush(kind):
    cylinder = ehd.HollowCylinder(
        inner_radius=RADIUS + CLEARANCE, thickness=0.015, length=LENGTH, axial=1, radial=1, circumferential=16
    )
    material = ehd.SaintVenantKirchhoff(youngs_modulus=2.1e11, poisson_ratio=0.3, density=7800.0)
    return kind(mesh=cylinder, material=material, **({"tolerance": 0.2} if kind is ehd.ModalBush else {}))
