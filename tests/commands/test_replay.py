"""The options of the command that say how a picture is taken, and pictures made again."""

import inspect
import json
import sys
from pathlib import Path

import msgspec
import numpy as np
import pytest
from examples import one_sphere

import vtray
from conftest import JIT, once
from vtray.commands import cli
from vtray.rendering import renderer

PICTURE = ["--samples", "--filter", "--seed", "--size", "--exposure", "--background"]
GIVEN = [
    *("--samples", "16", "--filter", "mitchell", "--seed", "4294967295", "--size", "8x6"),
    *("--exposure", "0.3", "--background", "#0a141E"),
]

AOV_NAMES = "depth, normals, ids, copies, raw, albedo, error, samples, direct, indirect, emission"


@pytest.fixture
def small(tmp_path: Path) -> Path:
    """Return a scene file of 12 x 9 pixels."""
    document = one_sphere()
    document["camera"].update(size=[12, 9], resolution=[0.4, 0.4])
    path = tmp_path / "scene.json"
    path.write_text(json.dumps(document))
    return path


@pytest.fixture
def asked(monkeypatch: pytest.MonkeyPatch) -> list[dict]:
    """Return what renders are asked for, and let them do without."""
    calls: list[dict] = []
    real = renderer.render

    def render(scene: vtray.Scene, threads: int = 1, progress: object = None, **given: object):
        given.pop("warn", None)
        calls.append(given)
        image = real(scene, threads)
        if given.get("lock"):
            image.white = given["lock"].white
        return image

    monkeypatch.setattr("vtray.rendering.renderer.render", render)
    return calls


def test_nothing_is_asked_for_unless_said(small: Path, asked: list[dict]) -> None:
    assert cli.run([str(small), str(small.with_name("a.png"))]) == 0
    assert asked == [{}]


def test_all_settings_reach_the_render(small: Path, asked: list[dict]) -> None:
    assert cli.run([str(small), str(small.with_name("a.png")), *GIVEN]) == 0
    assert asked == [
        {
            "samples": 16,
            "filter": "mitchell",
            "seed": 2**32 - 1,
            "size": (8, 6),
            "exposure": 0.3,
            "background": vtray.Color(10, 20, 30),
        }
    ]
    assert cli.run([str(small), str(small.with_name("a.png")), "--alpha"]) == 0
    assert asked[1] == {"background": "transparent"}
    for exposure, value in [("max", "max"), ("2", 2.0), (".5", 0.5), ("1e-3", 0.001), ("+2", 2.0)]:
        assert cli.run([str(small), str(small.with_name("a.png")), "--exposure", exposure]) == 0
        assert asked[-1] == {"exposure": value}
    assert cli.run([str(small), str(small.with_name("a.png")), "--stops", "+1"]) == 0
    assert asked[-1] == {"stops": 1.0}


COLOR = 'a name such as "orange", or digits such as "#e0e8ff"'
WRONG = [
    *(("--samples", bad, "an integer from 1 to 65536") for bad in ("0", "65537", "1.5", "x", "")),
    *(("--seed", bad, "an integer from 0 to 4294967295") for bad in ("-1", "4294967296", "1e3")),
    *(
        ("--size", bad, "width and height such as 1200x800")
        for bad in ("8", "8x", "0x8", "8x2147483648", "8 x 6", "8X6", "8x6x4", "٣x٣")
    ),
    *(
        ("--exposure", bad, "max, auto or a number > 0")
        for bad in ("0", "-1", "inf", "nan", "1e999", "MAX", "", "1_0")
    ),
    *(
        ("--stops", bad, "a number from -100 to 100")
        for bad in ("x", "", "101", "-100.1", "inf", "nan", "max")
    ),
    *(
        ("--background", bad, f"black, transparent, sky, {COLOR}")
        for bad in ("#12345", "#12345g", "", "(1,2,3)")
    ),
    *(("--bits", bad, "8 or 16") for bad in ("7", "0", "", "16.0")),
    *(
        ("--aov", bad, f"names of {AOV_NAMES} with commas between")
        for bad in ("", "dept", "depth,", "depth;ids")
    ),
]


@pytest.mark.parametrize(("option", "bad", "expected"), WRONG)
def test_wrong_values(
    option: str, bad: str, expected: str, small: Path, capfd: pytest.CaptureFixture[str]
) -> None:
    # With "=", a value may begin with a minus.
    assert cli.run([str(small), str(small.with_name("a.png")), f"{option}={bad}"]) == 1
    start = f"Error: argument {option}: expected {expected}, got {bad}; usage: vtray "
    out, err = capfd.readouterr()
    assert (out, err.count("\n")) == ("", 1)
    assert err.startswith(start)


@pytest.mark.parametrize(
    ("arguments", "message"),
    [
        (["--tonemap", "aces"], "argument --tonemap: invalid choice: 'aces' (choose from"),
        (["--filter", "sinc"], "argument --filter: invalid choice: 'sinc' (choose from"),
        (
            ["--background", "oramge"],
            f"argument --background: expected black, transparent, sky, {COLOR}, got oramge; did "
            'you mean "orange"?; usage: ',
        ),
        (["--alpha", "--background", "black"], "argument --background: not allowed with"),
    ],
)
def test_wrong_choices(
    arguments: list[str], message: str, small: Path, capfd: pytest.CaptureFixture[str]
) -> None:
    assert cli.run([str(small), str(small.with_name("a.png")), *arguments]) == 1
    assert capfd.readouterr().err.startswith(f"Error: {message}")


@pytest.mark.parametrize(
    ("output", "arguments", "message"),
    [
        ("a.jpg", ["--alpha"], "cannot be transparent; .png, .tif"),
        ("a.jpg", ["--bits", "16"], "bits: expected 8 for this format, got 16; .png"),
        ("a.png", ["--aov", "depth"], "this format cannot hold depth; .exr, .npz can"),
        ("a.exr", ["--bits", "16"], "bits: expected 32 for this format, got 16"),
    ],
)
def test_formats_are_checked_before_any_work(
    output: str,
    arguments: list[str],
    message: str,
    small: Path,
    capfd: pytest.CaptureFixture[str],
) -> None:
    assert cli.run(["no such scene", str(small.with_name(output)), *arguments]) == 1
    assert message in capfd.readouterr().err
    assert list(small.parent.iterdir()) == [small]


def test_missing_package_is_found_before_any_work(
    small: Path, capfd: pytest.CaptureFixture[str], monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setitem(sys.modules, "OpenEXR", None)
    assert cli.run(["no such scene", str(small.with_name("a.exr"))]) == 1
    remedy = f"needs OpenEXR; {sys.executable} -m pip install OpenEXR tifffile\n"
    assert capfd.readouterr().err.endswith(remedy)


def test_size_of_the_scene_is_checked_before_any_work(
    small: Path, capfd: pytest.CaptureFixture[str], asked: list[dict]
) -> None:
    small.write_text(small.read_text().replace("[12, 9]", "[20000, 9]"))
    assert cli.run([str(small), str(small.with_name("a.webp"))]) == 1
    assert "up to 16383 pixels across and down, got 20000" in capfd.readouterr().err
    assert asked == []


@pytest.mark.parametrize(
    "arguments", [[], ["--bits", "16"], GIVEN], ids=["plain", "16 bits", "all settings"]
)
def test_picture_made_again_has_the_same_bytes(
    arguments: list[str],
    small: Path,
    capfd: pytest.CaptureFixture[str],
    request: pytest.FixtureRequest,
) -> None:
    if "samples" not in inspect.signature(renderer.render).parameters:
        if arguments == GIVEN:
            pytest.skip("render has no settings yet")
        request.getfixturevalue("asked")
    one, two = small.with_name("one.png"), small.with_name("two.png")
    assert cli.run([str(small), str(one), *arguments]) == 0
    assert cli.run(["--replay", str(one), str(small), str(two)]) == 0
    assert capfd.readouterr() == ("", "")
    assert one.read_bytes() == two.read_bytes()
    # Over itself, too.
    assert cli.run(["--replay", str(one), str(small), str(one), "-t", "2"]) == 0
    assert one.read_bytes() == two.read_bytes()


def soft_scene() -> vtray.Scene:
    """Return a ball on the ground in the light of two lamps and a sky."""
    scene = vtray.Scene()
    scene.add_sphere((0, 0, 1), 1, "tomato")
    scene.add_plane((0, 0, 0), (0, 0, 1))
    scene.lights = [vtray.SphereLight((-2, -3, 4), 1), vtray.SphereLight((3, -2, 4), 1, 0.3)]
    scene.add_light(vtray.Sky(0.4))
    scene.camera = vtray.Camera.look_at((0, -6, 3), (0, 0, 0.8), size=(12, 9) if JIT else (6, 5))
    return scene


def keep(**settings: object) -> vtray.Image:
    """Return its picture, which keeps its lights."""
    return vtray.render(soft_scene(), tolerance=0.01, keep_lights=True, **settings)


@once
@pytest.mark.parametrize("changed", ["not", "lights", "colours"])
def test_picture_whose_lights_were_kept_is_made_again(
    changed: str, small: Path, capfd: pytest.CaptureFixture[str]
) -> None:
    image = keep()
    if changed == "lights":
        image = image.relight([0.5, 1.0, 0.2])
    elif changed == "colours":
        image = image.recolor(0, "skyblue")
    one, two = small.with_name("one.png"), small.with_name("two.png")
    image.save(one)
    assert vtray.read_provenance(one).keep_lights
    image.scene.save(small)
    assert cli.run(["--replay", str(one), str(small), str(two)]) == 0
    assert capfd.readouterr() == ("", "")
    assert one.read_bytes() == two.read_bytes()
    usual = vtray.render(image.scene, tolerance=0.01)
    assert (usual.pixels != image.pixels).any()


def test_lights_are_not_kept_where_they_cannot_be(small: Path) -> None:
    one, two = small.with_name("one.png"), small.with_name("two.png")
    image = keep()
    image.save(one)
    image.scene.save(small)
    arguments = ["--replay", str(one), str(small), str(two), "--integrator", "path"]
    assert cli.run(arguments) == 0
    assert not vtray.read_provenance(two).keep_lights


def test_part_of_a_picture_whose_lights_are_kept_says_so(small: Path) -> None:
    parts: list[vtray.Image] = []
    keep(on_update=parts.append, update_seconds=0)
    assert parts
    parts[0].save(small.with_name("part.png"))
    assert vtray.read_provenance(small.with_name("part.png")).keep_lights


@once
def test_what_was_painted_on_a_picture_is_warned_of(
    small: Path, capfd: pytest.CaptureFixture[str]
) -> None:
    one, two = small.with_name("one.png"), small.with_name("two.png")
    replay = ["--replay", str(one), str(small), str(two)]
    words = (
        "title, legend and whatever else is painted on it are not made again; give them too, by "
        "--title, --axes and the like, or in Python by image.annotated"
    )
    title = ["--size", "90x60", "--title", "Hello"]
    assert cli.run([str(small), str(one), *title]) == 0
    assert vtray.read_provenance(one).painted
    assert cli.run(replay) == 0
    assert capfd.readouterr().err == f"Warning: {one}: {words}\n"
    assert not vtray.read_provenance(two).painted
    assert cli.run([*replay, *title]) == 0
    assert one.read_bytes() == two.read_bytes()
    assert cli.run([*replay[:3], "--pixel", "1,1"]) == 0
    vtray.render(vtray.load(small), size=(90, 60)).annotated().save(one)
    assert cli.run(replay) == 0
    assert capfd.readouterr().err == ""


@pytest.mark.parametrize("size", [(8, 6), (24, 18)])
def test_scene_as_it_was_rendered_is_no_other(
    size: tuple[int, int], small: Path, capfd: pytest.CaptureFixture[str]
) -> None:
    one, two = small.with_name("one.npz"), small.with_name("two.npz")
    shown, scene = small.with_name("shown.json"), vtray.load(small)
    image = vtray.render(scene, size=size, keep_lights=True)
    for picture in (image, image.expose(2), image.relight([0.5])):
        picture.save(one)
        picture.scene.save(shown)
        assert cli.run(["--replay", str(one), str(shown), str(two)]) == 0
        assert capfd.readouterr() == ("", "")
        with np.load(one) as before, np.load(two) as after:
            np.testing.assert_array_equal(before["linear"], after["linear"])
    image.save(one)
    assert cli.run(["--replay", str(one), str(small), str(two)]) == 0
    assert capfd.readouterr() == ("", "")
    vtray.render(scene, size=(4, 3)).scene.save(shown)
    assert cli.run(["--replay", str(one), str(shown), str(two)]) == 0
    assert "was made from another scene" in capfd.readouterr().err
    vtray.render(scene).save(one)
    assert vtray.read_provenance(one).shown is None


def write(path: Path, **settings: object) -> None:
    """Write a picture of these settings by hand."""
    from pictures import hand_made

    hand_made(**settings).save(path)


def test_settings_of_the_picture_reach_the_render(
    small: Path, asked: list[dict], capfd: pytest.CaptureFixture[str]
) -> None:
    picture = small.with_name("picture.exr")
    write(picture, samples=4, filter="box", seed=5, exposure=2.0, background=(1, 2, 3))
    again = small.with_name("again.png")
    assert cli.run(["--replay", str(picture), str(small), str(again), "--samples", "8"]) == 0
    assert asked == [
        {
            "samples": 8,
            "filter": "box",
            "seed": 5,
            "tolerance": 0.008,
            "size": (9, 7),
            "exposure": 2.0,
            "background": vtray.Color(1, 2, 3),
            "denoise": False,
            "stops": 0.0,
            "tonemap": "linear",
            "integrator": "direct",
            "depth": 8,
            "firefly": "off",
            "edge_samples": 1,
            **msgspec.structs.asdict(vtray.Style()),
        }
    ]
    warning = "was made from another scene, or this one has changed since: the picture will differ"
    assert capfd.readouterr().err == f"Warning: {picture}: {warning}\n"
    assert cli.run(["-q", "--replay", str(picture), str(small), str(again)]) == 0
    assert capfd.readouterr().err == ""


def test_picture_of_an_older_version_is_made_again(
    small: Path, capfd: pytest.CaptureFixture[str], monkeypatch: pytest.MonkeyPatch
) -> None:
    picture, again = small.with_name("picture.npz"), small.with_name("again.npz")
    document = json.loads(small.read_text())
    tell = vtray.Provenance.to_text
    with monkeypatch.context() as old:
        old.setattr(
            vtray.Provenance,
            "to_text",
            lambda self: json.dumps({"version": self.version, "scene": self.scene, "samples": 4}),
        )
        assert cli.run([str(small), str(picture), "--samples", "4"]) == 0
    # What it did not know yet had its default, whatever the scene says now.
    small.write_text(json.dumps({**document, "render": {"seed": 7, "exposure": 2}}))
    assert cli.run(["--replay", str(picture), str(small), str(again)]) == 0
    assert capfd.readouterr() == ("", "")
    with np.load(picture) as one, np.load(again) as two:
        assert (one["pixels"] == two["pixels"]).all()
        assert one["pixels"].any()
        assert str(two["provenance"]) == tell(vtray.read_provenance(again))


def test_picture_of_a_newer_version_is_refused(
    small: Path, capfd: pytest.CaptureFixture[str], monkeypatch: pytest.MonkeyPatch
) -> None:
    picture = small.with_name("picture.png")
    tell = vtray.Provenance.to_text
    more = {"version": "9.9", "motion": 1}
    newer = lambda self: json.dumps({**json.loads(tell(self)), **more})  # noqa: E731
    monkeypatch.setattr(vtray.Provenance, "to_text", newer)
    assert cli.run([str(small), str(picture)]) == 0
    assert cli.run(["--replay", str(picture), str(small), str(small.with_name("b.png"))]) == 1
    told = "what it says of how it was made by vtray 9.9 is not understood"
    unknown = "Object contains unknown field `motion`"
    assert capfd.readouterr().err == f"Error: {picture}: {told}: {unknown}\n"


def test_exposure_that_was_locked_is_locked_again(
    small: Path, asked: list[dict], capfd: pytest.CaptureFixture[str]
) -> None:
    picture, again = small.with_name("picture.png"), small.with_name("again.png")
    first = vtray.render(vtray.load(small))
    first.white *= 1.1
    image = vtray.render(vtray.load(small), lock=first)
    image.save(picture)
    assert cli.run(["--replay", str(picture), str(small), str(again)]) == 0
    assert asked[1]["lock"].white == image.white
    assert vtray.read_provenance(again) == vtray.read_provenance(picture)
    arguments = ["--replay", str(picture), str(small), str(again), "--exposure", "max"]
    assert cli.run(arguments) == 0
    assert "lock" not in asked[2]


def test_what_has_changed_is_warned_of(
    small: Path,
    asked: list[dict],
    capfd: pytest.CaptureFixture[str],
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    picture, again = small.with_name("picture.png"), small.with_name("again.png")
    assert cli.run([str(small), str(picture)]) == 0
    monkeypatch.setattr("vtray.commands.replay.__version__", "9.8.7")
    assert cli.run(["--replay", str(picture), str(small), str(again)]) == 0
    version = f"was made by vtray {vtray.__version__}, this is 9.8.7: the picture may differ"
    assert capfd.readouterr().err == f"Warning: {picture}: {version}\n"
    small.write_text(small.read_text().replace('"radius": 1', '"radius": 1.5'))
    assert cli.run(["--replay", str(picture), str(small), str(again)]) == 0
    assert [line.split(": ")[2].split(",")[0] for line in capfd.readouterr().err.splitlines()] == [
        f"was made by vtray {vtray.__version__}",
        "was made from another scene",
    ]


def test_pictures_that_cannot_be_replayed(small: Path, capfd: pytest.CaptureFixture[str]) -> None:
    for name, content, message in [
        ("missing.png", None, "no such file; expected a picture"),
        ("text.png", b"text", "is damaged, or none of .png"),
        ("scene.json", None, "expected a picture that vtray has written, one of .png"),
    ]:
        picture = small.with_name(name)
        if content:
            picture.write_bytes(content)
        assert cli.run(["--replay", str(picture), str(small), str(small.with_name("a.png"))]) == 1
        err = capfd.readouterr().err
        assert err.startswith(f"Error: {picture}: {message}")
        assert err.count("\n") == 1


def test_replay_explains_pixels(small: Path, capfd: pytest.CaptureFixture[str]) -> None:
    arguments = ["--replay", "missing.png", str(small), "--pixel", "1,1"]
    assert cli.run(arguments) == 1
    assert "missing.png: no such file" in capfd.readouterr().err


def test_help_is_quick_and_has_groups(capfd: pytest.CaptureFixture[str]) -> None:
    assert cli.run(["--help"]) == 0
    out = capfd.readouterr().out
    for heading in ("the picture (otherwise as the scene says):", "the file:", "reports:"):
        assert heading in out
    assert all(option in out for option in PICTURE)
    assert max(map(len, out.splitlines())) <= 80


def test_stops_are_told_and_made_again(small: Path) -> None:
    picture, again = small.with_name("a.png"), small.with_name("b.png")
    assert cli.run([str(small), str(picture), "--exposure", "auto", "--stops=-0.5"]) == 0
    told = vtray.read_provenance(picture)
    assert (told.exposure, told.stops) == ("auto", -0.5)
    assert cli.run(["--replay", str(picture), str(small), str(again)]) == 0
    assert picture.read_bytes() == again.read_bytes()


def test_stops_of_a_picture_that_is_locked(small: Path, capfd: pytest.CaptureFixture[str]) -> None:
    loaded = vtray.load(small)
    first = vtray.render(loaded, stops=1)
    loaded.lights[0] = loaded.lights[0].replace(intensity=0.1)
    loaded.save(small)
    picture, again = small.with_name("a.png"), small.with_name("b.png")
    vtray.render(loaded, lock=first).save(picture)
    assert cli.run(["--replay", str(picture), str(small), str(again)]) == 0
    assert picture.read_bytes() == again.read_bytes()
    assert cli.run(["--replay", str(picture), str(small), str(again), "--stops", "1"]) == 1
    words = "its exposure is that of another picture, with its stops; give --exposure too"
    assert words in capfd.readouterr().err


def test_what_is_beside_a_picture_is_taken_over_where_it_can_be(small: Path) -> None:
    picture, again, plain = (small.with_name(name) for name in ("a.npz", "b.npz", "b.png"))
    assert cli.run([str(small), str(picture), "--aov", "depth"]) == 0
    for output in (again, plain):
        assert cli.run(["--replay", str(picture), str(small), str(output)]) == 0
    assert vtray.read_provenance(again) == vtray.read_provenance(picture)
    assert tuple(vtray.read_provenance(plain).aov) == ()
