"""Particles of objects of PyVista and meshio: the points of a mesh, with what is known of each.

None of the libraries is imported: what an object is, is told by its attributes.

References
----------
https://docs.pyvista.org/user-guide/data_model.html, https://github.com/nschloe/meshio
"""

from typing import Any

from vtray.scene.particles.column_names import name_columns
from vtray.scene.particles.from_columns import columns_among
from vtray.scene.particles.particles import Particles


def particles_of_mesh(given: Any) -> Particles | None:  # noqa: ANN401
    """Return the points of a mesh; None if an object is none.

    Raises
    ------
    SceneError
        They do not have three numbers each.
    """
    import numpy as np

    data: Any = getattr(given, "point_data", None)
    if not hasattr(given, "points") or not hasattr(data, "keys"):
        return None
    positions = np.array(given.points)
    columns = {str(name): np.array(data[name]) for name in data.keys()}  # noqa: SIM118  no dictionary
    return Particles(positions, name_columns(columns_among(columns, len(positions))))
