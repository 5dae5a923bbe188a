"""The camera of a scene: its type, which is part of the scene file's definition, and its makers."""

from typing import TYPE_CHECKING

import msgspec

from vtray.scene.checks.checked import Frozen
from vtray.scene.checks.limits import FieldError, Positive, PositivePair, Projection, SizePair
from vtray.scene.checks.unknown_names import explain_unknown
from vtray.scene.placing import look_at as views
from vtray.scene.placing.directions import are_parallel, unit
from vtray.scene.vectors import Direction, Vector

if TYPE_CHECKING:
    from numpy.typing import ArrayLike

    from vtray.scene.array_holder import ArrayHolder
    from vtray.scene.placing.bounds import HasObjects
    from vtray.scene.vectors import Triple


class Camera(Frozen, frozen=True, gc=False, omit_defaults=True):
    """A pinhole camera: an image plane and an eye behind it.

    `Camera.fit`, `Camera.look_at` and `Camera.orthographic` make one without any of these numbers.

    Attributes
    ----------
    center : Vector
        Centre of the image plane, in world space.
    normal : Direction
        Where the camera looks, in world space, square to the image plane.
    focus : float
        Distance from the eye to the image plane, in scene units, > 0.
    size : tuple of int
        Width and height of the image, in pixels.
    resolution : tuple of float
        Width and height of one pixel on the image plane, in scene units, > 0.
    up : Direction, optional
        What points up in the image, as far as it is square to `normal`, to which it must not be
        parallel. Without it, the axes are those of the first rule of the picture.
    projection : str, optional
        "perspective": all rays start in the eye. "orthographic": each ray runs along `normal`, from
        the plane through the eye through its pixel.
    """

    center: Vector
    normal: Direction
    focus: Positive
    size: SizePair
    resolution: PositivePair
    up: Direction | None = None
    projection: Projection = "perspective"

    if TYPE_CHECKING:  # what code may give, beside what the attributes hold

        def __init__(
            self,
            center: "Vector | Triple",
            normal: "Direction | Vector | Triple",
            focus: float,
            size: tuple[int, int],
            resolution: tuple[float, float],
            up: "Direction | Vector | Triple | None" = None,
            projection: Projection = "perspective",
        ) -> None: ...

    def __post_init__(self) -> None:
        """Hold the size as integers, also where it was written as 256.0, and look at `up`."""
        width, height = self.size
        msgspec.structs.force_setattr(self, "size", (int(width), int(height)))
        if self.up is not None and are_parallel(unit(self.up), unit(self.normal)):
            raise FieldError("up", "a direction that is not parallel to normal")

    @classmethod
    @explain_unknown
    def look_at(
        cls,
        eye: "Vector | Triple",
        target: "Vector | Triple",
        up: "Direction | Vector | Triple" = (0, 1, 0),
        fov_degrees: float = 40.0,
        size: tuple[int, int] = (800, 600),
    ) -> "Camera":
        """Return a camera that looks from one point to another, in perspective.

        The target is in the middle of the picture: in the pixel of column width / 2 and row
        height / 2. Pixels are square.

        Parameters
        ----------
        eye, target
            Points in world space, not the same.
        up
            What points up in the picture; not parallel to the line from eye to target.
        fov_degrees
            The *vertical* field of view, the angle between the picture's top and bottom as seen
            from the eye, in degrees, > 0 and < 180.
        size
            Width and height of the picture in pixels.

        Returns
        -------
        Camera
            Its image plane is so near the eye, at 2**-20 (a millionth) of the distance to the
            target, that nothing in view is lost before it. As in all scenes, what lies behind it,
            and so behind the viewer, casts no shadow.

        Raises
        ------
        SceneError
            If an argument is not right.
        """
        return cls(**views.looking("Camera.look_at", eye, target, up, size, fov_degrees, None))

    @classmethod
    @explain_unknown
    def orthographic(
        cls,
        eye: "Vector | Triple",
        target: "Vector | Triple",
        height: float,
        up: "Direction | Vector | Triple" = (0, 1, 0),
        size: tuple[int, int] = (800, 600),
    ) -> "Camera":
        """Return a camera whose rays are parallel: what is far looks as large as what is near.

        Parameters
        ----------
        eye, target
            Points in world space, not the same: the picture is taken along the line from one to the
            other, and shows what lies beyond the plane through `eye` square to it. The target is in
            the middle of the picture, in the pixel of column width / 2 and row height / 2.
        height
            Height of what the picture shows, in scene units, > 0. Pixels are square.
        up
            What points up in the picture; not parallel to the line from eye to target.
        size
            Width and height of the picture in pixels.

        Raises
        ------
        SceneError
            If an argument is not right.
        """
        return cls(**views.looking("Camera.orthographic", eye, target, up, size, None, height))

    @classmethod
    @explain_unknown
    def fit(
        cls,
        subject: "HasObjects | ArrayHolder | ArrayLike",
        direction: "Direction | Vector | Triple" = (0, 0, -1),
        up: "Direction | Vector | Triple | None" = None,
        margin: float = 0.05,
        projection: Projection = "perspective",
        fov_degrees: float = 40.0,
        size: tuple[int, int] = (800, 600),
    ) -> "Camera":
        """Return the camera that shows all objects as large as the picture allows.

        In perspective, it stands as near as can be; orthographic, its pixels are as small as can
        be. The silhouettes of all spheres, cylinders and cones, not only their centres, are in the
        picture, touch the margin on two opposite sides, and are in the middle between the other
        two. Planes have no edge, and count only for `up`.

        Parameters
        ----------
        subject
            A scene, `Spheres`, `Cylinders`, `Cones`, `Copies`, or points of shape (n, 3).
        direction
            Where the camera looks, in world space.
        up
            What points up in the picture. By default the normal of the scene's first plane, on the
            side of the objects, or (0, 1, 0) without one; where that is parallel to `direction`
            within 0.06 degrees, (0, 1, 0), and where that is too, (0, 0, 1).
        margin
            What stays free at each side, as a share of the picture's width and height, from 0 to
            less than 0.5.
        projection
            "perspective" or "orthographic".
        fov_degrees
            The vertical field of view in degrees, > 0 and < 180; only for perspective.
        size
            Width and height of the picture in pixels.

        Returns
        -------
        Camera
            Its image plane is in front of all objects. In perspective, it is so near the eye that
            of planes too nothing in view is lost; orthographic, it is 16 times the size of what is
            seen in front of them.

        Raises
        ------
        SceneError
            If there is no bounded shape, or an argument is not right.
        """
        from vtray.scene.placing.camera_fit import fitting

        return cls(**fitting(subject, direction, up, margin, projection, fov_degrees, size))

    def resized(self, size: tuple[int, int]) -> "Camera":
        """Return a camera with the same view at another size of the picture.

        The pixels get larger or smaller, in both directions by the same factor, so that the whole
        former view is in the picture: from -width/2 to width/2 pixels across, and likewise down. A
        picture of another shape shows more at two sides.

        Parameters
        ----------
        size
            Width and height of the picture in pixels.

        Raises
        ------
        SceneError
            If `size` is not right.
        """
        width, height = views.argument("Camera.resized", "size", size, SizePair)
        factor = max(self.size[0] / width, self.size[1] / height)
        across, down = self.resolution
        return self.replace(size=(width, height), resolution=(across * factor, down * factor))
