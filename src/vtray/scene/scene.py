"""The scene: plain typed objects that are also the definition of the scene file.

The file format, its checks, the words of its error messages and the JSON Schema all come from the
annotations of these types, and of those in `vtray.scene.files.in_file`.
"""

import os
from collections.abc import Sequence
from typing import TYPE_CHECKING, Any

import msgspec

from vtray.base.errors import SceneError
from vtray.scene.adding import Adding
from vtray.scene.adding_lights import AddingLights
from vtray.scene.array_holder import ArrayHolder
from vtray.scene.camera import Camera
from vtray.scene.checks.checked import Checked, make_unchecked
from vtray.scene.checks.unknown_names import unknown_attribute
from vtray.scene.cones import Cones
from vtray.scene.copies import Copies
from vtray.scene.cylinders import Cylinders
from vtray.scene.light_types import (
    Ambient,
    AnyLight,
    Light,
    NeverSet,
    RectangleLight,
    Sky,
    SphereLight,
    Sun,
)
from vtray.scene.objects import Cone, Cylinder, Object, Plane, Sphere
from vtray.scene.particles.adding import AddingParticles
from vtray.scene.particles.arrows import AddingArrows
from vtray.scene.settings import RenderSettings
from vtray.scene.sky_types import Gradient
from vtray.scene.spheres import Spheres
from vtray.scene.stars import Stars, check_in_file
from vtray.scene.style import Style
from vtray.scene.vectors import Color, Direction, Vector

__all__ = [
    "Ambient",
    "AnyLight",
    "Camera",
    "Color",
    "Cone",
    "Cones",
    "Copies",
    "Cylinder",
    "Cylinders",
    "Direction",
    "Gradient",
    "Light",
    "Object",
    "Plane",
    "RectangleLight",
    "Scene",
    "Sky",
    "Sphere",
    "SphereLight",
    "Spheres",
    "Stars",
    "Sun",
    "Vector",
]


class Scene(
    msgspec.Struct,
    Adding,
    AddingLights,
    AddingArrows,
    AddingParticles,
    metaclass=Checked,
    dict=True,
):
    """All that a picture is made from.

    Its attributes may be replaced, its lists changed, and so may arrays that `Spheres`,
    `Cylinders`, `Cones` and `Copies` share; `check` looks at them again.

    Attributes
    ----------
    camera : Camera
        Where the picture is taken from; None until it is set.
    lights : list of Light, Sun, SphereLight, RectangleLight, Sky or Ambient
        The lights. Where they were never set and none was added, those of `vtray.lights.studio`
        are used; ``[]``, or `vtray.lights.none`, leaves a scene dark.
    objects : list of Sphere, Cylinder, Cone, Plane, Spheres, Cylinders, Cones, Copies or Stars
        The objects; may be empty.
    render : RenderSettings
        How the picture is taken, unless `vtray.render` is told otherwise.
    style : Style
        How the picture is drawn beside its light, unless `vtray.render` is told otherwise.

    Examples
    --------
    >>> scene = Scene()
    >>> spheres = scene.add_spheres([(0, 0, 5), (1, 0, 5)], radius=0.5, color=["red", "#00f"])
    >>> scene.camera = Camera.fit(scene)
    """

    if TYPE_CHECKING:  # what code may give, beside what the attributes hold
        camera: Camera  # where None is left, `check` raises
        objects: list[Object]
        render: RenderSettings
        style: Style

        def __init__(
            self,
            camera: Camera | None = None,
            lights: Sequence[AnyLight] = (),
            objects: Sequence[Object] = (),
            render: RenderSettings = ...,
            style: Style = ...,
        ) -> None: ...
    else:
        camera: Camera | None = None
        lights: list[AnyLight] = msgspec.field(default_factory=NeverSet)
        objects: list[Object] = msgspec.field(default_factory=list)
        render: RenderSettings = msgspec.field(default_factory=RenderSettings)
        style: Style = msgspec.field(default_factory=Style)

    def __setattr__(self, name: str, value: object) -> None:
        """Set an attribute of these; a misspelt one would be ignored by everyone."""
        if name not in self.__struct_fields__:
            raise AttributeError(_no_attribute(name))
        super().__setattr__(name, value)

    def __reduce__(self) -> tuple[Any, ...]:
        return _again, (self.camera, self.lights, self.objects, self.render, self.style)

    def check(self) -> None:
        """Check the scene after changes made in code.

        Raises
        ------
        SceneError
            If the camera is missing, or if it, a light, an object, the settings or the style are
            not of their type.
        """
        Scene(self.camera, self.lights, self.objects, self.render, self.style)
        if _is_none(self.camera):
            from vtray.scene.default_light import has_end

            remedy = "set one, for instance vtray.Camera.fit(scene)"
            if not has_end(self):
                remedy = "nothing has an end that one could show; set one by vtray.Camera.look_at"
            raise SceneError(f"Scene.camera: there is none; {remedy}")
        if any(issubclass(kind, ArrayHolder) for kind in set(map(type, self.objects))):
            for index, item in enumerate(self.objects):
                if isinstance(item, ArrayHolder):
                    item.check(f"Scene.objects[{index}]")

    def to_dict(self) -> dict[str, Any]:
        """Return the scene as a dictionary that `vtray.load_dict` makes an equal scene of.

        Returns
        -------
        dict
            What a scene file says, in Python's own types; `Spheres` are
            ``{"type": "spheres", "center": array, ...}`` with their read-only arrays, not copied,
            and `Cylinders` and `Cones` likewise; `Copies` are
            ``{"type": "copies", "objects": [...], "at": array}``.

        Raises
        ------
        SceneError
            If the scene is not valid, or holds `Stars`.
        """
        from vtray.scene.files.scene_dict import to_dict

        self.check()
        check_in_file(self.objects)
        return to_dict(self)

    def save(self, path: str | os.PathLike[str]) -> None:
        """Write the scene as indented JSON that `vtray.load` reads back as an equal scene.

        The arrays of `Spheres`, `Cylinders`, `Cones` and `Copies` go to files beside it: for
        scene.json to scene.npz, those of further ones to scene-2.npz and so on. A file of such a
        name is replaced if it belongs to the scene file that is replaced, or if these objects were
        read from it.

        Parameters
        ----------
        path : str or path
            The file to write. Each file is replaced as a whole, or left as it was; arrays are
            written first, and the JSON last.

        Raises
        ------
        SceneError
            If the scene is not valid any more, or holds `Stars`.
        OutputError
            If a file cannot be written, or one for arrays is there that is not the scene's own.
        """
        from vtray.scene.files.saving import save

        self.check()
        check_in_file(self.objects)
        save(self, path)


def _again(
    camera: Camera | None,
    lights: list[AnyLight],
    objects: list[Object],
    render: RenderSettings,
    style: Style,
) -> Scene:
    """Make a scene again after copying or pickling; lights that were never set stay so."""
    made: Scene = make_unchecked(
        Scene, camera=camera, lights=lights, objects=objects, render=render, style=style
    )
    return made


def _no_attribute(name: str) -> str:
    """Say that a scene has no such attribute, and where it belongs."""
    if name in RenderSettings.__struct_fields__:
        what, place = "a setting of the render", "render"
    elif name in Style.__struct_fields__:
        what, place = "a part of its style", "style"
    else:
        return unknown_attribute("Scene", name, Scene.__struct_fields__)
    ways = f"vtray.render(scene, {name}=...) or scene.{place} = scene.{place}.replace({name}=...)"
    return f"Scene has no attribute {name!r}, which is {what}: {ways}"


def _is_none(value: object) -> bool:
    return value is None
