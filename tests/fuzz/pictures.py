"""Damaged pictures: what they say of how they were made, or one error; never a warning."""

import json
import warnings
from functools import cache
from pathlib import Path
from random import Random

from examples import light, scene, sphere

import vtray
from fuzz.damage import damaged_bytes
from vtray.base.errors import ProvenanceError
from vtray.image.formats.image_format import FORMATS
from vtray.image.provenance import Provenance, read_provenance


def attempt(random: Random, folder: Path) -> None:
    """Read how a damaged picture was made."""
    ending = random.choice(list(FORMATS))
    picture = folder / f"a{ending}"
    picture.write_bytes(damaged_bytes(_picture(ending, picture), random))
    with warnings.catch_warnings():
        warnings.simplefilter("error")
        try:
            assert isinstance(read_provenance(picture), Provenance)
        except ProvenanceError as error:
            assert str(error).isprintable(), error


@cache
def _picture(ending: str, file: Path) -> bytes:
    """Return the bytes of a small picture."""
    document = scene([sphere((0, 0, 5), 1)], [light(5, -5, 0)], size=[6, 4], resolution=[1, 1])
    vtray.render(vtray.loads(json.dumps(document)), threads=1).save(file)
    return file.read_bytes()
