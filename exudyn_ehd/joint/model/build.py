"""From a bearing's description to its model: the only place that asks whether an effect is present."""

from __future__ import annotations

from exudyn_ehd.bearing import JournalBearing, MaximumGap
from exudyn_ehd.film.solvers.impedance_map import ImpedanceMap
from exudyn_ehd.film.surfaces.wall import WallContact
from exudyn_ehd.joint.model.compile import compile_kernels
from exudyn_ehd.joint.model.impedance import ImpedanceModel
from exudyn_ehd.joint.model.rheology import collect_rheology
from exudyn_ehd.joint.model.rigid import BearingModel
from exudyn_ehd.joint.model.surfaces import liner_of, surface_effects
from exudyn_ehd.joint.seams import Effects, ShearFactor, ShearProduct
from exudyn_ehd.status import InputError


def collect_effects(bearing: JournalBearing, start_angle: float = 0.0) -> Effects:
    """The effects that a bearing names, in scaled form, on the grid that starts at ``start_angle``."""
    wall = None if bearing.contact is None else WallContact(bearing.contact, bearing.radial_clearance)
    rheology = collect_rheology(bearing)
    surfaces = surface_effects(bearing, start_angle)
    return Effects(
        limiter=wall if wall is not None else surfaces.limiter,
        gap_terms=surfaces.gap_terms,
        wear=surfaces.wear,
        liner=liner_of(bearing),
        contacts=(() if wall is None else (wall,)) + surfaces.contacts,
        flux=surfaces.flux + rheology.flux,
        pressure_law=rheology.pressure_law,
        shear_factor=_one_shear_factor(rheology.shear_factor, surfaces.shear_factor),
        thermal=rheology.thermal,
        density=rheology.density,
        uneven_drag=surfaces.uneven_drag,
    )


def _one_shear_factor(first: ShearFactor | None, second: ShearFactor | None) -> ShearFactor | None:
    if first is not None and second is not None:
        return ShearProduct(first, second)
    return second if first is None else first


def _model(bearing: JournalBearing, start_angle: float) -> BearingModel:
    effects = collect_effects(bearing, start_angle)
    if bearing.bush is None or effects.liner is not None:
        return BearingModel(bearing, start_angle=start_angle, effects=effects)
    # imported here: a rigid bearing needs no solid
    from exudyn_ehd.joint.model.build_flexible import elastic_model

    return elastic_model(bearing, start_angle, effects)


def build_study_model(bearing: JournalBearing, start_angle: float) -> BearingModel:
    """Model of a bearing for one prescribed position; ``start_angle`` is where a film with `MaximumGap` starts, rad."""
    model = _model(bearing, start_angle)
    compile_kernels(model)
    return model


def build_model(bearing: JournalBearing) -> BearingModel | ImpedanceModel:
    """Model of a bearing for a moving journal.

    Raises
    ------
    InputError
        If the bearing is described by something else, or by an option that only a prescribed position allows.
    """
    if not isinstance(bearing, JournalBearing):
        raise InputError(f"bearing must be a JournalBearing(...), got {bearing!r}.")
    if isinstance(bearing.inlet, MaximumGap):
        raise InputError(
            "JournalBearing.inlet=MaximumGap() is for prescribed positions only: the line of maximum gap is "
            "undefined for a concentric journal and jumps with a moving one; use inlet=Periodic()."
        )
    if isinstance(bearing.film, ImpedanceMap):
        return ImpedanceModel(bearing)
    model = _model(bearing, 0.0)
    compile_kernels(model)
    return model
