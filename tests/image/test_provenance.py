"""What a file says of how its picture was made."""

import json
import os
import subprocess
import sys
from pathlib import Path

import numpy as np
import OpenImageIO
import pytest
from hypothesis import given
from hypothesis import strategies as st
from pictures import hand_made, png_chunks, settings_dict
from PIL import Image as PillowImage

import vtray
from vtray.image.formats.image_format import FORMATS
from vtray.image.provenance import Provenance
from vtray.scene.fingerprint import scene_hash
from vtray.scene.settings import RenderSettings

SETTINGS = {
    "samples": 16,
    "filter": "mitchell",
    "seed": 7,
    "tolerance": 0.01,
    "size": (9, 7),
    "exposure": 0.1 + 0.2,
    "background": vtray.Color(1, 2, 3),
    "denoise": True,
    "stops": 1.25,
    "tonemap": "filmic",
    "integrator": "whitted",
    "depth": 3,
    "firefly": 2.5,
    "edge_samples": 30,
}


@pytest.mark.parametrize("ending", FORMATS)
@pytest.mark.parametrize("settings", [{}, SETTINGS])
def test_each_format_tells(ending: str, settings: dict, tmp_path: Path) -> None:
    form, path = FORMATS[ending], tmp_path / f"a{ending}"
    image = hand_made(**settings)
    aov = ["depth", "ids"] if form.aov else []
    image.save(path, bits=form.bits[-1], aov=aov)
    told = vtray.read_provenance(path)
    assert told.version == vtray.__version__
    assert told.scene == image.scene_hash == scene_hash(image.scene)
    assert told.settings == RenderSettings(**{**settings, "size": (9, 7)})
    assert (told.bits, told.aov, told.lock) == (form.bits[-1], tuple(aov), None)
    assert vtray.read_provenance(str(path)) == told


def test_all_settings_are_told() -> None:
    assert set(RenderSettings.__struct_fields__) <= set(vtray.Provenance.__struct_fields__)
    assert settings_dict(RenderSettings(**SETTINGS)) == SETTINGS


def test_other_programs_see_it(tmp_path: Path) -> None:
    software = f"vtray {vtray.__version__}"
    image = hand_made()
    for bits in (8, 16):
        image.save(tmp_path / "a.png", bits=bits)
        with PillowImage.open(tmp_path / "a.png") as found:
            assert set(found.text) == {"Software", "vtray"}
            assert found.text["Software"] == software
            assert json.loads(found.text["vtray"])["scene"] == image.scene_hash
        image.save(tmp_path / "a.tif", bits=bits)
    for name, bits in [("a.tif", 8), ("a.tif", 16), ("a.jpg", 8), ("a.webp", 8), ("a.exr", 32)]:
        image.save(tmp_path / name, bits=bits)
        source = OpenImageIO.ImageInput.open(str(tmp_path / name))
        assert source.spec().get_string_attribute("Software") == software, name
        source.close()


def test_png_holds_nothing_but_what_is_said(tmp_path: Path) -> None:
    for bits in (8, 16):
        hand_made().save(tmp_path / "a.png", bits=bits)
        names = [name for name, _ in png_chunks((tmp_path / "a.png").read_bytes())]
        assert [*dict.fromkeys(names)] == ["IHDR", "tEXt", "IDAT", "IEND"]
        assert names.count("tEXt") == 2


@pytest.mark.parametrize(
    ("exposure", "factor", "locked"),
    [("max", 1, False), ("max", 0.5, True), (2.0, 1, False), (1 / 3, 1, False), (1 / 3, 3, True)],
)
def test_exposure_locked_to_another_picture(
    exposure: object, factor: float, locked: bool, tmp_path: Path
) -> None:
    image = hand_made(exposure=exposure)
    image.white *= factor
    image.locked = locked
    image.save(tmp_path / "a.png")
    assert vtray.read_provenance(tmp_path / "a.png").lock == (image.white if locked else None)


def test_picture_of_many_pixels(tmp_path: Path) -> None:
    # Pillow takes a picture of so many pixels for an attack.
    path = tmp_path / "a.png"
    hand_made().save(path)
    data = bytearray(path.read_bytes())
    data[16:24] = (100_000).to_bytes(4, "big") * 2
    path.write_bytes(data)
    assert vtray.read_provenance(path).size == (9, 7)


@pytest.mark.parametrize("bits", [8, 16])
def test_png_that_has_been_changed(bits: int, tmp_path: Path) -> None:
    path = tmp_path / "a.png"
    hand_made().save(path, bits=bits)
    path.write_bytes(path.read_bytes().replace(b'"samples":1', b'"samples":2'))
    with pytest.raises(vtray.ProvenanceError, match="is damaged"):
        vtray.read_provenance(path)


def write(path: Path, text: str) -> Path:
    """Write a picture that says something else of how it was made."""
    from PIL.PngImagePlugin import PngInfo

    info = PngInfo()
    info.add_text("vtray", text)
    PillowImage.new("RGB", (3, 2)).save(path, pnginfo=info)
    return path


def told(**changes: object) -> str:
    values = {
        "version": "0.1.0",
        "scene": "0123456789abcdef01234567",
        "samples": 1,
        "filter": "box",
        "seed": 0,
        "size": [3, 2],
        "exposure": "max",
        "background": "black",
        "lock": None,
        "bits": 8,
        "aov": [],
    }
    return json.dumps({**values, **changes})


@pytest.mark.parametrize(
    ("text", "message"),
    [
        ("", "does not say how it was made; expected a picture that vtray has written"),
        ("{", "is not understood"),
        ("no JSON", "is not understood"),
        ("[]", "is not understood"),
        ("{}", "is not understood: Object missing required field `version`"),
        (told(samples=0), r"by vtray 0\.1\.0 is not understood: .*samples"),
        (told(samples=10**30), r"by vtray 0\.1\.0 is not understood: .*samples"),
        (told(filter="sinc"), "is not understood: Invalid enum value 'sinc'.*filter"),
        (told(seed=-1), "is not understood: .*seed"),
        (told(size=[3]), "is not understood: .*size"),
        (told(size=[0, 1]), "is not understood: .*size"),
        (told(exposure=0), "is not understood: .*exposure"),
        (told(exposure="min"), "is not understood: .*exposure"),
        (told(stops="1"), "is not understood: .*stops"),
        (told(tonemap="aces"), "is not understood: Invalid enum value 'aces'.*tonemap"),
        (told(stops=1e9), "is not understood: .*stops"),
        (told(background="blue"), "is not understood: .*background"),
        (told(lock=-1), "is not understood: .*lock"),
        (told(bits=9), "is not understood: .*bits"),
        (told(aov=["light"]), "is not understood: .*aov"),
        (told(scene="xyz"), "is not understood: .*scene"),
        (told(version="9.9", motion=1), r"by vtray 9\.9 is not understood: .*`motion`"),
        (told(version="9.9\n", motion=1), "how it was made is not understood: .*`motion`"),
        (told(version=9), "how it was made is not understood: .*version"),
    ],
)
def test_what_is_not_understood(text: str, message: str, tmp_path: Path) -> None:
    path = write(tmp_path / "a.png", text)
    with pytest.raises(vtray.ProvenanceError, match=message) as error:
        vtray.read_provenance(path)
    assert str(error.value).startswith(f"{path}: ")
    assert "\n" not in str(error.value)


NESTED = ["[" * 100_000, "[" * 100_000 + "]" * 100_000, '{"a":' * 50_000 + "1" + "}" * 50_000]


@pytest.mark.parametrize("text", [*NESTED, *(f'{{"seed": {nested}}}' for nested in NESTED)])
def test_what_is_nested_deeply_is_not_understood(text: str, tmp_path: Path) -> None:
    path = write(tmp_path / "a.png", text)
    with pytest.raises(vtray.ProvenanceError, match="is not understood: ") as error:
        vtray.read_provenance(path)
    assert len(str(error.value)) < 1000


@pytest.mark.parametrize("ending", FORMATS)
def test_nesting_in_all_formats(
    ending: str, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    depth = 50_000  # a JPEG holds 64 kB of it
    monkeypatch.setattr(Provenance, "to_text", lambda _: '{"seed": ' + "[" * depth)
    hand_made().save(tmp_path / f"a{ending}")
    with pytest.raises(vtray.ProvenanceError, match=r"is not understood: .* - at `\$.seed`$"):
        vtray.read_provenance(tmp_path / f"a{ending}")


def test_texts_too_long_are_not_read(tmp_path: Path) -> None:
    np.savez_compressed(tmp_path / "a.npz", provenance=np.array("{" * 10**6))
    with pytest.raises(vtray.ProvenanceError, match="provenance is no text, or too long"):
        vtray.read_provenance(tmp_path / "a.npz")
    write(tmp_path / "a.png", "{" * 2 * 10**6)
    with pytest.raises(vtray.ProvenanceError, match="does not say how it was made"):
        vtray.read_provenance(tmp_path / "a.png")


@pytest.mark.parametrize(
    ("name", "got"),
    [(3, "an object of int"), (None, "an object of NoneType"), ("", "an empty one")],
)
def test_what_is_no_name_of_a_picture(name: object, got: str) -> None:
    with pytest.raises(vtray.ProvenanceError, match=f"^path: expected the name of .*, got {got}$"):
        vtray.read_provenance(name)  # type: ignore[arg-type]


def test_names_may_be_bytes(tmp_path: Path) -> None:
    path = write(tmp_path / "a.png", told())
    assert vtray.read_provenance(os.fsencode(path)) == vtray.read_provenance(path)


def test_what_is_understood(tmp_path: Path) -> None:
    assert vtray.read_provenance(write(tmp_path / "a.png", told())).filter == "box"


OPTIONAL = [name for name in json.loads(told()) if name not in ("version", "scene")]


@pytest.mark.parametrize("missing", [*((name,) for name in OPTIONAL), OPTIONAL])
def test_what_an_older_version_does_not_tell_has_its_default(
    missing: list[str], tmp_path: Path
) -> None:
    said = json.loads(told(samples=4, filter="box", seed=3, exposure=2.0, bits=16, aov=["ids"]))
    kept = {name: value for name, value in said.items() if name not in missing}
    found = vtray.read_provenance(write(tmp_path / "a.png", json.dumps(kept)))
    default = Provenance(version="0.1.0", scene=said["scene"])
    for name in missing:
        assert getattr(found, name) == getattr(default, name)
    assert json.loads(found.to_text()) == {**json.loads(default.to_text()), **kept}
    assert found.settings == RenderSettings(
        **{name: getattr(found, name) for name in RenderSettings.__struct_fields__}
    )


@pytest.mark.parametrize("missing", ["version", "scene"])
def test_what_every_version_has_told_is_expected(missing: str, tmp_path: Path) -> None:
    said = json.loads(told())
    del said[missing]
    with pytest.raises(vtray.ProvenanceError, match=f"missing required field `{missing}`"):
        vtray.read_provenance(write(tmp_path / "a.png", json.dumps(said)))


@pytest.mark.parametrize("ending", [*FORMATS, "", ".gif"])
@pytest.mark.parametrize("content", [b"", b"\x89PNG\r\n\x1a\n", b"nothing of the kind" * 9, None])
def test_no_picture(ending: str, content: bytes | None, tmp_path: Path) -> None:
    path = tmp_path / f"a{ending}"
    if content is not None:
        path.write_bytes(content)
    with pytest.raises(vtray.ProvenanceError) as error:
        vtray.read_provenance(path)
    assert str(error.value).startswith(f"{path}: ")
    assert "\n" not in str(error.value)
    if ending == ".gif":
        assert "expected a picture that vtray has written, one of .png" in str(error.value)
    elif content is None:
        assert "no such file; expected a picture" in str(error.value)


@pytest.mark.parametrize("ending", FORMATS)
def test_picture_of_another_program(ending: str, tmp_path: Path) -> None:
    path = tmp_path / f"a{ending}"
    if ending == ".npz":
        np.savez(path, linear=np.zeros(3))
    elif ending == ".exr":
        import OpenEXR

        OpenEXR.File({}, {"R": np.zeros((2, 3), np.float32)}).write(str(path))
    else:
        PillowImage.new("RGB", (3, 2)).save(path)
    with pytest.raises(vtray.ProvenanceError, match="does not say how it was made"):
        vtray.read_provenance(path)


@pytest.mark.parametrize("ending", FORMATS)
def test_folder(ending: str, tmp_path: Path) -> None:
    (tmp_path / f"a{ending}").mkdir()
    with pytest.raises(vtray.ProvenanceError, match="is a directory; expected a picture"):
        vtray.read_provenance(tmp_path / f"a{ending}")


@pytest.fixture(scope="module")
def files(tmp_path_factory: pytest.TempPathFactory) -> dict[str, bytes]:
    """Return the bytes of a picture in each format."""
    path = tmp_path_factory.mktemp("files") / "a"
    found = {}
    for ending in FORMATS:
        hand_made().save(path.with_suffix(ending))
        found[ending] = path.with_suffix(ending).read_bytes()
    return found


@given(
    ending=st.sampled_from(list(FORMATS)),
    place=st.integers(0, 10**6),
    value=st.integers(0, 255),
    cut=st.booleans(),
)
def test_damaged_files(
    files: dict[str, bytes],
    tmp_path_factory: pytest.TempPathFactory,
    ending: str,
    place: int,
    value: int,
    cut: bool,
) -> None:
    data = bytearray(files[ending])
    place %= len(data)
    data[place] = value
    path = tmp_path_factory.getbasetemp() / f"damaged{ending}"
    path.write_bytes(data[:place] if cut else data)
    try:
        found = vtray.read_provenance(path)
    except vtray.ProvenanceError as error:
        assert str(error).startswith(f"{path}: ")
        assert "\n" not in str(error)
    else:
        assert isinstance(found, vtray.Provenance)


SILENT = """
import sys, vtray
for path in sys.argv[1:]:
    try:
        vtray.read_provenance(path)
    except vtray.ProvenanceError as error:
        print(error)
"""


@pytest.mark.parametrize("ending", [".tif", ".jpg", ".webp"])
def test_libraries_say_nothing_of_damaged_files(
    ending: str, files: dict[str, bytes], tmp_path: Path
) -> None:
    random = np.random.default_rng(7)
    paths = [tmp_path / f"{k}{ending}" for k in range(60)]
    for path in paths:
        data = bytearray(files[ending])
        for place in random.integers(len(data) if random.random() < 0.5 else 80, size=8):
            data[place] = random.integers(256)
        path.write_bytes(data[: random.integers(len(data))] if random.random() < 0.3 else data)
    command = [sys.executable, "-W", "always", "-c", SILENT, *map(str, paths)]
    done = subprocess.run(command, capture_output=True, text=True, check=True)
    assert done.stdout
    assert done.stderr == ""


def test_missing_package(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    hand_made().save(tmp_path / "a.exr")
    monkeypatch.setitem(sys.modules, "OpenEXR", None)
    with pytest.raises(vtray.ProvenanceError, match=r"needs OpenEXR; .* -m pip install Op"):
        vtray.read_provenance(tmp_path / "a.exr")


def test_picture_of_another_size_that_is_exposed_again_has_the_hash_of_its_scene() -> None:
    scene = vtray.load(Path(__file__).parents[2] / "scenes" / "first.json")
    image = vtray.render(scene, size=(8, 6), keep_lights=True)
    same = [light.intensity for light in scene.lights]
    hashes = {each.scene_hash for each in (image, image.expose(2), image.relight(same))}
    assert hashes == {scene_hash(scene)}
