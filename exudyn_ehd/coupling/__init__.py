"""Everything that touches Exudyn.

Module map
----------
api           `CreateLubricatedJoint`, the handle `LubricatedJoint`, axial options `Free` and `Held`
joint_frame   where the joint is, from the arguments; axial: the constraint of `Held`
items         item numbers of a scene to carriers of a joint frame, input checks
sides         who carries a marker frame: nodes of rigid bodies, ground, any other rigid marker
kinematics    poses, rates and exact variations of the two frames, as kernels
film_element  force and Jacobian user functions, failures, accepted steps
elastic_film  the film element on a flexible bore, modal; nodal_film: on the nodes of a bush; elastic_attach: their items
modal_inertia inertia of a modal bush on a moving housing
bush_object   nodal bush as an object of a model; bush_equations: its equations; carrier: the side that carries its outer surface
solvers       which Exudyn solver is at work
results       the film now, films kept over a run, pictures; film_record: what keeps them
history       record of accepted steps; sensors: the same quantities as Exudyn sensors
display       the film in Exudyn's renderer
settings      `ConfigureSolver`
contract      what a film model offers
"""

from exudyn_ehd.coupling.api import CreateLubricatedJoint, Free, Held, LubricatedJoint
from exudyn_ehd.coupling.record.history import JointHistory, Quantity
from exudyn_ehd.coupling.run.settings import ConfigureSolver

__all__ = [
    "ConfigureSolver",
    "CreateLubricatedJoint",
    "Free",
    "Held",
    "JointHistory",
    "LubricatedJoint",
    "Quantity",
]
