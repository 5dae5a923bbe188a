"""Renders spheres under a sky of one colour with Cycles, Blender's path tracer.

    python cycles_paths.py THREADS SCENE OUTPUT SAMPLES PICTURES SURFACES

SCENE is a file as `soft_scene.py` describes it; OUTPUT is a .npy file for the light of so many
pictures with other random numbers, (pictures, height, width, 3), float32, by paths over so many
surfaces. How long the last picture took goes to standard output: the hierarchy is kept from the
first one on.

Runs in a Python environment of its own that has Blender, without vtray.
"""

import sys
import tempfile
import time
from pathlib import Path

import bpy
import numpy as np

sys.path.append(str(Path(__file__).resolve().parents[2]))  # for `peers`
from peers.host.soft_scene import REACH, SoftScene, read_scene

DEEP = 12.0
"""How far the camera sees, in sizes of the picture."""


def main() -> None:
    """Do what the arguments say."""
    if sys.argv[1:] == ["--version"]:
        print(bpy.app.version_string)
        return
    threads, path, output, samples, pictures, surfaces = sys.argv[1:]
    given = read_scene(Path(path))
    bpy.ops.wm.read_factory_settings(use_empty=True)
    scene = bpy.context.scene
    matt = matt_material(given.reflectance)
    add_spheres(scene, given.spheres, matt)
    add_floor(scene, given, matt)
    add_sky(scene)
    add_camera(scene, given)
    set_up(scene, int(threads), int(samples), int(surfaces))
    found = []
    with tempfile.TemporaryDirectory() as folder:
        scene.render.filepath = str(Path(folder) / "picture.exr")
        for seed in range(int(pictures)):
            scene.cycles.seed = seed
            begin = time.perf_counter()
            bpy.ops.render.render(write_still=True)
            seconds = time.perf_counter() - begin
            found.append(read_light(scene.render.filepath))
    print(f"trace {seconds:8.4f} s")
    np.save(output, np.stack(found))


def matt_material(reflectance: float) -> bpy.types.Material:
    """Return a matt material."""
    material = bpy.data.materials.new("matt")
    material.use_nodes = True
    nodes, links = material.node_tree.nodes, material.node_tree.links
    nodes.clear()
    surface = nodes.new("ShaderNodeBsdfDiffuse")
    surface.inputs["Color"].default_value = (reflectance, reflectance, reflectance, 1)
    links.new(surface.outputs[0], nodes.new("ShaderNodeOutputMaterial").inputs["Surface"])
    return material


def add_spheres(scene: bpy.types.Scene, spheres: np.ndarray, material: bpy.types.Material) -> None:
    """Add the spheres as a point cloud, which Cycles gives to Embree as spheres.

    Only nodes can make a point cloud, of the vertices of a mesh.
    """
    mesh = bpy.data.meshes.new("spheres")
    mesh.vertices.add(len(spheres))
    mesh.vertices.foreach_set("co", spheres[:, :3].astype(np.float32).ravel())
    radius = mesh.attributes.new("size", "FLOAT", "POINT")
    radius.data.foreach_set("value", spheres[:, 3].astype(np.float32))
    thing = bpy.data.objects.new("spheres", mesh)
    scene.collection.objects.link(thing)
    tree = bpy.data.node_groups.new("points", "GeometryNodeTree")
    tree.interface.new_socket("in", in_out="INPUT", socket_type="NodeSocketGeometry")
    tree.interface.new_socket("out", in_out="OUTPUT", socket_type="NodeSocketGeometry")
    names = ("NodeGroupInput", "GeometryNodeMeshToPoints", "GeometryNodeSetMaterial")
    begin, points, paint = (tree.nodes.new(name) for name in names)
    size = tree.nodes.new("GeometryNodeInputNamedAttribute")
    size.data_type = "FLOAT"
    size.inputs["Name"].default_value = "size"
    paint.inputs["Material"].default_value = material
    tree.links.new(begin.outputs[0], points.inputs["Mesh"])
    tree.links.new(size.outputs["Attribute"], points.inputs["Radius"])
    tree.links.new(points.outputs["Points"], paint.inputs["Geometry"])
    tree.links.new(paint.outputs[0], tree.nodes.new("NodeGroupOutput").inputs[0])
    thing.modifiers.new("points", "NODES").node_group = tree


def add_floor(scene: bpy.types.Scene, given: SoftScene, material: bpy.types.Material) -> None:
    """Add the floor, which is square to y."""
    side, height = REACH * given.size, given.floor
    around = (-side, -side), (-side, side), (side, side), (side, -side)
    corners = [(x, height, z) for x, z in around]
    mesh = bpy.data.meshes.new("floor")
    mesh.from_pydata(corners, [], [(0, 1, 2, 3)])
    mesh.materials.append(material)
    scene.collection.objects.link(bpy.data.objects.new("floor", mesh))


def add_sky(scene: bpy.types.Scene) -> None:
    """Add a sky of radiance 1."""
    world = bpy.data.worlds.new("sky")
    world.use_nodes = True
    background = world.node_tree.nodes["Background"]
    background.inputs["Color"].default_value = (1, 1, 1, 1)
    background.inputs["Strength"].default_value = 1
    scene.world = world


def add_camera(scene: bpy.types.Scene, given: SoftScene) -> None:
    """Add the camera, whose rays are parallel and fill the same pixels."""
    height, width, _ = given.starts.shape
    right, down = given.starts[0, 1] - given.starts[0, 0], given.starts[1, 0] - given.starts[0, 0]
    matrix = np.eye(4)
    axes = right / np.linalg.norm(right), -down / np.linalg.norm(down), -given.way
    matrix[:3, :3] = np.stack(axes, axis=1)
    matrix[:3, 3] = given.starts.reshape(-1, 3).mean(axis=0)
    camera = bpy.data.cameras.new("camera")
    camera.type = "ORTHO"
    camera.ortho_scale = max(width * np.linalg.norm(right), height * np.linalg.norm(down))
    camera.clip_start, camera.clip_end = 0.01 * given.size, DEEP * given.size
    thing = bpy.data.objects.new("camera", camera)
    thing.matrix_world = matrix.T.tolist()
    scene.collection.objects.link(thing)
    scene.camera = thing
    scene.render.resolution_x, scene.render.resolution_y = width, height


def set_up(scene: bpy.types.Scene, threads: int, samples: int, surfaces: int) -> None:
    """Ask for so many samples of each pixel, without anything that is not exact."""
    scene.render.engine = "CYCLES"
    scene.render.threads_mode, scene.render.threads = "FIXED", threads
    scene.render.use_persistent_data = True
    scene.render.film_transparent = True
    scene.render.image_settings.file_format = "OPEN_EXR"
    scene.render.image_settings.color_depth = "32"
    cycles = scene.cycles
    cycles.device = "CPU"
    cycles.samples = samples
    cycles.use_adaptive_sampling = cycles.use_denoising = False
    cycles.pixel_filter_type = "BOX"
    cycles.max_bounces = cycles.diffuse_bounces = surfaces - 1
    cycles.sample_clamp_indirect = 0
    cycles.light_sampling_threshold = 0


def read_light(path: str) -> np.ndarray:
    """Return the light of a picture, (height, width, 3)."""
    image = bpy.data.images.load(path)
    width, height = image.size
    pixels = np.empty(4 * width * height, np.float32)
    image.pixels.foreach_get(pixels)
    bpy.data.images.remove(image)
    return pixels.reshape(height, width, 4)[::-1, :, :3]


if __name__ == "__main__":
    main()
