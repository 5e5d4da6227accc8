"""The flexible bearing: quadratic elements in absolute nodal coordinates. Knows numpy, scipy and numba; no film.

Module map
----------
bush                what a scene writes: `ANCFBush`, `ModalBush`, `Rayleigh`; static modes of a bore
mesh                hollow cylinders; surfaces and lines of meshes
unrolled            faces on a cylinder: where points lie on them, where they meet and end
mesh_import         users' meshes, from memory and, through meshio, from files
elements            20-node hexahedra and 10-node tetrahedra: shape functions, faces, quadratures, compiled loops
total_lagrange      a mesh with a material: force, tangent, mass, energy
loads               loads on lines and surfaces, pressures
stress              Cauchy and von Mises stress at nodes and at any point
linear              factors of a mesh's matrices
pressure_modes      pressures of oil films, and the modes that they need
journal             elastic journals: cylinders by harmonics, their modes
fe_bore             the bore of a body that a user has reduced to modes; `add_bore_modes`;
                    its nodes and faces, and their shape functions
"""
