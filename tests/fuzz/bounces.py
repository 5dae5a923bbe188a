"""Random scenes of all materials, taken in all ways: what is promised of their pictures.

No number of threads, tile or hierarchy changes a bit; copies are what they are written out; light
is neither below 0 nor infinite, and under a white sky nothing is brighter than that; a traced pixel
tells the light that the picture shows; a scene that is larger by a power of two looks the same; and
a picture that is replayed has the same bytes.
"""

import json
import random as python_random
from pathlib import Path
from typing import Any

import numba
import numpy as np
from written_out import written_out_file

import vtray
from fuzz import copies, lights, looks, truth
from fuzz.promises import run_quietly
from vtray.rendering import hierarchy as acceleration

Scene = dict[str, Any]
Random = np.random.Generator

SIZE = [4, 3] if numba.config.DISABLE_JIT else [12, 9]
"""Of the pictures."""

PADDED = 0.0 if numba.config.DISABLE_JIT else 0.85
"""How many scenes hold something of each kind, so that few kernels serve them, from 0 to 1."""

LARGER = 2.0**7
"""By that a scene becomes larger, and must look the same."""

LENGTHS = {
    *("radius", "radius_end", "size", "distance", "thickness"),
    *("focus", "focus_distance", "resolution"),
}
PLACES = {"center", "start", "end", "location", "edges", "at", "focus_on"}


def attempt(random: python_random.Random, folder: Path) -> None:
    """Take a picture of a random scene in random ways."""
    numbers = np.random.default_rng(random.randrange(2**63))
    scene = truth.random_scene(numbers)
    if numbers.random() < 0.3:
        scene = truth.with_cylinders(numbers, scene)
    scene = with_copies_and_lamps(numbers, scene, 0.6)
    scene = looks.with_camera(numbers, looks.with_looks(numbers, scene, folder))
    if numbers.random() < PADDED:
        scene = looks.padded(numbers, scene)
    how = looks.settings(numbers, scene)
    keep(scene, how, folder)
    fault = fault_of(scene, how, folder)
    if fault is not None:
        raise AssertionError(fault)


def with_copies_and_lamps(random: Random, scene: Scene, lamps: float) -> Scene:
    """Return a scene without colours of halves, with copies, and with soft lights so often."""
    for item in scene["objects"]:
        item.pop("color_end", None)
    if random.random() < copies.SHARE:
        scene = copies.with_copies(random, scene)
    if random.random() < lamps:
        scene = lights.with_soft_lights(random, scene)
    return scene


def keep(scene: Scene, how: dict[str, Any], folder: Path) -> None:
    """Write down what is tried, in the size of all pictures."""
    scene["render"] = {"size": SIZE}
    (folder / "scene.json").write_text(json.dumps(scene, indent=1))
    (folder / "how.json").write_text(json.dumps(how))


def fault_of(scene: Scene, how: dict[str, Any], folder: Path) -> str | None:
    """Return what is wrong with the pictures of a scene; None for nothing."""
    try:
        first = taken(scene, folder, truth.FEW, how)
    except vtray.VtrayError as error:
        words = str(error)
        return None if words.isprintable() and ": " in words else f"unclear error: {words}"
    return (
        _fault_of_light(first)
        or _fault_of_repetition(scene, how, folder, first)
        or _fault_of_energy(scene, how, folder)
        or _fault_of_relighting(scene, how, folder)
    )


def taken(scene: Scene, folder: Path, few: int, how: dict[str, Any], **more: Any) -> vtray.Image:
    """Return the picture of a scene, rendered with a hierarchy from so many shapes on."""
    file = folder / "scene.json"
    file.write_text(json.dumps(scene))
    before = acceleration.FEW, acceleration.LEAF
    acceleration.FEW = acceleration.LEAF = few
    try:
        return vtray.render(vtray.load(file), warn=str, **{"threads": 1, **how, **more})
    finally:
        acceleration.FEW, acceleration.LEAF = before


def _fault_of_light(image: vtray.Image) -> str | None:
    """Return what is wrong with the light of a picture by itself."""
    parts = {"light": image.linear, "light with the sky": image.with_sky, "albedo": image.albedo}
    parts["alpha"], parts["error"] = image.alpha, image.error
    # The filter of Mitchell and Netravali takes light away at edges.
    least = -np.inf if image.settings.filter == "mitchell" else 0.0
    for name, part in parts.items():
        is_right = np.isfinite(part) & (part >= least)
        if not is_right.all():
            where = np.argwhere(~is_right)[0]
            return f"{name} is not finite, or below 0, first at {where.tolist()}"
    if not image.white >= 0:
        return f"white is {image.white}"
    image.develop(16)
    return None


def _fault_of_repetition(
    scene: Scene, how: dict[str, Any], folder: Path, first: vtray.Image
) -> str | None:
    """Return what of the picture depends on what must not matter."""
    plain = written_out_file(scene)
    others: dict[str, vtray.Image] = {
        "threads and tiles": taken(scene, folder, truth.FEW, how, threads=2, tile=3),
        "the hierarchy": taken(scene, folder, truth.ALL, how),
    }
    if plain != scene and not _are_copies_one(scene):
        others["copies"] = taken(plain, folder, truth.ALL, how)
    grown = larger(scene)
    is_number = "Infinity" not in json.dumps(grown)
    if how.get("fog") is None and is_number and not has_length_of_its_own(scene):
        others["the size"] = taken(grown, folder, truth.FEW, how)
    for name, other in others.items():
        if other.linear.tobytes() != first.linear.tobytes():
            row, column = np.argwhere((other.linear != first.linear).any(axis=2))[0]
            return f"{name}: another picture, first at {column},{row}"
        if other.pixels.tobytes() != first.pixels.tobytes():
            return f"{name}: other pixels of the same light"
    return _fault_of_traced(first) or _fault_of_replay(scene, folder, how)


def _are_copies_one(scene: Scene) -> bool:
    """Tell whether copies of an object are one in some way in which those written out are not."""
    borders = scene.get("style", {}).get("outline", {}).get("borders")
    copied = [one for item in scene["objects"] for one in item.get("objects", [])]
    return borders == "objects" or any(0 < one.get("opacity", 1.0) < 1 for one in copied)


def _fault_of_energy(scene: Scene, how: dict[str, Any], folder: Path) -> str | None:
    """Return where smooth surfaces under a white sky are brighter than that."""
    if not numba.config.DISABLE_JIT:
        return None  # few lights need kernels of their own
    if how["integrator"] == "path" and "plastic" in json.dumps(scene):
        return None  # a single path may bring more, as others bring less
    sky = {"type": "sky", "radiance": 1.0}
    plain = {**scene, "objects": _smooth(scene["objects"]), "lights": [sky]}
    more = {"firefly": "off", "samples": 1, "fog": False, "outline": False}
    image = taken(plain, folder, truth.FEW, how, **more)
    most = float(image.linear.max(initial=0.0)) / 255.0
    return None if most <= 1 + 1e-9 else f"under a white sky, something is {most} as bright"


def _fault_of_relighting(scene: Scene, how: dict[str, Any], folder: Path) -> str | None:
    """Return whether a picture with other lights and colours is not what a new one would be."""
    if how["integrator"] != "direct":
        return None
    image = taken(scene, folder, truth.ALL, how, keep_lights=True)
    changed = image.relight([0.25 * (k % 3) for k in range(len(scene["lights"]))])
    changed = changed.recolor(0, "teal")
    fresh = vtray.render(changed.scene, threads=2, warn=str, keep_lights=True, **how)
    if changed.linear.tobytes() != fresh.linear.tobytes():
        return "with other lights and colours, it is not what a new render gives"
    return None if np.array_equal(changed.pixels, fresh.pixels) else "relit, it has other pixels"


def _smooth(part: Any) -> Any:
    """Return a part of a scene without what is rough, and with nothing that shines brighter."""
    if isinstance(part, list):
        return [_smooth(one) for one in part]
    if not isinstance(part, dict):
        return part
    found = {key: _smooth(value) for key, value in part.items() if key != "roughness"}
    return found | {"radiance": 1.0} if part.get("type") == "emissive" else found


def _fault_of_traced(image: vtray.Image) -> str | None:
    """Return where a traced pixel is not told as the picture shows it."""
    if image.scene.camera.projection == "panorama" or image.style.fog:
        return None
    height, width = image.linear.shape[:2]
    for y in range(0, height, 2):
        for x in range(y % 3, width, 3):
            tree = vtray.trace_pixel(image, x, y)
            if not str(tree).replace("\n", "").isprintable():
                return f"the words of {x},{y} hold what cannot be printed"
            if image.samples[y, x] > 1 and tree.path and image.settings.filter == "box":
                count = int(image.settings.samples)
                told = [vtray.trace_pixel(image, x, y, k).light for k in range(count)]
                if not np.allclose(np.mean(told, axis=0), image.linear[y, x], rtol=1e-9):
                    return f"the samples of {x},{y} are told as {told}"
            elif image.samples[y, x] == 1 and tree.light != tuple(image.linear[y, x]):
                return f"{x},{y} is told as {tree.light}, and is {image.linear[y, x]}"
    return None


def _fault_of_replay(scene: Scene, folder: Path, how: dict[str, Any]) -> str | None:
    """Return whether a picture that is replayed is another."""
    pictures = [folder / "one.png", folder / "two.png"]
    image = taken(scene, folder, truth.ALL, how)
    image.save(pictures[0])
    file = str(folder / "scene.json")
    run_quietly(["-q", "-t", "2", "--replay", str(pictures[0]), file, str(pictures[1])])
    one, two = (picture.read_bytes() for picture in pictures)
    return None if one == two else "replayed, it has other bytes"


def has_length_of_its_own(part: Any) -> bool:
    """Tell whether a part of a scene has a pattern of a size that it does not say."""
    if isinstance(part, list):
        return any(map(has_length_of_its_own, part))
    if not isinstance(part, dict):
        return False
    is_pattern = part.get("type") in ("checker", "stripes", "image")
    return (is_pattern and "size" not in part) or any(map(has_length_of_its_own, part.values()))


def larger(scene: Scene) -> Scene:
    """Return a scene that is larger, with all of its lengths."""

    def grown(value: Any) -> Any:
        if isinstance(value, dict):
            return {key: grown(part) for key, part in value.items()}
        if isinstance(value, list):
            return [grown(part) for part in value]
        return value * LARGER if isinstance(value, (int, float)) else value

    def walked(value: Any) -> Any:
        if isinstance(value, list):
            return [walked(part) for part in value]
        if not isinstance(value, dict):
            return value
        found = {}
        for key, part in value.items():
            is_length = key in PLACES or (key in LENGTHS and key != "size")
            is_length |= key == "size" and "type" in value  # of a pattern, and not of a picture
            found[key] = grown(part) if is_length else walked(part)
            if key == "absorption":
                found[key] = [share / LARGER for share in part]
        return found

    grown_scene: Scene = walked(scene)
    return grown_scene
