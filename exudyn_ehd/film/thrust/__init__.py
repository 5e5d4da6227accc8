"""Oil films on the end faces of a joint.

options   ThrustFaces and the shapes of pads: TaperLand, StepLand
annulus   grid of an annulus in the logarithm of its radius, and what its links carry
face      one face: film, wrench and tangent
"""
