"""Shape functions of bores of any mesh: partition of unity, reproduction of fields, loads with the right resultants."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest

import exudyn_ehd as ehd
from exudyn_ehd.solid.fe_bore import OUTSIDE, ReducedBore, quadrature
from exudyn_ehd.solid.mesh import patch

RADIUS, LENGTH, AROUND, ALONG = 0.03, 0.06, 16, 3


def triangles(nodes):
    """Cylinder of triangles of three or six nodes, mid nodes on the cylinder."""
    step = 2 if nodes == 6 else 1
    around, along = step * AROUND, step * ALONG
    theta, z = np.meshgrid(
        2 * np.pi * np.arange(around) / around, LENGTH * (np.arange(along + 1) / along - 0.5), indexing="ij"
    )
    positions = np.stack([RADIUS * np.cos(theta), RADIUS * np.sin(theta), z], axis=-1).reshape(-1, 3)

    def number(i, j):
        return (i % around) * (along + 1) + j

    faces = []
    for i in range(0, around, step):
        for j in range(0, along, step):
            a, b, c, d = (i, j), (i + step, j), (i + step, j + step), (i, j + step)
            for corner in ((a, b, c), (a, c, d)):
                row = [number(*p) for p in corner]
                if nodes == 6:
                    for p, q in ((0, 1), (1, 2), (2, 0)):
                        row.append(number((corner[p][0] + corner[q][0]) // 2, (corner[p][1] + corner[q][1]) // 2))
                faces.append(row)
    return replace(patch(positions, np.array(faces)), tolerance=OUTSIDE)


def quadrilaterals():
    mesh = ehd.HollowCylinder(
        inner_radius=RADIUS, thickness=0.01, length=LENGTH, axial=ALONG, radial=1, circumferential=AROUND
    ).mesh()
    return mesh.bore


MAKERS = {"3": lambda: triangles(3), "6": lambda: triangles(6), "8": quadrilaterals}


@pytest.mark.parametrize("kind", MAKERS)
def test_fields_are_reproduced(kind):
    faces = MAKERS[kind]()
    theta, z, _ = quadrature(LENGTH)
    S = faces.interpolation(theta, z)
    # to rounding: constants, and the axial position, which is linear in every element
    np.testing.assert_allclose(S @ np.ones(S.shape[1]), 1.0, rtol=0, atol=1e-13)
    np.testing.assert_allclose(S @ faces.positions[:, 2], z, rtol=0, atol=1e-13)
    # cos 2 theta to the interpolation error of elements of 0.39 rad: h^2/8 times 4 linear, h^3/64 times 8 quadratic
    field = np.cos(2 * np.arctan2(faces.positions[:, 1], faces.positions[:, 0]))
    error = np.abs(S @ field - np.cos(2 * theta)).max()
    h = 2 * np.pi / AROUND
    assert error < (4 * h**2 / 8 if kind == "3" else 8 * h**3 / 64) * 1.1


@pytest.mark.parametrize("kind", MAKERS)
def test_rigid_motions_of_a_bore_leave_its_gap_alone(kind):
    """Translations and rotations about any axis, of 1 m and 1 rad per unit;
    faceted bores have their nodes on the cylinder only."""
    faces = MAKERS[kind]()
    modes = [np.tile(e, (len(faces.positions), 1)) for e in np.eye(3)]
    modes += [np.cross(e, faces.positions) for e in np.eye(3)]
    bore = ReducedBore(
        faces=faces, displacements=np.stack(modes, axis=2), stiffness_matrix=np.eye(6), radius=RADIUS, length=LENGTH
    )
    theta, z = np.linspace(-3, 3, 21), np.linspace(-0.5, 0.5, 7) * LENGTH
    residual = np.abs(bore.radial(theta, z)).max(axis=(0, 1))
    # translations to rounding; rotations move facets' points, whose radius is short by h^2/8 = 2 %
    assert residual[:3].max() < 1e-12
    assert residual[3:].max() < (0.025 if kind == "3" else 0.002) * RADIUS
    np.testing.assert_allclose(bore.rigid[:3, :3], np.eye(3), rtol=0, atol=1e-12)
    np.testing.assert_allclose(bore.rigid[3:, 3:], np.eye(3), rtol=0, atol=0.03)


def test_points_off_the_bore_are_named():
    with pytest.raises(ehd.InputError, match="must lie on the surface"):
        triangles(6).interpolation(np.zeros(1), np.array([0.6 * LENGTH]))
