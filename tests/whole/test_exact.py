"""Nothing that differs between machines takes part in a picture: not in kernels, not before them.

`make arm` compares the pictures of two processors; here is what makes them the same.
"""

import ast
import importlib
import math
import re
from collections.abc import Callable, Iterator
from functools import partial
from pathlib import Path
from typing import Any

import numba
import numpy as np
import pytest
from clouds import cloud
from llvmlite import binding
from machine_code import inexact_in

import vtray
from conftest import compiled_only, once
from vtray.base.compiler.compiled import Device, Kernel
from vtray.base.compiler.function_names import full_name
from vtray.base.compiler.kernel_folder import SUFFIX, cache_folder
from vtray.base.compiler.object_code import (
    PART_MARK,
    ObjectCode,
    compile_object,
    read_object_code,
)
from vtray.geometry.bvh import key_sort
from vtray.rendering.hierarchy import accelerate
from vtray.transport.integrators.direct import trace_tile

SOURCES = Path(vtray.__file__).parent

pytestmark = pytest.mark.usefixtures("compiler")


def kernels() -> Iterator[Kernel]:
    """Give all kernels of the package."""
    for source in SOURCES.rglob("[!_]*.py"):
        path = source.relative_to(SOURCES).with_suffix("")
        module = importlib.import_module(".".join(["vtray", *path.parts]))
        found = [item for item in vars(module).values() if isinstance(item, Kernel)]
        yield from (item for item in found if item.__module__ == module.__name__)


@pytest.mark.last
@compiled_only
def test_machine_code_of_all_kernels(monkeypatch: pytest.MonkeyPatch) -> None:
    own = {full_name(item.__wrapped__) for item in kernels()}
    monkeypatch.setattr(key_sort, "SMALL", 16)  # so many keys are worth a thread
    for use in ways_to_use_kernels():
        files = kept_files()
        if all(any(map(read_object_code, files.get(name, ()))) for name in own):
            break  # mostly, other tests have needed them all
        use()
    kept = kept_code()
    assert own <= set(kept), "use below what these kernels are for"
    assert len(kept[full_name(trace_tile.__wrapped__)]) >= 2
    for name, codes in kept.items():
        for compiled in codes:
            assert inexact_in(compiled.code) <= set(compiled.parts), name


def kept_files() -> dict[str, list[Path]]:
    """Return the files of all machine code, by the names of kernels, parts and functions."""
    folder = cache_folder()
    assert folder is not None
    files: dict[str, list[Path]] = {}
    for file in folder.glob(f"*{SUFFIX}"):
        files.setdefault(file.stem.rpartition(PART_MARK)[0], []).append(file)
    return files


def kept_code() -> dict[str, list[ObjectCode]]:
    """Return all machine code that is kept on disk, of kernels and of their parts, by names."""
    codes = {
        name: [code for file in files if (code := read_object_code(file))]
        for name, files in kept_files().items()
    }
    return {name: found for name, found in codes.items() if found}  # functions have none of theirs


def ways_to_use_kernels() -> Iterator[Callable[[], object]]:
    """Give what uses each kernel at least once, in the end."""
    scene = vtray.Scene()
    scene.objects = [cloud("uniform", 200, 1)]
    yield partial(render_all_ways, scene)
    # With long shapes, kernels are not the same.
    start, end = np.random.default_rng(1).uniform(-1, 1, (2, 200, 3))
    scene.add_cylinders(start, end, 0.05)
    scene.add_cones(start, end, 0.05)
    yield partial(render_all_ways, scene)
    yield partial(share_rays, scene)
    yield build_with_one_far_away
    yield draw_all_ways
    yield follow_all_ways


def share_rays(scene: vtray.Scene) -> None:
    """Use all kernels of lights that are so many that they share their rays."""
    scene.lights = [vtray.Sun((1, 2, -3 - k)) for k in range(150)]
    vtray.render(scene)
    vtray.trace_pixel(scene, 4, 3)


def build_with_one_far_away() -> None:
    """Use all kernels that look for what few others are near."""
    scene = vtray.Scene()
    scene.objects = [cloud("uniform", 300, 1), vtray.Sphere((1e9, 0, 0), 1, (0, 0, 0))]
    accelerate(scene)


def render_all_ways(scene: vtray.Scene) -> None:
    """Use all kernels."""
    scene.camera = vtray.Camera.fit(scene, size=(8, 6))
    scene.lights = [vtray.Light((2, 3, 4), 1), vtray.Light((-5, 3, 4), 2)]
    vtray.render(scene, threads=2, samples=2, keep_lights=True).relight([1, 2])
    scene.lights += [vtray.Sun((1, 2, -3)), vtray.Ambient(), vtray.Sky(gradient=vtray.Gradient())]
    scene.add_rectangle_light((2, 3, 9), [(2, 0, 0), (0, 2, 0)], visible=True)
    vtray.render(scene, threads=2, samples=2, background="sky")
    vtray.trace_pixel(scene, 4, 3)


def draw_all_ways() -> None:
    """Use all kernels of styles, and of what lets light through."""
    scene = vtray.Scene()
    scene.add_spheres(np.random.default_rng(2).uniform(-1, 1, (200, 3)), 0.2, opacity=0.5)
    scene.add_spheres(np.random.default_rng(3).uniform(-1, 1, (200, 3)), 0.1)
    scene.add_copies(vtray.Sphere((0, 0, 0), 0.3), [(1, 0, 0), (-1, 0, 0)])
    scene.camera = vtray.Camera.fit(scene, size=(8, 6))
    scene.lights = [vtray.Light((2, 3, 4), 1)]
    vtray.render(scene)
    for column in range(8):
        vtray.trace_pixel(scene, column, 3)
    scene.objects[0] = scene.objects[0].replace(opacity=1.0)
    lines = vtray.Outline(normals=True)
    vtray.render(scene, clip=(1, 1, 1), cap=True, outline=lines, eye_dome=True, fog=True)


def follow_all_ways() -> None:
    """Use all kernels of light that goes on from surfaces."""
    scene = vtray.Scene()
    scene.objects = [
        vtray.Sphere((-0.5, 0, 0.6), 0.5, material="glass"),
        vtray.Plane((0, 0, 0), (0, 0, 1), (255, 255, 255)),
    ]
    scene.lights = [vtray.Sky(1), vtray.Sun((0, 0, -1)), vtray.Light((0, 0, 5))]
    scene.camera = vtray.Camera.look_at((0, 0, 9), target=(0, 0, 0), up=(0, 1, 0), size=(5, 5))
    vtray.trace_pixel(vtray.render(scene, integrator="whitted"), 2, 2)
    vtray.render(scene, integrator="path", samples=2)
    tiles = vtray.Metal(roughness=0.3, pattern=vtray.Checker(size=0.2))
    scene.objects[0] = vtray.Sphere((0, 0, 0.6), 1.5, material=tiles)
    vtray.trace_pixel(vtray.render(scene, integrator="path", samples=2), 2, 2)


MULTIPLY_ADD = "declare double @llvm.fma.f64(double, double, double)\n" + (
    "define double @f(double %a, double %b) "
    "{ %c = call double @llvm.fma.f64(double %a, double %b, double %a) ret double %c }"
)
TARGETS = {
    "x86_64": ("x86_64-unknown-linux-gnu", "+fma", "vfmadd213sd"),
    "x86_64 without": ("x86_64-unknown-linux-gnu", "", "fma"),
    "aarch64": ("aarch64-unknown-linux-gnu", "", "fmadd"),
}


@pytest.mark.parametrize("target", TARGETS)
def test_fused_multiply_add_is_found(target: str) -> None:
    triple, features, name = TARGETS[target]
    binding.initialize_all_targets()
    binding.initialize_all_asmprinters()
    machine = binding.Target.from_triple(triple).create_target_machine(features=features)
    module = binding.parse_assembly(MULTIPLY_ADD)
    assert inexact_in(machine.emit_object(module)) == {name}
    module = binding.parse_assembly("define double @f(double %a) { ret double %a }")
    assert inexact_in(machine.emit_object(module)) == set()


def with_functions(x: Any) -> Any:
    return math.sin(x) + math.exp(x) * np.log(x) ** x


def test_calls_of_the_library_are_found() -> None:
    found = inexact_in(compile_object(with_functions, (0.5,), Kernel._options).code)
    assert found >= {"sin", "exp", "log", "pow"}


FLAGS = re.compile(r"\b(fast|reassoc|contract|arcp|afn|nnan|ninf|nsz) |llvm\.fma|llvm\.fmuladd")


def total_of_products(numbers: Any) -> Any:
    total = 0.0
    for k in range(numbers.size):
        total += numbers[k] * numbers[0] / 3.0
    return total


@pytest.mark.parametrize("options", [Kernel._options, Device._options, {"fastmath": True}])
def test_sums_and_products_keep_their_order(options: dict[str, Any]) -> None:
    """What the machine code cannot show: flags that let the compiler change the order."""
    compiler: Any = numba.njit((numba.float64[:],), **options)(total_of_products)
    (text,) = compiler.inspect_llvm().values()
    assert "fadd" in text
    assert (FLAGS.search(text) is not None) == ("fastmath" in options)


FIGURES = set(
    """
    commands/diff figures/color_bar figures/comparison figures/drawn/cones
    figures/drawn/cylinders figures/drawn/objects
    figures/drawn/shapes figures/drawn/spheres figures/fan_lines figures/figure figures/flat
    figures/flip figures/oklab figures/pen
    figures/ray_drawing figures/ray_text figures/ray_tree figures/scale_bar figures/section
    figures/sheet figures/stage
    """.split()  # noqa: SIM905
)
"""Modules of figures, drawings and comparisons, which may differ in last digits."""

GUESSES = {"image/denoise", "rendering/guides"}
"""Modules of what a neural network makes of pictures, and of what guides it."""

# The library of C; NumPy's own of these; and what NumPy, BLAS or a loop in C adds up in an order of
# its own.
INEXACT = set(
    """
    sin cos tan asin acos atan atan2 sinh cosh tanh asinh acosh atanh exp exp2 expm1 log log2 log10
    log1p pow cbrt hypot dist erf erfc gamma lgamma fma sumprod

    arcsin arccos arctan arctan2 arcsinh arccosh arctanh power float_power logaddexp logaddexp2 sinc
    deg2rad rad2deg i0

    dot vdot vecdot inner matmul matvec vecmat einsum tensordot linalg fft convolve correlate
    interp mean average std var median quantile percentile nansum nanmean trapezoid polyval polyfit
    """.split()  # noqa: SIM905
)
INTEGERS = set(
    """
    figures/ink geometry/bvh/build geometry/bvh/join rendering/acceleration rendering/hierarchy
    rendering/numbering scene/fingerprint
    """.split()  # noqa: SIM905
)
"""Modules whose sums over arrays are of integers, which have no order."""


POWERS = re.compile(r"2(\.0)? \*\* .*|\d+ \*\* \d+")


def inexact_lines(name: str, source: str) -> Iterator[str]:
    """Give what a module uses that may differ between machines."""
    for node in ast.walk(ast.parse(source)):
        is_name = isinstance(node, ast.Attribute) and node.attr in INEXACT
        is_sum = isinstance(node, ast.Attribute) and node.attr == "sum" and name not in INTEGERS
        is_imported = isinstance(node, ast.ImportFrom) and node.module in {"math", "numpy"}
        is_product = isinstance(node, ast.BinOp) and isinstance(node.op, ast.MatMult)
        is_power = isinstance(node, ast.BinOp) and isinstance(node.op, ast.Pow)
        # Powers of 2, and those of integers that are written out, are not rounded.
        is_power = is_power and not POWERS.fullmatch(ast.unparse(node))
        if is_name or is_sum or is_imported or is_product or is_power:
            yield f"{name}: {ast.unparse(node)}"


@once
def test_no_source_uses_what_differs() -> None:
    modules = {
        file.relative_to(SOURCES).with_suffix("").as_posix(): file.read_text()
        for file in SOURCES.rglob("[!_]*.py")
    }
    assert modules.keys() >= FIGURES | GUESSES
    found = [
        line
        for name, source in modules.items()
        if name not in FIGURES | GUESSES
        for line in inexact_lines(name, source)
    ]
    assert found == []


@pytest.mark.parametrize(
    "line",
    ["y = math.tan(x)", "y = np.linalg.norm(x)", "y = x @ x", "y = x**0.5", "y = x.sum(axis=1)"],
)
def test_what_differs_is_found_in_a_source(line: str) -> None:
    assert list(inexact_lines("lights", f"def f(x):\n    {line}\n    return y\n"))
