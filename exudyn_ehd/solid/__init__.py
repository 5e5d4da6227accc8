"""The flexible bearing: quadratic elements in absolute nodal coordinates. Knows numpy, scipy and numba; no film.

Module map
----------
bush                what a scene writes: `ANCFBush`, `ModalBush`, `Rayleigh`; static modes of a bore
mesh                hollow cylinders; surfaces and lines of meshes; where points lie on a surface around an axis
mesh_import         users' meshes, from memory and, through meshio, from files
elements            20-node hexahedra and 10-node tetrahedra: shape functions, faces, quadratures, compiled loops
total_lagrange      a mesh with a material: force, tangent, mass, energy, stress; factors of a mesh's matrices
loads               loads on lines and surfaces, pressures
pressure_modes      pressures of oil films, and the modes that they need
journal             `ElasticJournal`, which a scene writes; its reduction to modes of its surface under the film
harmonics           finite elements of a cylinder, wave by wave around it
turning_journal     a finite-element body's own modes, which turn under the film: `FEJournal`
fe_bore             the bore of a body that a user has reduced to modes; `add_bore_modes`;
                    its nodes and faces, and their shape functions
"""
