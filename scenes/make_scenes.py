"""Makes the example scenes of this folder, always the same.

    python scenes/make_scenes.py            writes the scene files
    python scenes/make_scenes.py --render   renders them into docs/images as well

All scenes use the axes of a camera that looks along z: x points right, y points DOWN, z points
away from the viewer. So a floor has a larger y than what stands on it.
"""

import argparse
import json
import math
from collections.abc import Callable, Sequence
from itertools import pairwise
from pathlib import Path
from typing import Any

from PIL import Image as PillowImage

import vtray
from vtray import (
    Ambient,
    Camera,
    Color,
    Direction,
    Light,
    Plane,
    RectangleLight,
    RenderSettings,
    Scene,
    Sphere,
    SphereLight,
    Vector,
)

Triple = tuple[float, float, float]
AnyLight = Light | SphereLight | RectangleLight | Ambient
Object = Sphere | Plane

SCENES = Path(__file__).resolve().parent
IMAGES = SCENES.parent / "docs" / "images"
GOLDEN_ANGLE = math.pi * (3 - math.sqrt(5))  # Turned by it, no two leaves stand in line.
UP, DOWN, TOWARDS_VIEWER = (0, -1, 0), (0, 1, 0), (0, 0, -1)


# ---- parts that the scenes share -------------------------------------------------------------


def camera(center: Triple, normal: Triple, focus: float, width: float) -> Camera:
    """Return a camera of 800 x 600 pixels whose image plane is `width` wide."""
    pixel = width / 800
    return Camera(Vector(*center), Direction(*normal), focus, (800, 600), (pixel, pixel))


def ball(center: Triple, radius: float, color: Triple) -> Sphere:
    """Return a sphere that scatters all light of its colour."""
    return Sphere(Vector(*center), radius, Color(*color), 1)


def wall(center: Triple, normal: Triple, color: Triple) -> Plane:
    """Return a plane that scatters all light of its colour."""
    return Plane(Vector(*center), Direction(*normal), Color(*color), 1)


def light(place: Triple, intensity: float) -> Light:
    """Return a point light."""
    return Light(Vector(*place), intensity)


def lamp(center: Triple, radius: float, intensity: float) -> SphereLight:
    """Return a shining ball, whose shadows are soft."""
    return SphereLight(Vector(*center), radius, intensity)


def lit(view: Camera, lights: list[AnyLight], objects: list[Object]) -> Scene:
    """Return a scene whose pictures have smooth edges."""
    return Scene(view, lights, objects, RenderSettings(samples=9))


def blend(colors: Sequence[Triple], place: float) -> Triple:
    """Return the colour at a place from 0 to 1 along a row of colours."""
    step = min(max(place, 0), 1) * (len(colors) - 1)
    first, second = list(pairwise(colors))[min(int(step), len(colors) - 2)]
    share = step - min(int(step), len(colors) - 2)
    r, g, b = (round(a + share * (b - a)) for a, b in zip(first, second, strict=True))
    return r, g, b


# ---- the scenes ------------------------------------------------------------------------------


def first() -> Scene:
    """Three balls on a floor under two lights: the scene to start from."""
    return Scene(
        camera=camera((0, -1.3, 0), (0, 0.5, 1), focus=6, width=6),
        lights=[light((-7, -13, -3), 1), light((4, -11, -8), 0.7)],
        objects=[
            wall((0, 1, 0), UP, (225, 230, 240)),
            ball((-2.3, 0, 3), 1, (255, 80, 70)),
            ball((0, -0.5, 4.2), 1.5, (255, 205, 60)),
            ball((2.2, 0.2, 2.8), 0.8, (60, 150, 255)),
        ],
    )


def room() -> Scene:
    """Four balls in a room: a shining panel in its ceiling, and light from its open front."""
    # The image plane is the open front of the room; the fourth wall would be behind it.
    walls = [
        wall((0, 1.52, 0), UP, (205, 193, 178)),
        wall((0, -1.52, 0), DOWN, (185, 180, 172)),
        wall((0, 0, 4.23), TOWARDS_VIEWER, (235, 230, 220)),
        wall((-2.02, 0, 0), (1, 0, 0), (250, 100, 75)),
        wall((2.02, 0, 0), (-1, 0, 0), (55, 185, 195)),
    ]
    balls = [
        ball((-0.85, 0.72, 2.9), 0.8, (205, 202, 195)),
        ball((0.85, 0.97, 2.3), 0.55, (195, 150, 45)),
        ball((-0.3, 1.17, 1.5), 0.35, (70, 115, 205)),
        ball((1.25, 1.27, 1.3), 0.25, (210, 95, 120)),
    ]
    panel = RectangleLight(
        Vector(0, -1.41, 2.2), (Vector(1.4, 0, 0), Vector(0, 0, 1.4)), 1, visible=True
    )
    lights = [panel, lamp((-0.8, -0.2, -6), 2.5, 0.5), Ambient(0.35, distance=0.8)]
    return lit(camera((0, 0, 0), (0, 0, 1), 4.2, 4), lights, [*walls, *balls])


# Element, then the place in ångströms; 3D conformer of PubChem, compound 2519.
CAFFEINE = """
O 0.4700 2.5688 0.0006, O -3.1271 -0.4436 -0.0003, N -0.9686 -1.3125 0.0000,
N 2.2182 0.1412 -0.0003, N -1.3477 1.0797 -0.0001, N 1.4119 -1.9372 0.0002,
C 0.8579 0.2592 -0.0008, C 0.3897 -1.0264 -0.0004, C 0.0307 1.4220 -0.0006,
C -1.9061 -0.2495 -0.0004, C 2.5032 -1.1998 0.0003, C -1.4276 -2.6960 0.0008,
C 3.1926 1.2061 0.0003, C -2.2969 2.1881 0.0007, H 3.5163 -1.5787 0.0008,
H -1.0451 -3.1973 -0.8937, H -2.5186 -2.7596 0.0011, H -1.0447 -3.1963 0.8957,
H 4.1992 0.7801 0.0002, H 3.0468 1.8092 -0.8992, H 3.0466 1.8083 0.9004,
H -1.8087 3.1651 -0.0003, H -2.9322 2.1027 0.8881, H -2.9346 2.1021 -0.8849
"""
# Van der Waals radius in ångströms, and colour.
ELEMENTS: dict[str, tuple[float, Triple]] = {
    "H": (1.10, (250, 250, 250)),
    "C": (1.70, (150, 158, 172)),
    "N": (1.55, (80, 125, 255)),
    "O": (1.52, (245, 60, 50)),
}


def molecule() -> Scene:
    """Caffeine: atoms of the true size, with the colours that chemists use."""
    atoms = []
    for atom in CAFFEINE.split(","):
        element, *place = atom.split()
        radius, color = ELEMENTS[element]
        atoms.append(ball(turn_molecule(*map(float, place)), radius, color))
    backdrop = [wall((0, 0, 20), TOWARDS_VIEWER, (205, 220, 235))]
    lights = [lamp((-12, -14, -14), 5, 0.7), Ambient(0.6)]
    return lit(camera((0.15, -0.35, -6), (0, 0, 1), 22, 10), lights, [*backdrop, *atoms])


def turn_molecule(x: float, y: float, z: float) -> Triple:
    """Turn the flat molecule so that it shows its thickness."""
    lean, spin = math.radians(35), math.radians(20)
    x, y = x * math.cos(spin) - y * math.sin(spin), x * math.sin(spin) + y * math.cos(spin)
    return x, y * math.cos(lean) - z * math.sin(lean), y * math.sin(lean) + z * math.cos(lean)


def spiral() -> Scene:
    """610 balls in a flower, placed as a sunflower places its seeds."""
    petals = [(255, 225, 90), (255, 150, 60), (240, 70, 90), (150, 70, 200), (60, 130, 235)]
    count, power, size = 610, 0.72, 3.0
    balls = []
    for index in range(count):
        place = (index + 0.5) / count
        distance, angle = size * place**power, index * GOLDEN_ANGLE
        # Each ball takes its share of the area around the centre.
        area = 2 * math.pi * power * size**2 * place ** (2 * power - 1) / count
        radius = 0.5 * math.sqrt(area)
        height = 1.3 * (1 - (distance / size) ** 2)
        center = (distance * math.cos(angle), -radius - height, distance * math.sin(angle))
        balls.append(ball(center, radius, blend(petals, distance / size)))
    floor = wall((0, 0, 0), UP, (70, 85, 130))
    lights = [lamp((-5, -9, -7), 2.5, 0.7), Ambient(0.6)]
    return lit(camera((0, -3.4, -2.6), (0, 1, 0.75), 10, 6.1), lights, [floor, *balls])


class Jar:
    """A round jar of invisible glass that balls are dropped into."""

    def __init__(self, radius: float, cell: float) -> None:
        """Make an empty jar."""
        self.radius = radius
        self.cell = cell  # At least the diameter of the largest ball.
        self.columns: dict[tuple[int, int], list[tuple[float, float, float, float]]] = {}

    def drop(self, x: float, z: float, radius: float) -> Triple:
        """Let a ball fall and roll to where it lies still; return its place, height first."""
        best = (self.landing(x, z, radius), x, z)
        step = radius / 2
        while step > radius / 200:
            tries = [(best[1] + step * dx, best[2] + step * dz) for dx, dz in ROLLS]
            lowest = min((self.landing(*spot, radius), *spot) for spot in tries)
            if lowest < best:
                best = lowest
            else:
                step /= 2
        height, x, z = best
        column = self.columns.setdefault(self.cell_of(x, z), [])
        column.append((height + radius, x, z, radius))
        column.sort(reverse=True)
        return best

    def landing(self, x: float, z: float, radius: float) -> float:
        """Return the height at which a ball that falls at a spot first touches something."""
        if x * x + z * z > (self.radius - radius) ** 2:
            return math.inf
        height = radius
        column_x, column_z = self.cell_of(x, z)
        for dx in (-1, 0, 1):
            for dz in (-1, 0, 1):
                for top, other_x, other_z, other in self.columns.get(
                    (column_x + dx, column_z + dz), []
                ):
                    if top + radius <= height:
                        break  # This ball and those below it lie too low to matter.
                    room = (radius + other) ** 2 - (x - other_x) ** 2 - (z - other_z) ** 2
                    if room > 0:
                        height = max(height, top - other + math.sqrt(room))
        return height

    def cell_of(self, x: float, z: float) -> tuple[int, int]:
        """Return the cell of the ground that a spot is in."""
        return math.floor(x / self.cell), math.floor(z / self.cell)


ROLLS = [(1, 0), (0.7, 0.7), (0, 1), (-0.7, 0.7), (-1, 0), (-0.7, -0.7), (0, -1), (0.7, -0.7)]


def packing() -> Scene:
    """1000 balls of many sizes, dropped one by one into a jar of invisible glass."""
    layers = [(60, 90, 220), (40, 180, 200), (120, 215, 110), (255, 215, 70), (250, 95, 80)]
    jar = Jar(radius=1.5, cell=0.44)
    balls = []
    for index in range(1000):
        # Multiples of these fractions look random but leave no gaps.
        size, right, back = (index * step % 1 for step in (0.8191725, 0.6710436, 0.5497005))
        radius = 0.1 + 0.12 * size**2
        x, z = 1.7 * (right - 0.5), 1.7 * (back - 0.5)
        height, x, z = jar.drop(x, z, radius)
        balls.append(ball((x, -height, z), radius, blend(layers, height / 3.8)))
    table = wall((0, 0, 0), UP, (240, 235, 225))
    lights = [lamp((-7, -11, -9), 2.5, 0.7), Ambient(0.6)]
    return lit(camera((0, -3.9, -4.4), (0, 0.48, 1), 9, 4.5), lights, [table, *balls])


def inside() -> Scene:
    """Four equal shells, each with a ball, on their way through the image plane.

    Nothing behind the image plane exists: it cuts open the shells that reach behind it, and the
    light falls in. A lamp of its own lights the shell with the small opening.
    """
    shells = [
        ((-1.4, -1.15, -0.6), (255, 120, 90), (80, 190, 235)),
        ((1.4, -1.15, 0), (255, 205, 85), (130, 115, 240)),
        ((-1.4, 1.15, 0.6), (110, 215, 140), (235, 95, 130)),
        ((1.4, 1.15, 1.2), (95, 165, 250), (255, 190, 70)),
    ]
    objects: list[Sphere | Plane] = [wall((0, 0, 2.6), TOWARDS_VIEWER, (75, 85, 115))]
    for (x, y, z), outer, inner in shells:
        objects += [ball((x, y, z), 1, outer), ball((x, y + 0.2, z + 0.55), 0.35, inner)]
    own = lamp((-1.7, 0.7, 0.4), 0.12, 0.35)
    lights = [lamp((-5, -6, -11), 1.5, 0.75), lamp((1, 0, -12), 3, 0.3), Ambient(0.4), own]
    return lit(camera((0, 0, 0), (0, 0, 1), 12, 6.4), lights, objects)


MAKERS: list[Callable[[], Scene]] = [first, room, molecule, spiral, packing, inside]


# ---- the files -------------------------------------------------------------------------------


def to_text(scene: Scene) -> str:
    """Return a scene as JSON with one light or object on each line."""
    data = json.loads(json.dumps(scene.to_dict()), parse_float=rounded)
    view = ",\n".join(
        f"    {json.dumps(key)}: {json.dumps(data['camera'][key])}" for key in data["camera"]
    )
    parts = [f'  "camera": {{\n{view}\n  }}']
    parts += [f'  "{key}": [\n{one_per_line(data[key])}\n  ]' for key in ("lights", "objects")]
    if "render" in data:
        parts.append(f'  "render": {json.dumps(data["render"])}')
    return "{\n" + ",\n".join(parts) + "\n}\n"


def one_per_line(items: list[Any]) -> str:
    """Return the items of a JSON array, each on a line of its own."""
    return ",\n".join(f"    {json.dumps(item)}" for item in items)


def rounded(number: str) -> float:
    """Round a number to five decimals, and turn 2.0 into 2."""
    short = round(float(number), 5)
    return int(short) if short.is_integer() else short


def main() -> None:
    """Write the scene files, and their pictures if asked to."""
    parser = argparse.ArgumentParser(description="Make the example scenes.")
    parser.add_argument("--render", action="store_true", help="also render them to docs/images")
    render = parser.parse_args().render
    for maker in MAKERS:
        path = SCENES / f"{maker.__name__}.json"
        path.write_text(to_text(maker()), encoding="utf-8", newline="\n")
        if render:
            picture = vtray.render(vtray.load(path))
            # As small as it gets: vtray itself would rather be quick.
            small = PillowImage.fromarray(picture.pixels)
            small.save(IMAGES / f"{maker.__name__}.png", optimize=True)


if __name__ == "__main__":
    main()
