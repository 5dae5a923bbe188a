"""Shadow rays of points that are far apart are as right as those of points side by side."""

import numpy as np
import pytest

import vtray
from conftest import once
from vtray.geometry.packets.occlusion import Target
from vtray.geometry.packets.packet import (
    BLOCKED,
    ERROR_SCALE,
    NORMAL,
    PLANE_DEPTH,
    POINT,
    load,
    new_packet,
    store,
)
from vtray.geometry.packets.tree_occlusion import PATIENCE, block_in_group
from vtray.geometry.packets.workspace import new_workspace
from vtray.geometry.ray import Segment
from vtray.geometry.shapes.sphere import load_sphere, sphere_hides
from vtray.geometry.world import SPHERE, Group, World, load_group
from vtray.rendering.hierarchy import accelerate
from vtray.rendering.pack import pack

POINTS = 24
MOST_OF_LEAF = 8


def cloud(random: np.random.Generator, count: int, radius: float) -> tuple[World, Group]:
    """Return spheres at random in a cube, as kernels see them, and their group."""
    spheres = vtray.Spheres(random.uniform(-1, 1, (count, 3)), radius=radius)
    camera = vtray.Camera((0, 0, -9), (0, 0, 1), 1, (9, 9), (0.1, 0.1))
    scene = vtray.Scene(camera, [], [spheres])
    world = pack(scene, accelerate(scene, 1)).arrays.world
    rows = range(len(world.groups.kind))
    return world, next(g for g in (load_group(world, row) for row in rows) if g.kind == SPHERE)


@once
@pytest.mark.parametrize(("spread", "radius"), [(1e-3, 0.03), (1.5, 0.03), (1.5, 0.01)])
def test_points_far_apart_are_hidden_by_what_stands_between(spread: float, radius: float) -> None:
    random = np.random.default_rng(5)
    world, group = cloud(random, MOST_OF_LEAF * PATIENCE + 100, radius)
    packet, work = new_packet(), new_workspace(world)
    target = Target(tuple(world.scale * np.array([0.0, 0.0, 4.0]) - world.origin), 9.0, 9.0)
    middle = random.uniform(-1, 1, 3)
    for lane in range(POINTS):
        point = middle + spread * random.uniform(-1, 1, 3)
        point[2] = -1.5
        store(packet, POINT, lane, tuple((world.scale * point - world.origin).tolist()))
        store(packet, NORMAL, lane, (0.0, 0.0, 1.0))
        packet[PLANE_DEPTH + lane], packet[ERROR_SCALE + lane] = 9.0, 9.0
        packet[BLOCKED + lane] = 0.0
    work.cluster[:3] = 1, 0, POINTS
    block_in_group(packet, world, group, target, work)

    for lane in range(POINTS):
        way = Segment(load(packet, POINT, lane), target.place, 9.0, 9.0, 9.0, 9.0)
        spheres = (
            load_sphere(world.spheres, k, group.place) for k in range(group.begin, group.end)
        )
        is_hidden = any(sphere_hides(sphere, way) for sphere in spheres)
        assert (packet[BLOCKED + lane] != 0.0) == is_hidden
    assert spread < 1.0 or 0 < np.count_nonzero(packet[BLOCKED : BLOCKED + POINTS]) < POINTS
