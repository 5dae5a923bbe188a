"""Light on materials beside Mitsuba's, in linear light.

    python -m measures.materials PYTHON

PYTHON is that of an environment with Mitsuba. Each scene is rendered by both, in several pictures
with other random numbers, and means over blocks of pixels are compared with their standard errors.
"""

# ruff: noqa: ANN401

import json
import subprocess
import sys
import tempfile
from pathlib import Path
from typing import Any, NamedTuple

import numpy as np

import vtray as vt
from vtray.rendering import pack_looks
from vtray.scene.metals import METALS

SCRIPT = Path(__file__).resolve().parents[1] / "peers" / "mitsuba" / "mitsuba_materials.py"

SIZE, BLOCK, PICTURES = 48, 8, 8
EYE, TARGET, FOV = (0.0, -6.5, 4.0), (0.0, 0.0, 0.75), 32.0
BALLS = [((1.35, 0.3, 0.5), 0.5, (200, 90, 60)), ((-1.3, 0.4, 0.4), 0.4, (70, 130, 200))]
FLOOR = (205, 200, 190)


class Case(NamedTuple):
    """A material beside Mitsuba's, and its light.

    Attributes
    ----------
    material, color, bsdf
        The material, the colour of the ball, and the same in Mitsuba's words.
    sky
        The radiance of the sky.
    lamps
        Place, radius and radiance of ball lamps.
    samples
        Those of each picture.
    emits
        The radiance of the ball, for Mitsuba.
    """

    material: Any
    color: Any
    bsdf: dict[str, Any]
    sky: float = 0.0
    lamps: Any = (((-4.0, -5.0, 6.0), 0.8, 15.0),)
    samples: int = 256
    emits: float = 0.0


def rgb(color: Any) -> dict[str, Any]:
    """Return a colour in Mitsuba's words."""
    return {"type": "rgb", "value": [channel / 255 for channel in color]}


def rough(name: str, roughness: float, **more: Any) -> dict[str, Any]:
    """Return a rough surface in Mitsuba's words."""
    return {"type": name, "distribution": "ggx", "alpha": roughness**2, **more}


GOLD = {
    name: {"type": "srgb", "color": list(part), "unbounded": True}
    for name, part in zip(("eta", "k"), METALS["gold"], strict=True)
}
GLASS = {"int_ior": 1.5, "ext_ior": 1.0}
RED = (180, 60, 50)
WHITE = (255, 255, 255)
MANY = tuple(
    ((3.0 * np.cos(k), 3.0 * np.sin(2.4 * k) - 1, 4 + 0.02 * k), 0.05, 60.0) for k in range(100)
)

CASES = {
    "matt": Case("lambert", RED, {"type": "diffuse", "reflectance": rgb(RED)}),
    "mirror": Case(
        "mirror",
        (240, 220, 200),
        {"type": "conductor", "material": "none", "specular_reflectance": rgb((240, 220, 200))},
    ),
    "gold": Case(vt.Metal("gold"), WHITE, {"type": "conductor", **GOLD}),
    "rough-gold": Case(
        vt.Metal("gold", roughness=0.2), WHITE, rough("roughconductor", 0.2, **GOLD)
    ),
    "glass": Case("glass", WHITE, {"type": "dielectric", **GLASS}, sky=0.5, lamps=()),
    "rough-glass": Case(
        vt.Glass(roughness=0.2), WHITE, rough("roughdielectric", 0.2, **GLASS), sky=0.5, lamps=()
    ),
    "thin-glass": Case(
        vt.Glass(thin=True), WHITE, {"type": "thindielectric", **GLASS}, sky=0.5, lamps=()
    ),
    "plastic": Case(
        vt.Plastic(1.5), RED, {"type": "plastic", **GLASS, "diffuse_reflectance": rgb(RED)}
    ),
    "rough-plastic": Case(
        vt.Plastic(1.5, 0.2),
        RED,
        rough("roughplastic", 0.2, **GLASS, diffuse_reflectance=rgb(RED)),
    ),
    "blend": Case(
        vt.Blend("lambert", vt.Metal("gold", roughness=0.2), 0.3),
        RED,
        {
            "type": "blendbsdf",
            "weight": 0.3,
            "a": {"type": "diffuse", "reflectance": rgb(RED)},
            "b": rough("roughconductor", 0.2, **GOLD, specular_reflectance=rgb(RED)),
        },
    ),
    "emissive": Case(
        vt.Emissive(3),
        RED,
        {"type": "diffuse", "reflectance": rgb((0, 0, 0))},
        emits=3.0,
        sky=0.5,
        lamps=(),
    ),
    "a hundred lamps": Case(
        vt.Metal("gold", roughness=0.2),
        WHITE,
        rough("roughconductor", 0.2, **GOLD),
        lamps=MANY,
    ),
}


def ours(case: Case, seed: int) -> np.ndarray:
    """Return one picture, 1 for white."""
    scene = vt.Scene()
    scene.add_plane((0, 0, 0), normal=(0, 0, 1), color=FLOOR)
    scene.add_sphere((0, 0, 1), 1, color=case.color, material=case.material)
    for center, radius, color in BALLS:
        scene.add_sphere(center, radius, color=color)
    scene.lights = [
        vt.SphereLight(place, radius, radiance=radiance) for place, radius, radiance in case.lamps
    ]
    if case.sky:
        scene.add_light(vt.Sky(case.sky))
    scene.camera = camera()
    image = vt.render(
        scene, integrator="path", samples=case.samples, depth=7, filter="box", seed=seed, exposure=1
    )
    return image.linear / 255


def camera() -> vt.Camera:
    """Return the camera."""
    return vt.Camera.look_at(EYE, target=TARGET, up=(0, 0, 1), fov_degrees=FOV, size=(SIZE, SIZE))


def theirs(case: Case) -> dict[str, Any]:
    """Return the scene in Mitsuba's words."""
    matt = {"type": "twosided", "b": {"type": "diffuse", "reflectance": rgb(FLOOR)}}
    # vtray's floor begins at the image plane.
    center, normal = camera().center, camera().normal
    begin = center.y + center.z * normal.z / normal.y
    far = [[500.0, 0, 0, 0], [0, 500.0, 0, begin + 500.0], [0, 0, 1, 0], [0, 0, 0, 1]]
    scene = {
        "type": "scene",
        "integrator": {"type": "path", "max_depth": 9, "rr_depth": 20},
        "floor": {"type": "rectangle", "to_world": far, "bsdf": matt},
        "ball": {"type": "sphere", "center": [0, 0, 1], "radius": 1, "bsdf": case.bsdf},
        "sensor": {
            "type": "perspective",
            "fov": FOV,
            "fov_axis": "x",
            "principal_point_offset_x": -0.5 / SIZE,
            "principal_point_offset_y": -0.5 / SIZE,
            "to_world": look_at(),
            "film": {
                "type": "hdrfilm",
                "width": SIZE,
                "height": SIZE,
                "rfilter": {"type": "box"},
                "pixel_format": "rgb",
            },
            "sampler": {"type": "independent"},
        },
    }
    if case.emits:
        radiance = [case.emits * channel / 255 for channel in case.color]
        scene["ball"]["emitter"] = {"type": "area", "radiance": {"type": "rgb", "value": radiance}}
    for k, (center, radius, color) in enumerate(BALLS):
        bsdf = {"type": "diffuse", "reflectance": rgb(color)}
        scene[f"ball{k}"] = {"type": "sphere", "center": center, "radius": radius, "bsdf": bsdf}
    black = {"type": "diffuse", "reflectance": rgb((0, 0, 0))}
    for k, (place, radius, radiance) in enumerate(case.lamps):
        light = {"type": "area", "radiance": {"type": "rgb", "value": [radiance] * 3}}
        lamp = {"type": "sphere", "center": place, "radius": radius, "bsdf": black}
        scene[f"lamp{k}"] = {**lamp, "emitter": light}
    if case.sky:
        radiance = {"type": "rgb", "value": [case.sky] * 3}
        scene["sky"] = {"type": "constant", "radiance": radiance}
    return {"scene": scene, "samples": case.samples, "pictures": PICTURES}


def look_at() -> list[list[float]]:
    """Return the matrix of the camera."""
    forward = np.subtract(TARGET, EYE)
    forward /= np.linalg.norm(forward)
    left = np.cross((0, 0, 1), forward)
    left /= np.linalg.norm(left)
    columns = np.stack([left, np.cross(forward, left), forward, EYE], axis=1)
    return [*columns.tolist(), [0.0, 0.0, 0.0, 1.0]]


def blocks(pictures: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """Return the means of blocks, and their standard errors."""
    count = SIZE // BLOCK
    means = pictures.reshape(PICTURES, count, BLOCK, count, BLOCK, 3).mean(axis=(2, 4))
    return means.mean(axis=0), means.std(axis=0, ddof=1) / np.sqrt(PICTURES)


def main() -> None:
    """Compare all scenes."""
    names = sys.argv[2:] or list(CASES)
    # Mitsuba does not give back what facets take from each other: for once, it is left out.
    table = pack_looks._table  # noqa: SLF001
    pack_looks._table = lambda kind, ratio, spread: (  # noqa: SLF001
        table(kind, ratio, spread) if kind == pack_looks.PLASTIC else np.ones(pack_looks.NODES + 2)
    )
    with tempfile.TemporaryDirectory() as folder:
        scenes = Path(folder) / "scenes.json"
        scenes.write_text(json.dumps({name: theirs(CASES[name]) for name in names}))
        subprocess.run([sys.argv[1], SCRIPT, scenes, folder], check=True, stdout=subprocess.DEVNULL)
        for name in names:
            mitsuba, their_error = blocks(np.load(Path(folder) / f"{name}.npy"))
            vtray, our_error = blocks(np.stack([ours(CASES[name], k) for k in range(PICTURES)]))
            error = np.sqrt(their_error**2 + our_error**2)
            off = (vtray - mitsuba) / np.maximum(error, 1e-9)
            whole = vtray.mean() / mitsuba.mean() - 1
            sure = np.sqrt((error**2).sum()) / mitsuba.sum()
            print(
                f"{name:16} {100 * whole:+.3f} % ± {100 * sure:.3f} %, "
                f"blocks off by rms {np.sqrt(np.mean(off**2)):.2f} of their error, "
                f"{100 * np.mean(np.abs(off) > 3):.1f} % by more than 3",
                flush=True,
            )


if __name__ == "__main__":
    main()
