"""Particles of objects of yt and pynbody.

None of the libraries is imported: what an object is, is told by its attributes.

References
----------
https://yt-project.org/doc/analyzing/fields.html,
https://pynbody.readthedocs.io/latest/tutorials/data_access.html
"""

from typing import TYPE_CHECKING, Any

from vtray.base.errors import SceneError
from vtray.scene.particles.column_names import name_columns
from vtray.scene.particles.from_columns import columns_among
from vtray.scene.particles.joined_groups import joined_groups
from vtray.scene.particles.particles import Particles

if TYPE_CHECKING:
    from numpy.typing import NDArray

    Array = NDArray[Any]

_YT = {
    "particle_position": "position",
    "particle_mass": "mass",
    "particle_velocity": "velocity",
    "particle_index": "id",
}
"""What is read of data of yt, and what the column is called."""

_PYNBODY = ("pos", "mass", "vel")
"""What is read of snapshots of pynbody."""

_COMPONENTS = {"x", "y", "z", "vx", "vy", "vz"}
"""What pynbody has twice."""


def particles_of_astronomy(given: Any) -> Particles | None:  # noqa: ANN401
    """Return the particles of an object of yt or pynbody, in its units; None if it is none.

    They have places, masses, velocities, and what else has been read before; and the kind or the
    family of each, if there are several, as ``type``. A whole data set of yt has its cell.

    Raises
    ------
    SceneError
        It has no places.
    """
    if hasattr(given, "all_data") and hasattr(given, "particle_types_raw"):
        return _of_yt(given.all_data(), given, is_whole=True)
    if hasattr(given, "field_data") and hasattr(getattr(given, "ds", None), "particle_types_raw"):
        return _of_yt(given, given.ds, is_whole=False)
    if hasattr(given, "families") and hasattr(given, "loadable_keys"):
        return _of_pynbody(given)
    return None


def _of_yt(data: Any, whole: Any, *, is_whole: bool) -> Particles:  # noqa: ANN401
    """Return the particles of what is chosen of a data set of yt, kind by kind."""
    import numpy as np

    known = set(whole.derived_field_list)
    groups, units = [], None
    for kind in sorted(whole.particle_types_raw or ()):
        if (kind, "particle_position") not in known:
            continue
        places = data[kind, "particle_position"]
        units = places.units
        columns = {
            column: np.array(data[kind, name])
            for name, column in _YT.items()
            if (kind, name) in known
        }
        read = {name: of for (held, name), of in [*data.field_data.items()] if held == kind}
        others = {name: np.array(of) for name, of in read.items() if name not in _YT}
        groups.append((kind, columns_among({**others, **columns}, len(places))))
    if not groups:
        remedy = "give places and columns, as in {'position': places, 'density': density}"
        raise SceneError(f"the data set of yt has no particles; {remedy}")
    columns = joined_groups(groups)
    positions = columns.pop("position")
    corner, size = (
        np.array(edges.to(units), np.float64)
        for edges in (whole.domain_left_edge, whole.domain_width)
    )
    return Particles(
        positions,
        name_columns(columns),
        cell=np.diag(size) if is_whole else None,
        origin=corner if is_whole else (0.0, 0.0, 0.0),
        periodic=tuple(map(bool, whole.periodicity)) if is_whole else None,
    )


def _of_pynbody(snapshot: Any) -> Particles:  # noqa: ANN401
    """Return the particles of a snapshot of pynbody, or of a part of one, in their order."""
    import numpy as np

    for name in _PYNBODY:
        if name in snapshot.loadable_keys():
            snapshot[name]  # reads it, for all families at once
    groups, rows = [], []
    for family in snapshot.families():
        part = snapshot[family]
        columns = {
            name: np.array(part[name]) for name in sorted(part.keys()) if name not in _COMPONENTS
        }
        if "pos" not in columns:
            raise SceneError("the snapshot of pynbody has no places; expected its array 'pos'")
        groups.append((family.name, columns_among(columns, len(part))))
        rows.append(np.asarray(part.get_index_list(snapshot)))
    if not groups:
        raise SceneError("the snapshot of pynbody has no particles")
    order = np.argsort(np.concatenate(rows))
    columns = {name: of[order] for name, of in joined_groups(groups).items()}
    return Particles(columns.pop("pos"), name_columns(columns))
