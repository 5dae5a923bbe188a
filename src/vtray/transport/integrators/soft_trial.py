"""How many fans each soft light has from the hits of a pixel that has samples.

If each sample went on until its own rays were exact enough, light would be off: where few rays are
stopped, a sample of which none is would stay too bright, and only the others would come nearer to
what is right. So each has one fan on trial, and what all samples of a pixel tell together decides
for all of them alike. Where they need more, their light is found anew, by other rays.

References
----------
Kirk, Arvo, "Unbiased Sampling Techniques for Image Synthesis", SIGGRAPH 1991 (what is off if
samples decide on their number by what they are).
"""

from vtray.base.compiler.compiled import device
from vtray.geometry.packets.batch import Batch
from vtray.geometry.packets.packet import (
    COUNTED,
    FANS,
    LANES,
    NOISE,
    SOURCE,
    UNLIT,
    VALUE,
    Packet,
    integers,
    load,
    store,
)
from vtray.transport.sampling.fans import Fans

TOO_MUCH = 4.0
"""So many times the variance that there is may be estimated of a fan on trial: twice the error."""


@device
def begin_trial(packet: Packet, hits: int) -> None:
    """Let each soft light have one fan from each hit, and keep the light from there."""
    numbers = integers(packet)
    for lane in range(LANES):
        numbers[FANS + lane] = 1
        packet[COUNTED + lane] = 0.0
    for hit in range(hits):
        store(packet, UNLIT, hit, load(packet, VALUE, hit))


@device
def note_trial(packet: Packet, count: int, batch: Batch) -> None:
    """Note what the fans of the hits of a batch, so many, tell."""
    for member in range(count):
        packet[COUNTED + integers(packet)[SOURCE + batch.hit[member]]] = batch.spent[member]


@device
def end_trial(packet: Packet, hits: int, samples: int, fans: Fans, batch: Batch) -> int:
    """Begin the light anew of those hits whose pixels need more fans; return how many these are.

    Parameters
    ----------
    packet, hits, samples
        The hits, and how many samples of each pixel the packet has.
    fans
        Which fans there are.
    batch
        Out: the hits that need no more count as taken.
    """
    numbers = integers(packet)
    for pixel in range(LANES // samples):
        begin, end = pixel * samples, (pixel + 1) * samples
        counted = 0.0
        for lane in range(begin, end):
            counted += packet[COUNTED + lane]
        count = fans_for(counted / samples, fans.fans)
        for lane in range(begin, end):
            numbers[FANS + lane] = count
    waiting = 0
    for hit in range(hits):
        is_waiting = fans_on_trial(packet, numbers[SOURCE + hit]) > 1
        batch.is_taken[hit] = not is_waiting
        if is_waiting:
            waiting += 1
            packet[NOISE + hit] = 0.0
            store(packet, VALUE, hit, load(packet, UNLIT, hit))
    return waiting


@device
def fans_on_trial(packet: Packet, lane: int) -> int:
    """Return how many fans each soft light has from the hit of a lane."""
    count: int = integers(packet)[FANS + lane]
    return count


@device
def fans_for(counted: float, most: int) -> int:
    """Return how many fans make a variance as small as it may be, given as a part of that.

    They are a power of two, and no more than `most`. The variance of rays that fill the square
    evenly falls with the root of the cube of their number, at the least.
    """
    count, ratio = 1, counted / TOO_MUCH
    while 2 * count <= most and float(count * count * count) < ratio * ratio:
        count *= 2
    return count
