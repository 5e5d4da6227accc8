"""The oil film: Reynolds equation, cavitation, loads. Knows numpy and numba only; no solid, no Exudyn."""
