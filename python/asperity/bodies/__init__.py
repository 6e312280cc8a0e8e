"""Elastic bodies and walls of springs."""
