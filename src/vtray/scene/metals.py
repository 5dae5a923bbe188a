"""Measured metals: their complex indices of refraction for red, green and blue.

Spectra of n and k, those by which Mitsuba knows its metals (from the databases of luxpop.com and
SOPRA; Palik, "Handbook of Optical Constants of Solids"; those of iron from Johnson and Christy,
Physical Review B 9, 1974), come to three channels so that a metal has its true colour: n is the
mean over what each channel of linear sRGB sees under daylight D65, and k is such that light that
falls squarely is mirrored as the whole spectrum says, in linear sRGB. Where that asks for a k far
from the mean, in the reds of copper and gold, k is the mean, and n follows from it. The red of
gold lies outside of sRGB, and is taken for 0.99.
"""

from typing import Literal

MetalName = Literal[
    "aluminium",
    "chromium",
    "copper",
    "gold",
    "iron",
    "mercury",
    "nickel",
    "rhodium",
    "silver",
    "tungsten",
]

Three = tuple[float, float, float]

METALS: dict[str, tuple[Three, Three]] = {
    "aluminium": ((1.2085, 0.9214, 0.6293), (7.133, 6.5748, 5.5379)),
    "chromium": ((3.3684, 2.9966, 1.9931), (4.2219, 4.4151, 4.2464)),
    "copper": ((0.1231, 0.9628, 1.1625), (3.037, 2.6093, 2.3215)),
    "gold": ((0.0247, 0.4793, 1.4353), (2.969, 2.584, 1.6768)),
    "iron": ((2.9114, 2.9497, 2.5845), (3.0893, 2.9318, 2.767)),
    "mercury": ((1.8057, 1.4985, 1.0783), (5.018, 4.577, 3.892)),
    "nickel": ((1.887, 1.753, 1.636), (3.7149, 3.2178, 2.6187)),
    "rhodium": ((2.072, 1.9487, 1.7507), (5.5972, 4.9435, 4.4299)),
    "silver": ((0.129, 0.1264, 0.1482), (4.085, 3.3748, 2.3841)),
    "tungsten": ((3.5683, 3.4754, 3.3214), (2.9268, 2.7491, 2.5055)),
}
"""The real and the imaginary parts, n and k."""
