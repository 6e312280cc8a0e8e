"""Figures by matplotlib, of arrays."""
