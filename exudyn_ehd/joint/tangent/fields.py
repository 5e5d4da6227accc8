"""From fields of sensitivities to the motion of a rigid journal."""

from __future__ import annotations

import numpy as np

from exudyn_ehd.film.reynolds.gap import contract_pose
from exudyn_ehd.film.reynolds.link_derivatives import Sensitivities
from exudyn_ehd.joint.solved_film import SolvedFilm


def add_by_motion(film: SolvedFilm, sens: Sensitivities, gradient: np.ndarray) -> None:
    """Add to ``gradient`` (k, 10) that to (scaled pose and rates, vx, vz) of functionals with ``sens`` to the film's
    gap, which becomes that to the true gap."""
    p, z, f = film.parts, film.grid.z, film.limited
    if f is not None:
        sens.face[:] *= f.face_slope
        sens.cell[:] = sens.cell * f.slope + sens.rate * f.bend
        sens.rate[:] *= f.slope
    pose, rates = np.zeros((len(gradient), 4)), np.zeros((len(gradient), 4))
    contract_pose(sens.cell, p.directions.cos_x, p.directions.sin_x, z, pose)
    contract_pose(sens.face, p.directions.cos_f, p.directions.sin_f, z, pose)
    contract_pose(sens.rate, p.directions.cos_x, p.directions.sin_x, z, rates)
    gradient += np.concatenate((pose, rates, sens.speed), axis=1)
