"""Clusters of hits on the same shape: near each other, they go to the lights together."""

from vtray.base.compiler.compiled import device
from vtray.geometry.packets.packet import NO_PRIMITIVE, PRIMITIVE, Packet, integers
from vtray.geometry.packets.workspace import TABLE, Workspace

CLUSTER = 32
"""Hits of a cluster at the most: the rays of more part ways."""

SPREAD = 40503
"""Spreads numbers over the hash table: Knuth's multiplicative hashing, golden ratio * 2**16."""


@device
def list_hits(packet: Packet, lanes: int, work: Workspace) -> int:
    """List the lanes with a hit; return how many there are."""
    numbers = integers(packet)
    hits = 0
    for lane in range(lanes):
        if numbers[PRIMITIVE + lane] > NO_PRIMITIVE:
            work.order[hits] = lane
            hits += 1
    return hits


@device
def cluster_hits(packet: Packet, lanes: int, most: int, work: Workspace) -> int:
    """List the lanes with a hit, in clusters that hit the same, not too many; return how many."""
    owners = _find_members(packet, lanes, work)
    hits = 0
    clusters = 0
    for k in range(owners):
        count = work.size[k]
        work.size[k] = hits  # from now on, where the next member goes
        for begin in range(hits, hits + count, most):
            clusters += 1
            work.cluster[clusters] = begin
        hits += count
    work.cluster[0] = clusters
    work.cluster[clusters + 1] = hits
    for lane in range(lanes):
        owner = work.member[lane]
        if owner >= 0:
            work.order[work.size[owner]] = lane
            work.size[owner] += 1
    return hits


@device
def _find_members(packet: Packet, lanes: int, work: Workspace) -> int:
    """Find what is hit, by which lanes, and by how many; return how many things are."""
    table, owner, member, size = work.table, work.owner, work.member, work.size
    numbers = integers(packet)
    for place in range(TABLE):
        table[place] = -1
    owners = 0
    for lane in range(lanes):
        member[lane] = -1
        primitive = numbers[PRIMITIVE + lane]
        if primitive <= NO_PRIMITIVE:
            continue
        place = (primitive * SPREAD >> 4) % TABLE
        while table[place] >= 0 and owner[table[place]] != primitive:
            place = (place + 1) % TABLE
        if table[place] < 0:
            table[place] = owners
            owner[owners] = primitive
            size[owners] = 0
            owners += 1
        member[lane] = table[place]
        size[table[place]] += 1
    return owners
