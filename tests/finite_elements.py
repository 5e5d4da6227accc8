"""Exudyn's finite-element interface of a mesh of this package."""

import numpy as np
from exudyn.FEM import FEMinterface

from exudyn_ehd.solid.total_lagrange import TotalLagrange


def fem_of(mesh, material):
    """FEMinterface with the mass and stiffness of a mesh."""
    solid = TotalLagrange(mesh=mesh, material=material)
    fem = FEMinterface()
    fem.nodes = {"Position": mesh.nodes}
    fem.elements = [{"Name": "solid", "Hex20": mesh.elements}]
    fem.stiffnessMatrix = solid.tangent(np.zeros_like(mesh.nodes)).tocsr()
    fem.massMatrix = solid.mass.tocsr()
    fem.VolumeToSurfaceElements()
    return fem
