"""Mechanical power that film and contacts keep or store, and the friction behind it."""

from __future__ import annotations

import numpy as np

from exudyn_ehd.joint.solved_film import SolvedFilm


def power_loss(film: SolvedFilm) -> float:
    """Mechanical power that stays in film and contacts, W; see `exudyn_ehd.joint.model.quantities.quantities`.

    What the film does to a flexible bore leaves it.
    """
    x_t, y_t, bx_t, by_t = film.journal.motion[4:8].tolist()
    fx, fy, _, mx, my, _ = film.loads.wrench.tolist()
    power = sliding_power(film) - (fx * x_t + fy * y_t - mx * by_t + my * bx_t) - stored_power(film)
    return power if film.bore is None else power - float(film.bore.load @ film.bore.rates)


def sliding_power(film: SolvedFilm) -> float:
    """Power that spin and axial speed put into film and contacts, W."""
    bx, by = film.journal.motion[2:4].tolist()
    fx, fy, fz = film.loads.wrench[:3].tolist()
    along = fz + bx * fx + by * fy  # a tilted journal slides along its own axis, not along z
    return -(friction_torque(film) * film.journal.omega + along * film.journal.axial_speed)


def stored_power(film: SolvedFilm) -> float:
    """Power that a liner and touching surfaces take up, W; see `exudyn_ehd.joint.model.quantities.quantities`."""
    p, limited, scaled = film.parts, film.limited, 0.0
    if p.liner is not None:
        scaled = p.liner.stored_power()
        if p.liner.limited:
            contact = p.liner.contact_pressure / film.scales.pressure
            scaled += _by_touching(film, p.liner.gap_slopes.rate_t, p.liner.true_rate, contact)
    elif limited is not None:
        pressed = film.solver.nothing if film.pressing is None else np.sum(film.pressing.P, axis=0)
        scaled = _by_touching(film, limited.slope, limited.rate, pressed / film.scales.pressure)
    return scaled * film.scales.pressure * p.flow_scale


def _by_touching(film: SolvedFilm, slope: np.ndarray, rate: np.ndarray, contact: np.ndarray) -> float:
    """``-sum (p_c + (1 - slope) p) dh/dt`` with the slope of the film's gap to the true gap h and h's rate, scaled."""
    return -float(np.sum(film.grid.weight * (contact + (1.0 - slope) * film.oil.P) * rate))


def friction_torque(film: SolvedFilm) -> float:
    """Friction of film and contacts on the journal about its own axis, Nm."""
    torque_scale = film.scales.shear * film.grid.reference_length**2
    couette, poiseuille = film.loads.couette, 6.0 * film.loads.s_theta
    return -torque_scale * (film.journal.omega * couette - poiseuille) + contact_torque(film)


def contact_power_loss(film: SolvedFilm) -> float:
    """Part of `sliding_power` that contact friction takes, W."""
    w = film.journal
    return 0.0 - contact_torque(film) * w.omega - float(film.loads.contact[2]) * w.axial_speed


def contact_torque(film: SolvedFilm) -> float:
    """Contact friction on the journal about its own axis, Nm."""
    if film.pressing is None:
        return 0.0
    x, y, bx, by = film.journal.motion[:4].tolist()
    fx, fy, _, mx, my, mz = film.loads.contact.tolist()
    return mz - (x * fy - y * fx - bx * mx - by * my)
