"""The classic: a ball that mirrors, one of glass and matt ones on a checkered floor."""

import vtray as vt

TILE = 1.0
WHITE, DARK = (235, 235, 235), (60, 66, 80)
LIGHT = (-5.0, -6.0, 9.0)


def make_scene(side: int) -> vt.Scene:
    """Make the scene, in the light of one point, for a picture of so many pixels a side."""
    scene = vt.Scene()
    checkered = vt.Lambert(pattern=vt.Checker((WHITE, DARK), size=TILE, up=(0, 1, 0)))
    scene.add_plane((0, 0, 0), normal=(0, 0, 1), material=checkered)
    scene.add_sphere((-1.3, 0.7, 1.2), 1.2, material="mirror")
    scene.add_sphere((1.1, -0.9, 0.9), 0.9, material=vt.Glass(1.5))
    scene.add_sphere((1.7, 1.9, 0.8), 0.8, color=(205, 60, 45))
    scene.add_sphere((-0.6, -1.7, 0.4), 0.4, color=(70, 130, 200))
    scene.add_sphere((-2.7, -1.2, 0.5), 0.5, color=(230, 180, 60))
    scene.add_light(LIGHT, 0.9)
    scene.camera = vt.Camera.look_at(
        (0.4, -9.0, 3.6), target=(0.1, 0, 0.8), up=(0, 0, 1), fov_degrees=34, size=(side, side)
    )
    return scene
