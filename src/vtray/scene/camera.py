"""The camera of a scene: its type, which is part of the scene file's definition, and its makers."""

from collections.abc import Sequence
from typing import TYPE_CHECKING

import msgspec

from vtray.base.errors import SceneError
from vtray.base.number import number_of
from vtray.scene.checks.checked import Frozen
from vtray.scene.checks.limits import (
    FieldError,
    FlatProjection,
    Positive,
    PositivePair,
    Projection,
    SizePair,
)
from vtray.scene.checks.unknown_names import explain_unknown
from vtray.scene.lens import Lens, check_lens
from vtray.scene.placing import look_at as views
from vtray.scene.placing.directions import are_parallel, unit
from vtray.scene.placing.panorama import looking_around
from vtray.scene.vectors import Direction, Vector

if TYPE_CHECKING:
    import numpy as np
    from numpy.typing import ArrayLike, NDArray

    from vtray.scene.array_holder import ArrayHolder
    from vtray.scene.placing.bounds import HasObjects
    from vtray.scene.vectors import Triple

AHEAD: "Triple" = (0, 0, -1)
"""Where `Camera.fit` looks unless it is told."""


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
        the plane through the eye through its pixel. "panorama": all directions around `center`,
        where the eye is then; the picture is a turn wide and half a turn high, `focus` and
        `resolution` say nothing, and there is no image plane, so that everything exists.
    lens : Lens, optional
        A lens in the place of the pinhole, which blurs what is not at the distance of its focus.
        The picture needs `samples`.
    """

    center: Vector
    normal: Direction
    focus: Positive
    size: SizePair
    resolution: PositivePair
    up: Direction | None = None
    projection: Projection = "perspective"
    lens: Lens | None = None

    if TYPE_CHECKING:  # what code may give, beside what the attributes hold

        def __init__(
            self,
            center: "Vector | Triple",
            normal: "Direction | Vector | Triple",
            focus: float,
            size: Sequence[int],
            resolution: Sequence[float],
            up: "Direction | Vector | Triple | None" = None,
            projection: Projection = "perspective",
            lens: Lens | None = None,
        ) -> None: ...

    def __post_init__(self) -> None:
        """Hold the size as integers, also where it was written as 256.0, and look at the rest."""
        width, height = self.size
        msgspec.structs.force_setattr(self, "size", (int(width), int(height)))
        if self.up is not None and are_parallel(unit(self.up), unit(self.normal)):
            raise FieldError("up", "a direction that is not parallel to normal")
        if self.lens is not None:
            check_lens(self.lens, self)

    @classmethod
    @explain_unknown
    def look_at(
        cls,
        eye: "Vector | Triple",
        target: "Vector | Triple",
        up: "Direction | Vector | Triple" = (0, 1, 0),
        fov_degrees: float = 40.0,
        size: Sequence[int] = (800, 600),
        *,
        lens: Lens | None = None,
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
        lens
            Its lens, for depth of field.

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
        fields = views.looking("Camera.look_at", eye, target, up, size, fov_degrees, None)
        return cls(**fields, lens=lens)

    @classmethod
    @explain_unknown
    def orthographic(
        cls,
        eye: "Vector | Triple",
        target: "Vector | Triple",
        height: float,
        up: "Direction | Vector | Triple" = (0, 1, 0),
        size: Sequence[int] = (800, 600),
        *,
        lens: Lens | None = None,
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
        lens
            Its lens, for depth of field.

        Raises
        ------
        SceneError
            If an argument is not right.
        """
        fields = views.looking("Camera.orthographic", eye, target, up, size, None, height)
        return cls(**fields, lens=lens)

    @classmethod
    @explain_unknown
    def panorama(
        cls,
        eye: "Vector | Triple",
        target: "Vector | Triple",
        up: "Direction | Vector | Triple" = (0, 1, 0),
        size: Sequence[int] = (1600, 800),
    ) -> "Camera":
        """Return a camera that sees all directions around a point.

        Its picture is equirectangular: columns are angles to the right of the target, from -180
        degrees at the left edge to 180 at the right, rows are angles above and below, from 90
        degrees at the top to -90 at the bottom.

        Parameters
        ----------
        eye
            Where the camera is, in world space.
        target
            What is in the middle of the picture.
        up
            What points up; not parallel to the line from eye to target.
        size
            Width and height of the picture in pixels, best twice as wide as high.

        Raises
        ------
        SceneError
            If an argument is not right.
        """
        return cls(**looking_around("Camera.panorama", eye, target, up, size))

    @classmethod
    @explain_unknown
    def fit(
        cls,
        subject: "HasObjects | ArrayHolder | ArrayLike",
        direction: "Direction | Vector | Triple" = AHEAD,
        up: "Direction | Vector | Triple | None" = None,
        margin: float | tuple[float, float, float, float] = 0.05,
        projection: FlatProjection = "perspective",
        fov_degrees: float | None = None,
        size: Sequence[int] = (800, 600),
        *,
        view: str | tuple[float, float] | None = None,
        zoom: float = 1.0,
        lens: Lens | None = None,
    ) -> "Camera":
        """Return the camera that shows all objects as large as the picture allows.

        In perspective, it stands as near as can be; orthographic, its pixels are as small as can
        be. The silhouettes of all spheres, cylinders and cones, not only their centres, are in the
        picture, touch the margin on two opposite sides, and are in the middle between the other
        two. Planes have no edge, and count only for `up`.

        Parameters
        ----------
        subject
            A scene, `Spheres`, `Cylinders`, `Cones`, `Copies`, or points of shape (n, 3); for the
            centres alone also `Particles`, and atoms of ASE or MDAnalysis.
        direction
            Where the camera looks, in world space.
        up
            What points up in the picture. By default the normal of the scene's first plane, on the
            side of the objects, or (0, 1, 0) without one; where that is parallel to `direction`
            within 0.06 degrees, (0, 1, 0), and where that is too, (0, 0, 1).
        margin
            What stays free at each side, as a share of the picture's width and height, from 0 to
            less than 0.5; or four of them, on the left, at the top, on the right and at the bottom,
            as for a legend on the right. The middle is that of what they leave.
        projection
            "perspective" or "orthographic".
        fov_degrees
            The vertical field of view in degrees, > 0 and < 180; only for perspective. By default
            40, but so much less in pictures wider than 4:3 that the horizontal one is 52.
        size
            Width and height of the picture in pixels.
        view
            Where it is seen from, instead of `direction`, with the z axis up: "front" (from -y),
            "back", "left" (from -x), "right", "top", "bottom", "iso" (a corner of the cube, from
            the right, in front and above), or an axis that points to the viewer, "x", "-x", "y",
            "-y", "z" or "-z"; or azimuth and elevation of the viewer in degrees, the angle from x
            towards y, and that above the plane of both. "auto" shows the shape: it looks along the
            shortest of the principal axes of all centres, from 20 degrees above it, or below where
            that is more upright than what points up, with the longest horizontal. `up` is then
            that of the view unless it is given.
        zoom
            How many times as large as that, about the middle of the picture, from 1e-9 to 1e9.
        lens
            Its lens, for depth of field; best with a `focus_on`, as the camera stands where it
            must. What is blurred may reach into the margin.

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

        if view is not None:
            from vtray.scene.placing.views import view_of

            if direction is not AHEAD:
                words = "expected None where direction is given, or the other way round"
                raise SceneError(f"Camera.fit: view: {words}, got {view!r}")
            direction, upward = view_of(subject, view, "Camera.fit")
            up = upward if up is None else up
        fields = fitting(subject, direction, up, margin, projection, fov_degrees, size)
        camera = cls(**fields, lens=lens)
        if number_of(zoom) != 1.0:
            from vtray.scene.placing.moved import zoomed

            camera = camera.replace(**zoomed(camera, zoom, "Camera.fit: zoom"))
        return camera

    def resized(self, size: Sequence[int]) -> "Camera":
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

    def zoomed(self, factor: float) -> "Camera":
        """Return a camera whose picture shows all so many times as large, about its middle.

        The eye stays where it is, so that in perspective the field of view becomes narrower.

        Parameters
        ----------
        factor
            How many times as large, from 1e-9 to 1e9; below 1 for smaller.

        Raises
        ------
        SceneError
            If `factor` is not right.
        """
        from vtray.scene.placing.moved import zoomed

        return self.replace(**zoomed(self, factor, "Camera.zoomed: factor"))

    @explain_unknown
    def orbit(
        self,
        degrees: float,
        elevation: float = 0.0,
        about: "Vector | Triple | HasObjects | ArrayHolder | None" = None,
    ) -> "Camera":
        """Return a camera turned about what it looks at.

        Parameters
        ----------
        degrees
            By how much it moves to its right on a circle: about its `up`, or, where that is square
            to its view as in `fit` by a view, or there is none, about the axis of the world that is
            upright in its picture. Without such an axis, it is about what is up in the picture.
        elevation
            By how many degrees it rises before that. It cannot go beyond where it looks straight
            down or up.
        about
            A point, or a scene or arrays of objects for the middle of these. By default the point
            that the camera was made to look at by `look_at`, `orthographic` or, in perspective,
            `fit`, which is 2**20 times its focus from its eye; give it for any other camera.

        Raises
        ------
        SceneError
            If an argument is not right.

        Examples
        --------
        >>> camera = Camera.look_at((0, -8, 0), (0, 0, 0), up=(0, 0, 1))
        >>> frames = [camera.orbit(15 * k) for k in range(24)]
        """
        from vtray.scene.placing.moved import orbiting

        return self.replace(**orbiting(self, degrees, elevation, about))

    @explain_unknown
    def stereo(
        self,
        separation: float,
        about: "Vector | Triple | HasObjects | ArrayHolder | None" = None,
    ) -> tuple["Camera", "Camera"]:
        """Return the cameras of a left and a right eye, which both look at the same point.

        Parameters
        ----------
        separation
            How far apart the eyes are, in scene units, > 0: for a calm picture about a thirtieth of
            the distance to what is seen.
        about
            What both look at, which then is at the distance of the screen; as for `orbit`.

        Returns
        -------
        left, right
            The cameras.

        Raises
        ------
        SceneError
            If an argument is not right.
        """
        from vtray.scene.placing.moved import side_by_side

        left, right = side_by_side(self, separation, about)
        return self.replace(**left), self.replace(**right)

    def project(self, points: "ArrayLike") -> "NDArray[np.float64]":
        """Return where points of the world are in the picture.

        Parameters
        ----------
        points
            Places in world space, (n, 3), or of any shape (..., 3).

        Returns
        -------
        array
            Column, row and depth of each, (..., 3). The middle of a pixel is at its numbers, so
            columns of the picture reach from -0.5 to its width less 0.5; those beyond are outside
            of it. The depth is in scene units, as `Image.depth` has it. All three are NaN for what
            is not in front of the image plane.

        Raises
        ------
        SceneError
            If `points` have another shape.
        """
        from vtray.scene.placing.moved import projected

        return projected(self, points)
