"""Viscoelastic bodies over time."""
