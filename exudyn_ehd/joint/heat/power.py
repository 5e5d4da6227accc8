"""Mechanical power that film and contacts keep, and the friction behind it."""

from __future__ import annotations

from exudyn_ehd.joint.solved_film import SolvedFilm


def power_loss(film: SolvedFilm) -> float:
    """Mechanical power that film and contacts keep, W; see `exudyn_ehd.joint.model.quantities.quantities`.

    What the film does to a flexible bore leaves it.
    """
    w = film.journal
    bx, by, x_t, y_t, bx_t, by_t = w.motion[2:8].tolist()
    fx, fy, fz, mx, my, _ = film.loads.wrench.tolist()
    along = fz + bx * fx + by * fy  # a tilted journal slides along its own axis, not along z
    power = fx * x_t + fy * y_t - mx * by_t + my * bx_t
    power += friction_torque(film) * w.omega
    power += along * w.axial_speed
    if film.parts.liner is not None:
        power += film.parts.liner.stored_power() * film.scales.pressure * film.parts.flow_scale
    return -power if film.bore is None else -power - float(film.bore.load @ film.bore.rates)


def friction_torque(film: SolvedFilm) -> float:
    """Friction of film and contacts on the journal about its own axis, Nm."""
    torque_scale = film.scales.shear * film.grid.reference_length**2
    couette, poiseuille = film.loads.couette, 6.0 * film.loads.s_theta
    return -torque_scale * (film.journal.omega * couette - poiseuille) + contact_torque(film)


def contact_torque(film: SolvedFilm) -> float:
    """Contact friction on the journal about its own axis, Nm."""
    if film.pressing is None:
        return 0.0
    x, y, bx, by = film.journal.motion[:4].tolist()
    fx, fy, _, mx, my, mz = film.loads.contact.tolist()
    return mz - (x * fy - y * fx - bx * mx - by * my)
