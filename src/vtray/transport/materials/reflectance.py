"""What share of light a surface sends on, whatever it is made of: the albedo of a picture.

That is what a viewer would see of it in white light from everywhere: of plastic what its coat
mirrors and its base scatters, of glass what it mirrors and lets through.

References
----------
Áfra, "Intel Open Image Denoise", https://www.openimagedenoise.org; "Albedos" in its documentation.
"""

from vtray.base.compiler.compiled import device
from vtray.geometry.vector import Vec, add, scale
from vtray.transport.materials.albedo import NODES, albedo_at
from vtray.transport.materials.gloss import WHITE, coat_shares
from vtray.transport.materials.look import (
    GLASS,
    MATT,
    METAL,
    PLASTIC,
    Albedos,
    Look,
    Looks,
    index_ratio,
    is_thin,
    nth_of_blend,
    parts_of,
)
from vtray.transport.materials.metal import metal_base
from vtray.transport.materials.optics import mirrored_by_both, mirrored_part


@device
def reflectance(
    looks: Looks, look: Look, tint: Vec, lambert: float, cosine: float, is_inner: bool
) -> Vec:
    """Return the shares of red, green and blue light that a surface sends on.

    Parameters
    ----------
    looks, look
        What it is made of.
    tint, lambert
        The colour of the object, 1 for white, and what share it scatters as a matt one.
    cosine
        That of the angle between the ray to the viewer and the normal.
    is_inner
        Whether it is seen from within.
    """
    total = (0.0, 0.0, 0.0)
    for part in range(parts_of(look)):
        one, share = nth_of_blend(looks, look, part)
        total = add(total, scale(share, _of_one(looks, one, tint, lambert, cosine, is_inner)))
    return total


@device
def _of_one(
    looks: Looks, look: Look, tint: Vec, lambert: float, cosine: float, is_inner: bool
) -> Vec:
    """Return the shares of a surface that is no blend; see `reflectance`."""
    if look.kind == MATT:
        return scale(lambert, tint)
    if look.kind == GLASS:
        return _mixed(_mirrored_by_glass(looks, look, cosine, is_inner), WHITE, tint)
    if look.kind in (METAL, PLASTIC):
        return _of_coat(looks, looks.albedos, look, tint, lambert, cosine)
    return tint


@device
def _mirrored_by_glass(looks: Looks, look: Look, cosine: float, is_inner: bool) -> float:
    """Return the share of light that smooth glass mirrors, and rough glass about so much."""
    share = mirrored_part(cosine, index_ratio(looks, look, is_inner))
    return mirrored_by_both(share) if is_thin(looks, look) else share


@device
def _of_coat(
    looks: Looks, albedos: Albedos | None, look: Look, tint: Vec, lambert: float, cosine: float
) -> Vec:
    """Return the shares of plastic or metal: of its coat, and of the base by what that leaves."""
    shares = coat_shares(looks, look, cosine, tint)
    # An argument that is None is known to the compiler, which drops what depends on that alone.
    if albedos is None:
        return shares
    table = 2 * look.row
    albedo, mean = albedo_at(albedos, table, cosine), albedos[table, NODES + 1]
    if look.kind == METAL:
        return _mixed(albedo, shares, metal_base(looks, look.row, tint, mean))
    return _mixed(albedo, WHITE, scale(lambert, tint))


@device
def _mixed(share: float, coat: Vec, base: Vec) -> Vec:
    """Return so much of what a coat sends on, and the rest of its base."""
    return add(scale(share, coat), scale(1.0 - share, base))
