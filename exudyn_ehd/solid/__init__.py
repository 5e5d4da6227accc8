"""The flexible bearing: 20-node hexahedra in absolute nodal coordinates. Knows numpy, scipy and numba; no film."""
