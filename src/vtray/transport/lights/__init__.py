"""Lights: a module for each kind, and a dispatcher."""
