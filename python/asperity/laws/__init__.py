"""Adhesion laws."""
