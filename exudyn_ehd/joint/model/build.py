"""Model from a bearing's description: the only place that asks whether an effect is present."""

from __future__ import annotations

from dataclasses import replace

from exudyn_ehd.bearing import JournalBearing, MaximumGap
from exudyn_ehd.film.solvers.impedance_map import ImpedanceMap
from exudyn_ehd.film.surfaces.elastic_liner import ElasticLiner
from exudyn_ehd.film.surfaces.wall import WallContact
from exudyn_ehd.joint.model.compile import compile_kernels
from exudyn_ehd.joint.model.effects import collect_rheology, surface_effects
from exudyn_ehd.joint.model.impedance import ImpedanceModel
from exudyn_ehd.joint.model.rigid import BearingModel
from exudyn_ehd.joint.seams import Effects, shear_product
from exudyn_ehd.status import InputError


def collect_effects(bearing: JournalBearing, start_angle: float = 0.0) -> Effects:
    """The effects that a bearing names, in scaled form, on the grid that starts at ``start_angle``."""
    oil, surfaces = collect_rheology(bearing), surface_effects(bearing, start_angle)
    if bearing.contact is not None:
        wall = WallContact(bearing.contact, bearing.radial_clearance)
        surfaces = replace(surfaces, limiter=wall, contacts=(wall, *surfaces.contacts))
    return replace(
        surfaces,
        gap_terms=surfaces.gap_terms + oil.gap_terms,
        flux=surfaces.flux + oil.flux,
        pressure_law=oil.pressure_law,
        shear_factor=shear_product(oil.shear_factor, surfaces.shear_factor),
        thermal=oil.thermal,
        density=oil.density,
        liner=bearing.bush if isinstance(bearing.bush, ElasticLiner) else None,
        uneven_drag=surfaces.uneven_drag or oil.uneven_drag,
    )


def build_study_model(bearing: JournalBearing, start_angle: float) -> BearingModel:
    """Model of a bearing for one prescribed position; ``start_angle`` is where a film with `MaximumGap` starts, rad."""
    effects = collect_effects(bearing, start_angle)
    if (bearing.bush is None and bearing.journal is None) or effects.liner is not None:
        model = BearingModel(bearing, start_angle=start_angle, effects=effects)
    else:
        # imported here: a rigid bearing needs no solid
        from exudyn_ehd.joint.model.build_flexible import elastic_model

        model = elastic_model(bearing, start_angle, effects)
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
    return build_study_model(bearing, 0.0)
