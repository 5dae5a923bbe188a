"""Functions that are given to be called."""


def check_function(name: str, given: object, takes: str, before: str = "") -> None:
    """Raise ValueError if an argument is neither None nor can be called.

    Parameters
    ----------
    name
        What messages call it.
    given
        The argument.
    takes
        What it is called with.
    before
        What may be given instead, such as "True or ".
    """
    if given is not None and not callable(given):
        message = f"{name}: expected {before}a function that takes {takes}, got {given!r}"
        raise ValueError(message)
