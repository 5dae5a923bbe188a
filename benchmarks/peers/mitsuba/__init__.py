"""Mitsuba 3."""
