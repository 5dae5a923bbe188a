from dataclasses import dataclass
from vtray.scene.vectors import Vector, Direction


@dataclass
class Sun:
    direction: object
    intensity: float = 1.0
    angle: float = 0.53


@dataclass
class SphereLight:
    location: object
    radius: float
    intensity: float = 1.0


@dataclass
class Ambient:
    intensity: float = 1.0
    distance: float = float("inf")
