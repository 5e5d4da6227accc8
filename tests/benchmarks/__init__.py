"""Benchmarks: measured times, and limits that they must keep."""
