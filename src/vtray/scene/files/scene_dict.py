"""Scenes as Python's dictionaries: what a scene file says, with arrays in their places."""

import math
from collections.abc import Mapping
from functools import partial
from typing import Any, cast

import msgspec
from msgspec import UNSET

from vtray.base.caller_warning import warn_caller
from vtray.base.errors import SceneError
from vtray.scene.arrays import Arrays
from vtray.scene.checks.columns import array_words
from vtray.scene.checks.limits import Byte
from vtray.scene.checks.scene_words import Unknown, join, nearest, show
from vtray.scene.checks.unknown_names import explain_unknown
from vtray.scene.copies import Copies
from vtray.scene.default_light import lights_of, settings_of
from vtray.scene.files.in_file import without_integrator
from vtray.scene.files.named_materials import with_named, with_parts
from vtray.scene.files.pattern_images import PatternImages, without_image
from vtray.scene.files.scene_file import Warn, loads_bytes
from vtray.scene.light_types import AnyLight
from vtray.scene.materials import AnyMaterial, images_in, is_default
from vtray.scene.objects import ARRAY_KINDS, Object
from vtray.scene.pictures.sky_image import sky_image
from vtray.scene.scene import Scene
from vtray.scene.written_lights import as_written
from vtray.scene.written_objects import object_as_written

# Stands in the text for objects whose arrays stand in the dictionary.
_PLACEHOLDER = msgspec.Raw(
    b'{"type":"sphere","center":{"x":0,"y":0,"z":0},"radius":0,"color":{"r":0,"g":0,"b":0},"lambert":0}'
)


PICTURE_AXES = 3


@explain_unknown
def load_dict(data: Mapping[str, Any], name: str = "<dict>", *, warn: Warn | None = None) -> Scene:
    """Make a scene of a dictionary, with the checks and the words of a scene file.

    Parameters
    ----------
    data : dict
        What a scene file says. Numbers may also be NumPy's; in place of an array of the file, there
        may be a tuple or an array of NumPy. Many spheres, cylinders or cones may hold their arrays
        themselves: ``{"type": "spheres", "center": array, "radius": 0.5, "color": array,
        "lambert": 1}``, which are not copied where `Spheres` does not; so may copies hold ``"at":
        array``, and skies and patterns ``"image": array``. Paths are relative to the current
        folder.
    name : str
        What messages call the dictionary.
    warn : callable, optional
        Called with one line of text for each key or array that the format does not know;
        `warnings.warn` by default.

    Returns
    -------
    Scene
        The validated scene.

    Raises
    ------
    SceneError
        If it is not a valid scene. The message names the place, what is wrong and what would be
        right.
    """
    warnings: list[str] = []
    given = dict(data) if isinstance(data, Mapping) else data
    if isinstance(given, dict) and isinstance(given.get("objects"), (list, tuple)):
        given["objects"] = [_without_arrays(item) for item in given["objects"]]
    if isinstance(given, dict) and isinstance(given.get("lights"), (list, tuple)):
        given["lights"] = [_without_image(item) for item in given["lights"]]
    pictures: dict[str, object] = {}
    try:
        text = msgspec.json.encode(given, enc_hook=partial(_as_json, pictures))
    except (TypeError, ValueError, OverflowError, RecursionError, UnicodeEncodeError) as error:
        _check(given, "", name)
        raise SceneError(f"{name}: {error}") from None
    try:
        images = PatternImages("", pictures)
        scene = loads_bytes(text, name, images, "", warnings.append)
    except SceneError:
        # Not a number is null in JSON; say what it was.
        _check(given, "", name)
        raise
    unknown = Unknown("key")
    named = with_parts(data.get("materials", {}))
    for index, item in enumerate(with_named(item, named) for item in data["objects"]):
        if _kind_of_arrays(item) is not None or _are_copies(item):
            place = f"objects[{index}]"
            scene.objects[index] = _with_arrays(scene.objects[index], item, place, name, unknown)
    scene.lights = _with_images(scene.lights, data["lights"], name)
    for line in [*warnings, *(f"{name}: {line}" for line in unknown.lines())]:
        if warn is None:
            warn_caller(line)
        else:
            warn(line)
    return scene


def _has_image(item: object) -> bool:
    """Tell whether a light of a dictionary holds a picture itself."""
    if not isinstance(item, Mapping) or item.get("type") != "sky":
        return False
    return hasattr(item.get("image"), "__array__") or isinstance(item.get("image"), (list, tuple))


def _without_image(item: Any) -> Any:  # noqa: ANN401
    """Return a light without the picture that it holds itself."""
    if not _has_image(item):
        return item
    return {key: value for key, value in item.items() if key != "image"}


def _with_images(lights: list[AnyLight], given: Any, name: str) -> list[AnyLight]:  # noqa: ANN401
    """Return lights with the pictures that those of a dictionary hold themselves."""
    made = list(lights)
    for index, item in enumerate(given):
        if _has_image(item):
            place = f"{name}: lights[{index}].image"
            image = sky_image(item["image"], place)
            try:
                made[index] = made[index].replace(image=image)
            except SceneError as problem:
                raise SceneError(f"{place}: {str(problem).partition(': ')[2]}") from None
    return made


def to_dict(scene: Scene) -> dict[str, Any]:
    """Return a valid scene as `Scene.to_dict` does."""
    data: dict[str, Any] = {
        "camera": msgspec.to_builtins(scene.camera),
        "lights": [_light_to_dict(light) for light in lights_of(scene)],
        "objects": [_object_to_dict(item) for item in scene.objects],
    }
    render, integrator = without_integrator(settings_of(scene))
    more = {"render": render, "style": scene.style, "integrator": integrator}
    told = {key: msgspec.to_builtins(value) for key, value in more.items() if value is not UNSET}
    return {**data, **{key: value for key, value in told.items() if value}}


def _light_to_dict(light: AnyLight) -> dict[str, Any]:
    """Return a light as what a scene file says of it, or with the pixels of its picture."""
    written = as_written(light, lambda image: image.pixels)
    pixels = {key: written.pop(key) for key in ("image",) if key in written}
    return {**msgspec.to_builtins(written), **pixels}


def _object_to_dict(item: Object) -> dict[str, Any]:
    """Return an object as what a scene file says of it, or with its arrays."""
    if isinstance(item, Copies):
        objects = [_object_to_dict(part) for part in item.objects]
        return {"type": item.__struct_config__.tag, "objects": objects, "at": item.at}
    if not isinstance(item, Arrays):
        plain: dict[str, Any] = msgspec.to_builtins(object_as_written(item), enc_hook=without_image)
        if "material" in plain:
            plain["material"] = _material_to_dict(item.material)
        return plain
    values: dict[str, Any] = {"type": item.__struct_config__.tag}
    for key, column in item.COLUMNS.items():
        value = getattr(item, key)
        if column.kind is Byte and value is not None and value.ndim == 1:
            values[key] = dict(zip("rgb", value.tolist(), strict=True))
        elif value is not None:
            values[key] = value
    if not is_default(item.material):
        values["material"] = _material_to_dict(item.material)
    return values


def _material_to_dict(material: Any) -> Any:  # noqa: ANN401
    """Return materials as what a scene file says of them, or with the pixels of their pictures."""
    if isinstance(material, tuple):
        return [_material_to_dict(one) for one in material]
    written = msgspec.to_builtins(material, enc_hook=without_image)
    for image in images_in(material):
        written["pattern"]["image"] = image.pixels
    return written


def _kind_of_arrays(item: object) -> type[Arrays] | None:
    """Return what an object is whose arrays stand in it, not in a file; None for any other."""
    if not isinstance(item, Mapping) or "data" in item:
        return None
    tag = item.get("type")
    return ARRAY_KINDS.get(tag) if isinstance(tag, str) else None


def _are_copies(item: object) -> bool:
    """Tell whether an object says that it is copies."""
    return isinstance(item, Mapping) and item.get("type") == Copies.__struct_config__.tag


def _is_array(at: object) -> bool:
    """Tell whether places are rows of numbers, not what a scene file says of each."""
    if isinstance(at, (list, tuple)):
        return len(at) > 0 and not isinstance(at[0], Mapping)
    return hasattr(at, "__array__") or hasattr(at, "__dlpack__")


def _without_arrays(item: Any) -> Any:  # noqa: ANN401
    """Return an object with something that a file may hold in the place of its arrays."""
    if _kind_of_arrays(item) is not None:
        return _PLACEHOLDER
    if not _are_copies(item):
        return item
    plain = dict(item)
    if isinstance(plain.get("objects"), (list, tuple)):
        plain["objects"] = [_without_arrays(part) for part in plain["objects"]]
    if _is_array(plain.get("at")):
        plain["at"] = []
    return plain


def _with_arrays(
    read: Object, item: Mapping[str, Any], place: str, name: str, unknown: Unknown
) -> Object:
    """Return an object that was read without its arrays with those of a dictionary."""
    kind = _kind_of_arrays(item)
    if kind is not None:
        return cast("Object", _from_dict(kind, item, place, name, unknown))
    if not isinstance(read, Copies):
        return read
    pairs = enumerate(zip(read.objects, item["objects"], strict=True))
    objects = [
        _with_arrays(part, given, f"{place}.objects[{k}]", name, unknown)
        for k, (part, given) in pairs
    ]
    at = item["at"] if _is_array(item.get("at")) else read.at
    try:
        made = Copies.from_arrays({"objects": objects, "at": at}, f"{place}.")
    except SceneError as problem:
        raise SceneError(f"{name}: {problem}") from None
    return made if read.source is None else made.read_from(read.source)


def _from_dict(
    kind: type[Arrays], item: Mapping[str, Any], place: str, name: str, unknown: Unknown
) -> Arrays:
    """Make objects of the arrays in a dictionary; note the unknown keys."""
    known = ["type", *kind.COLUMNS, "material"]
    strange = [key for key in item if key not in known]
    for key, column in kind.COLUMNS.items():
        if key not in item and not column.stand_in:
            close = nearest(key, list(map(str, strange)), cutoff=0.6)
            hint = f" (is {close} meant for it?)" if close else ""
            words = f"missing; expected {array_words(column)}{hint}"
            raise SceneError(f"{name}: {place}.{key}: {words}")
    given = {key: item[key] for key in kind.COLUMNS if key in item}
    for key, value in given.items():
        is_color = kind.COLUMNS[key].kind is Byte and isinstance(value, Mapping)
        if is_color and set(value) == {"r", "g", "b"}:
            given[key] = [value[channel] for channel in "rgb"]
    if "material" in item:
        given["material"] = _material_of(item["material"], f"{name}: {place}.material")
    try:
        made = kind.from_arrays(given, f"{place}.")
    except SceneError as problem:
        raise SceneError(f"{name}: {problem}") from None
    for key in strange:
        unknown.add(join(place, str(key)), str(key), known)
    return made


def _material_of(given: Any, place: str) -> Any:  # noqa: ANN401
    """Return materials as a file says them, or as they are."""
    if isinstance(given, (list, tuple)):
        return [_material_of(one, f"{place}[{k}]") for k, one in enumerate(given)]
    if not isinstance(given, Mapping):
        return given
    try:
        return msgspec.convert(given, AnyMaterial, dec_hook=PatternImages(""))
    except msgspec.ValidationError as error:
        if isinstance(error.__cause__, SceneError):
            raise SceneError(f"{place}.pattern.image: {error.__cause__}") from None
        raise SceneError(f"{place}: {error}") from None


def _as_json(pictures: dict[str, object], value: object) -> object:
    """Turn what NumPy makes, and any mapping, into what JSON knows.

    An array that can only be the picture of a pattern is kept, and a text stands for it that is no
    path.
    """
    if isinstance(value, Mapping):
        return dict(value)
    if getattr(value, "ndim", 0) == PICTURE_AXES:
        name = f"\0{len(pictures)}"
        pictures[name] = value
        return name
    if hasattr(value, "tolist"):
        return value.tolist()
    raise TypeError(type(value).__name__)


def _check(value: Any, place: str, name: str) -> None:  # noqa: ANN401
    """Raise SceneError for the first value that JSON has no way to write."""
    found = value.tolist() if hasattr(value, "tolist") else value
    where = f"{name}: {place}" if place else name
    if isinstance(found, Mapping):
        for key, part in found.items():
            if not isinstance(key, str):
                raise SceneError(f"{where}: expected keys that are texts, got {show(key)}")
            _check(part, join(place, key), name)
    elif isinstance(found, (list, tuple)):
        for index, part in enumerate(found):
            _check(part, f"{place}[{index}]", name)
    elif isinstance(found, float) and not math.isfinite(found):
        raise SceneError(f"{where}: expected a finite number, got {found!r}")
    elif isinstance(found, int):
        try:
            float(found)
        except OverflowError:
            words = "a number within the range of a double, up to about 1.8e308"
            raise SceneError(f"{where}: expected {words}, got {show(found)}") from None
    elif not isinstance(found, (float, str, msgspec.Raw, type(None))):
        words = "a number, a text, a list or a dictionary"
        raise SceneError(f"{where}: expected {words}, got {show(found)}")
