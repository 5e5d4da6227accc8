"""Closed forms to compare with: long and short bearings, Petroff, thick cylinders, rings."""
