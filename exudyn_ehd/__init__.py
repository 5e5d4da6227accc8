"""Elastohydrodynamic (oil-filled) revolute and cylindrical joints for Exudyn."""
