"""Arguments of calls that stand for objects: a tuple for a point, for instance."""

from typing import Any


def argument(call: str, name: str, value: object, kind: Any) -> Any:  # noqa: ANN401
    """Return an argument of a call as an object of a kind, or raise SceneError naming it."""
    from vtray.scene.checks.scene_check import from_code

    return value if isinstance(value, kind) else from_code(value, kind, f"{call}: {name}")
