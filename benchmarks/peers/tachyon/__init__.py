"""Tachyon."""
