"""The oil film, numpy and numba only: grid, gap, Reynolds equation, cavitation closures, solvers, loads.

Module map
----------
grid         vertices (theta, z), control volumes, weights
arcs         bores on parts of the circle: lobes, pads and dams, their columns and rows
combinations options of a bearing that exclude or need each other
models       film models of a bearing; their grids and solvers
supply       grooves, holes, pockets
loads        integrals of pressure, shear and drag; flows through the edges; largest pressure, between the vertices too
reynolds     gap, flow through the links between vertices, and derivatives to the gap
lubricant    oil: viscosity and density laws
surfaces     shape and contact of the walls: profile, roughness, contact, wear, liner
cavitation   closures: the boundary of the full film, and the oil in the cavity
banded       factors of banded matrices and their right-hand sides
solvers      from gap and rates to pressure and fill
heat         temperature of the film
thrust       films on the end faces of a joint
"""
