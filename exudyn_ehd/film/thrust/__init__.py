"""Oil films on the end faces of a joint.

annulus   ThrustFaces and the shapes of pads; grid of an annulus in the logarithm of its radius, flows of its links
tilting   TiltingThrustPads: sectors on pivots, and their grid
face      one face or pad: film, wrench and tangent
"""
