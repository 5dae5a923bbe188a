"""Single objects as files and hashes hold them."""

from typing import Any

OPAQUE = 1.0


def object_as_written(item: Any) -> Any:  # noqa: ANN401
    """Return a single object, of which equal ones are written alike.

    Of the numbers that are left out for being the default, msgspec knows only the default itself,
    not what equals it.
    """
    if item.opacity != OPAQUE:
        return item
    names, defaults = item.__struct_fields__, type(item).__struct_defaults__
    default = defaults[names.index("opacity") - len(names)]
    return item if item.opacity is default else item.replace(opacity=default)
