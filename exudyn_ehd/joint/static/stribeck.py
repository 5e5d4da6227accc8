"""Friction of a steadily loaded bearing against speed: the Stribeck curve from boundary to full film lubrication."""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass, replace

import numpy as np

from exudyn_ehd.bearing import JournalBearing
from exudyn_ehd.joint.audit.resolution import warn_of_grid
from exudyn_ehd.joint.balance.limits import outside_table, warn_of_heat
from exudyn_ehd.joint.balance.position import LoadSearch, first_guess
from exudyn_ehd.joint.balance.steady_film import Place
from exudyn_ehd.joint.model.build import build_study_model
from exudyn_ehd.joint.model.rigid import Evaluation
from exudyn_ehd.joint.newton import continued
from exudyn_ehd.joint.static.steady import require_rest
from exudyn_ehd.status import ROUNDING, FilmError, InputError, require_number, require_plausible, require_type

# Smallest ratio of successive speeds, and of the mean viscosities there, without an intermediate speed. Larger: more
# film solves.
NEXT = 0.9


@dataclass(frozen=True, eq=False)
class StribeckResult:
    """Result of `stribeck`: friction and film, one entry per speed in the order given; SI units.

    Attributes
    ----------
    speeds : (n,) array
        Spin omega, rad/s.
    friction_coefficient : (n,) array
        Friction torque on the journal about its own axis / (R load).
    friction_torque, contact_torque : (n,) arrays
        Size of the friction torque on the journal, and of its part by boundary friction, N m; both positive.
    contact_load_share : (n,) array
        Contact load / load; above 1 if the film pulls the journal into the contact.
    eccentricity_ratio, minimum_gap : (n,) arrays
        e/c; minimum film thickness between the nominal surfaces, m (negative if asperities are pressed flat).
    film_ratio : (n,) array
        lambda = ``minimum_gap`` / composite roughness; nan for smooth surfaces.
    power_loss, contact_power_loss, leakage : (n,) arrays
        Power loss and its part from boundary friction, W; oil out of both ends together, m3/s.
    hersey : (n,) array
        Hersey number mu omega / (load / (2 R L)), dimensionless, with mu = ``lubricant.viscosity``, omega in rad/s.
    film_temperature, bore_displacement : (n,) arrays
        Mean film temperature, K, nan for an isothermal bearing; largest deflection of a liner or flexible bore, m, 0
        for a rigid one.
    position : (n, 2) array
        x, y of the journal axis, m.

    Examples
    --------
    After the example of `stribeck`:

    >>> curve.hersey.round(6), (1e6 * curve.minimum_gap).round(1)
    (array([5.0e-06, 1.0e-05, 1.5e-05]), array([15.1, 18.9, 20.7]))
    >>> curve.contact_load_share  # nothing touches here
    array([0., 0., 0.])
    """

    speeds: np.ndarray
    friction_coefficient: np.ndarray
    friction_torque: np.ndarray
    contact_torque: np.ndarray
    contact_load_share: np.ndarray
    eccentricity_ratio: np.ndarray
    minimum_gap: np.ndarray
    film_ratio: np.ndarray
    power_loss: np.ndarray
    contact_power_loss: np.ndarray
    leakage: np.ndarray
    hersey: np.ndarray
    film_temperature: np.ndarray
    bore_displacement: np.ndarray
    position: np.ndarray

    def __repr__(self) -> str:
        speed, friction = self.lowest_friction
        return f"<StribeckResult at {self.speeds.size} speeds: lowest friction {friction:.3g} at {speed:.4g} rad/s>"

    @property
    def lowest_friction(self) -> tuple[float, float]:
        """Speed (rad/s) and friction coefficient at the curve's minimum, among the speeds computed."""
        k = int(np.argmin(self.friction_coefficient))
        return float(self.speeds[k]), float(self.friction_coefficient[k])


def stribeck(bearing: JournalBearing, *, load: float, speeds: Sequence[float] | np.ndarray) -> StribeckResult:
    """Compute equilibrium and friction under a constant load (N, in -y on the journal) over a range of speeds.

    Every speed is a steady state, with temperature (``thermal``) and shape of the bore (``bush``) in balance. Boundary
    friction acts in full at every speed: ``GreenwoodTripp.transition_speed``, which smooths the reversal of friction in
    a joint, is not used. Speeds are solved from the fastest to the slowest, each from the last position. Intermediate
    speeds are added if no position is found or the temperature jumps. Films on end faces (``bearing.thrust``) are
    omitted.

    Parameters
    ----------
    bearing : JournalBearing
        With ``inlet=Periodic()``; a curve that turns up at low speed needs ``asperity=GreenwoodTripp(...)``.
    load : float
        Size of the external force on the journal, which acts in -y of the joint frame, N, > 0.
    speeds : sequence of float
        Spins of the journal, rad/s, all > 0, in any order.

    Returns
    -------
    StribeckResult

    Raises
    ------
    InputError
        For a load or speeds that are not positive, ``inlet=MaximumGap()``, supply areas that turn with the journal, or
        a film that conserves mass and has no source of oil.
    FilmError
        If no equilibrium was found at a speed.

    Examples
    --------
    After the example of `JournalBearing`:

    >>> curve = ehd.stribeck(bearing, load=500.0, speeds=[100.0, 200.0, 300.0])
    >>> curve.friction_coefficient.round(4)
    array([0.0173, 0.0325, 0.0479])
    """
    require_type("stribeck: bearing", bearing, JournalBearing)
    size = require_number("stribeck: load", load, "N", above=0.0, hint="it is a size, the load acts along -y.")
    values = np.atleast_1d(np.array(speeds, dtype=float))
    if values.ndim != 1 or values.size == 0 or not np.all(np.isfinite(values)) or not np.all(values > 0.0):
        raise InputError(
            f"stribeck: speeds must be finite numbers > 0 rad/s, got {speeds!r}; np.geomspace(...) spreads them well."
        )
    require_plausible("stribeck: speeds", speeds, values)
    require_rest(bearing, "stribeck")
    if bearing.asperity is not None:
        # so small that boundary friction acts in full at the slowest sliding
        slow = ROUNDING * float(values.min()) * bearing.journal_radius
        bearing = replace(bearing, asperity=replace(bearing.asperity, transition_speed=slow))
    model = build_study_model(bearing, 0.0)
    order = np.argsort(-values)
    search = LoadSearch(model, "stribeck", np.array([0.0, -size]))
    motion = np.zeros(10)
    motion[8] = values[order[0]]
    motion[:2] = first_guess(bearing, motion[8], search.load, np.zeros(2))
    rows: list[dict[str, float | np.ndarray]] = [{}] * values.size
    told = coarse = False
    found: Place | None = None
    for k in order:
        found = _follow(search, found, motion, float(values[k]))
        film, where = found.film, f"stribeck at {values[k]:.4g} rad/s"
        if message := outside_table(film):
            raise FilmError(f"{where}: {message}")
        told = told or warn_of_heat(film.temperature, film.grid, where)
        coarse = coarse or warn_of_grid(film, where)
        rows[k] = _row(found.evaluation, float(values[k]), size)
    columns = {name: np.array([row[name] for row in rows]) for name in rows[0]}
    return StribeckResult(speeds=values, **columns)


def _follow(search: LoadSearch, before: Place | None, start: np.ndarray, speed: float) -> Place:
    """Find the equilibrium at a speed by continuation from the last speed, in steps of the speed's logarithm.

    The first equilibrium starts from a motion (10,). If the temperature changes the viscosity by more than `NEXT`, the
    step is halved, because the branch of solutions may have ended or the search may have left it. If the change remains
    in the shortest step, the branch has ended, and the other one is accepted.
    """
    first = start if before is None else before.motion
    last, failure = float(first[8]), None
    way = min(math.log(speed / last), math.log(NEXT))

    def reach(share: float, here: Place | None, final: bool) -> Place | None:
        nonlocal failure
        here = before if here is None else here
        motion = (first if here is None else here.motion).copy()
        motion[8] = last * (speed / last) ** share
        try:
            found = search.find(motion, here)
        except FilmError as error:
            failure = error
            return None
        return None if here is not None and not final and _leaps(search, here, found) else found

    reached, found = continued(reach, 1.0, math.log(NEXT) / way)
    if found is None or reached < 1.0:
        raise FilmError(
            f"stribeck: no equilibrium found at {speed:.4g} rad/s under {search.size:.4g} N; next to "
            f"{last * (speed / last) ** reached:.4g} rad/s: {str(failure).removeprefix('stribeck: ')}"
        ) from failure
    return found


def _leaps(search: LoadSearch, before: Place, found: Place) -> bool:
    """Return whether the mean viscosity differs by more than `NEXT` between two films."""
    if search.thermal is None:
        return False
    one, other = (float(search.thermal.viscosity_ratio(place.temperature).mean()) for place in (before, found))
    return min(one, other) < NEXT * max(one, other)


def _row(evaluation: Evaluation, speed: float, load: float) -> dict[str, float | np.ndarray]:
    """Columns of the result at one equilibrium."""
    q, b = evaluation.quantities(), evaluation.model.bearing
    rough = b.asperity if b.asperity is not None else b.roughness
    torque = abs(q["friction_torque"])
    return {
        "friction_coefficient": torque / (b.journal_radius * load),
        "friction_torque": torque,
        "contact_torque": abs(q["contact_torque"]),
        "contact_load_share": q["contact_load"] / load,
        "eccentricity_ratio": q["eccentricity_ratio"],
        "minimum_gap": q["minimum_gap"],
        "film_ratio": np.nan if rough is None else q["minimum_gap"] / rough.composite_roughness,
        "power_loss": q["power_loss"],
        "contact_power_loss": q["contact_power_loss"],
        "leakage": q["leakage"],
        "hersey": b.lubricant.viscosity * speed * 2.0 * b.journal_radius * b.length / load,
        "film_temperature": q.get("film_temperature", np.nan),
        "bore_displacement": q.get("bore_displacement", 0.0),
        "position": evaluation.motion[:2].copy(),
    }
