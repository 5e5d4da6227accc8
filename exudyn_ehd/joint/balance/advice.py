"""What to do about films that can't be evaluated."""

from __future__ import annotations

from exudyn_ehd.film.lubricant.pressure_viscosity import BarusPressure
from exudyn_ehd.film.surfaces.elastic_liner import ElasticLiner
from exudyn_ehd.joint.balance.hot_oil import ROOM
from exudyn_ehd.status import Status


def advice(status: Status, bearing: object) -> str:
    """What to do about a failed evaluation of this bearing; `Status.advice` where the bearing changes nothing."""
    if status is Status.NO_FILM and isinstance(getattr(bearing, "bush", None), ElasticLiner):
        return (
            "the gap closed somewhere, most likely at an end, where an ElasticLiner carries no pressure and does not "
            "deflect: name contact=RegularisedWall(onset=...) or asperity=GreenwoodTripp(...), which press on the "
            "liner too, or reduce the load or the step size."
        )
    thermal = getattr(bearing, "thermal", None)
    grows = any(getattr(getattr(thermal, side, None), "expansion", 0.0) > 0.0 for side in ("bush", "journal"))
    if status is Status.NO_FILM and grows:
        return (
            "the gap closed somewhere, and the growth of bush and journal takes part in it: where the journal outgrows "
            f"the clearance the bearing seizes; {ROOM} {status.advice}"
        )
    law = getattr(getattr(bearing, "lubricant", None), "pressure_law", None)
    if status is Status.NO_PRESSURE and law is not None:
        barus = "use RoelandsPressure instead of BarusPressure, " if isinstance(law, BarusPressure) else ""
        return (
            f"the pressure runs away: with {type(law).__name__} no finite pressure carries a film that is pressed "
            "together as fast as here, and between rigid surfaces none carries more than a mean pressure (force / "
            f"diameter / length) of some 1 / coefficient = {1.0 / law.coefficient:.3g} Pa; reduce loads and speeds of "
            f"approach (initial velocities), check the law's coefficient, {barus}or name an elastic liner or bush."
        )
    oil, closure = getattr(bearing, "lubricant", None), getattr(bearing, "cavitation", None)
    if (
        status is Status.NOT_CONVERGED
        and getattr(oil, "density_law", None)
        and not getattr(closure, "conserves_mass", True)
    ):
        # rho dh/dt is there, h drho/dt, which would hold the pressure, is not
        return (
            f"{status.advice} With a density_law and {type(closure).__name__}, which keeps no account of the oil, thin "
            "films that are pressed together fast may have no pressure: what oil takes in as it gets denser is left "
            "out; cavitation=ElrodAdams(...) counts it, or take density_law=None."
        )
    return status.advice
