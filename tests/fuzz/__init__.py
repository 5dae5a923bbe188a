"""The finders: each tries to break one promise of vtray, at random, for as long as it may.

A finder is a function of this kind, in a module of its own::

    def attempt(random: Random, folder: Path) -> None: ...

It first writes into the empty folder what it is about to try, then tries it, and raises if a
promise is broken. The same random numbers lead to the same attempt. ``make fuzz`` runs them for
long; a test runs a few attempts of each.
"""
