"""Renders with a hierarchy, and without."""

from typing import Any

import pytest

import vtray
from vtray.rendering import hierarchy

ALWAYS, NEVER = 0, 10**9
"""For ``hierarchy.FEW``: use the hierarchy for one sphere already, or for none."""


def render(scene: vtray.Scene, few: int, **options: Any) -> vtray.Image:
    """Render a scene with nothing kept, for some value of ``FEW``."""
    with pytest.MonkeyPatch.context() as patch:
        patch.setattr(hierarchy, "FEW", few)
        fresh = vtray.Scene(scene.camera, scene.lights, scene.objects)
        return vtray.render(fresh, **{"threads": 1, **options})
