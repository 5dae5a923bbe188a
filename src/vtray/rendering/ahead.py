"""Compiling what traces a scene before what builds its hierarchy, where both are new.

Kernels that build are compiled one by one, by this process. What traces has parts that other
processes compile; with that first, these have work from the beginning.
"""

from vtray.base.compiler.compiled import was_compiled
from vtray.geometry.bvh.nodes import finish_top
from vtray.rendering.drawing import Drawing
from vtray.rendering.hierarchy import without_hierarchy
from vtray.rendering.pack import pack
from vtray.rendering.passes import begin_kernels
from vtray.rendering.rooms import rooms_of
from vtray.rendering.styled import styled
from vtray.scene.scene import Scene
from vtray.scene.settings import RenderSettings
from vtray.scene.style import Style


def compile_ahead(scene: Scene, settings: RenderSettings, style: Style) -> None:
    """Begin to compile what traces a scene, if no hierarchy was ever built on this machine.

    Parameters
    ----------
    scene, settings, style
        As they are rendered.
    """
    if was_compiled(finish_top) or rooms_of(style, scene) is not None:
        return
    kept = without_hierarchy(scene)
    if kept is not None:
        packed = styled(pack(scene, kept), style)
        begin_kernels(packed.arrays, settings, Drawing(style, scene, packed, 1).wanted)
