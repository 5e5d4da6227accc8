"""Tests and benchmarks of `exudyn_ehd`; a package so that benchmarks can share what they measure."""
