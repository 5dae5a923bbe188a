"""Open Image Denoise: light as more rays would give it, guessed by a neural network.

The network is given light as it would be on white surfaces, and what comes out is multiplied with
their colours again. So colours keep their edges, and no texture is taken for grain. Measured on a
packing of coloured spheres, whose pixels have one sample, as the error against the mean of 20
pictures, in percent of the mean light:

================  ====  ================  =========
light             raw   colours as guide  as here
================  ====  ================  =========
a sky             1.79  1.07              1.08
a point, a sky    0.95  0.99              0.87
a large lamp      1.04  0.81              0.81
================  ====  ================  =========

References
----------
Áfra, "Intel Open Image Denoise", https://www.openimagedenoise.org; "Albedos", "Normals" and
"cleanAux" in its documentation.
"""

import math
from types import ModuleType
from typing import Any

import numpy as np
from numpy.typing import NDArray

from vtray.base.errors import RenderError
from vtray.base.extras import need
from vtray.base.pool import run_tasks

Floats = NDArray[np.float64]

LEAST_ALBEDO = 1e-4
"""Of a channel in which a surface scatters less, nothing can be said of the light."""


def load_library() -> ModuleType:
    """Return the library, or raise ExtraError that says how to install it."""
    return need("pyoidn", "denoise", "denoise")


def denoise(light: Floats, albedo: Floats, normals: Floats | None, threads: int = 1) -> Floats:
    """Return the light of a picture without its grain.

    Parameters
    ----------
    light
        Linear light, (height, width, 3).
    albedo
        The share of light that surfaces send on, from 0 to 1, (height, width, 3).
    normals
        Their normals, 0 where nothing is, (height, width, 3); None if light is all that is known.
    threads
        How many threads to use at the most.

    Raises
    ------
    ExtraError
        The library is not installed.
    RenderError
        It fails.
    """
    library = load_library()
    is_known = albedo >= LEAST_ALBEDO
    arriving = np.divide(light, albedo, out=np.zeros_like(light), where=is_known)
    # White light where a channel says nothing, or a red surface beside a blue one were an edge.
    brightest = arriving.max(axis=2, keepdims=True)
    np.copyto(arriving, brightest, where=~is_known)
    arriving = _filled(arriving, np.any(is_known, axis=2))
    peak = float(arriving.max())
    if not peak > 0.0:
        return light.copy()
    scale = -math.frexp(peak)[1]
    images = {"color": np.ldexp(arriving, scale)}
    if normals is not None:
        images |= {"albedo": np.ones_like(light), "normal": normals}
    found = _filter(library, images, threads)
    clean = np.ldexp(found, -scale) * albedo
    return np.where(is_known, clean, light)


def _filled(image: Floats, is_known: Any) -> Floats:  # noqa: ANN401 - of what NumPy gives
    """Return an image whose unknown pixels have the mean of what is known near them.

    The network smears edges, above all those between black and white.
    """
    height, width = is_known.shape
    if is_known.all() or not is_known.any():
        return image
    weights = np.zeros((height + height % 2, width + width % 2))
    weights[:height, :width] = is_known
    values = np.zeros((*weights.shape, 3))
    values[:height, :width] = image * is_known[..., None]
    squares = (len(weights) // 2, 2, weights.shape[1] // 2, 2)
    count = weights.reshape(squares).sum(axis=(1, 3))
    total = values.reshape(*squares, 3).sum(axis=(1, 3))
    mean = np.divide(total, count[..., None], out=total, where=count[..., None] > 0.0)
    coarse = _filled(mean, count > 0.0).repeat(2, axis=0).repeat(2, axis=1)
    return np.where(is_known[..., None], image, coarse[:height, :width])


def _filter(library: ModuleType, images: dict[str, Floats], threads: int) -> Floats:
    """Run the network of the library over images, each (height, width, 3)."""
    inputs = {name: np.ascontiguousarray(image, np.float32) for name, image in images.items()}
    output = np.empty_like(inputs["color"])

    def work(bound: dict[str, NDArray[np.float32]]) -> None:
        with library.Device(library.OIDN_DEVICE_TYPE_CPU) as device:
            device.set_int("numThreads", threads)
            device.set_bool("setAffinity", False)
            device.commit()
            _check(device)
            network = library.Filter(device, library.OIDN_FILTER_TYPE_RT)
            try:
                for name, image in bound.items():
                    network.set_image(name, image, library.OIDN_FORMAT_FLOAT3)
                network.set_bool("hdr", True)
                network.set_bool("cleanAux", True)
                network.commit()
                network.execute()
                _check(device)
            finally:
                network.release()

    # In a thread of its own, so that a command can be ended meanwhile.
    run_tasks([inputs | {"output": output}], lambda: work, 1)
    return output.astype(np.float64)


def _check(device: Any) -> None:  # noqa: ANN401
    """Raise RenderError if something went wrong."""
    problem = device.get_error()
    if problem is not None:
        message = f"denoise: Open Image Denoise failed: {problem}"
        raise RenderError(message)
