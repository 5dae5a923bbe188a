"""Lists of arguments: a picture, an explanation, or one line of error."""

import json
import os
from pathlib import Path
from random import Random

from examples import light, scene, sphere

from fuzz import looks
from fuzz.promises import run_quietly

OPTIONS = [
    *("-t", "--threads", "-q", "--samples", "--filter", "--seed", "--size", "--exposure", "-V"),
    *("--background", "--alpha", "--bits", "--aov", "--replay", "--stats", "--pixel", "--help"),
    *("--outline", "--fog", "--eye-dome", "--stops", "--tonemap", "--edge-samples"),
]
OF_LOOKS = [
    *("--integrator", "--depth", "--firefly", "--tolerance", "--clip", "--slice", "--cap"),
    *("--solid-from", "--pixel", "--integrator"),
]
"""Options beside what surfaces look like."""
VALUES = [
    *("1", "2", "16", "0", "-1", "3.5", "1e5", "999999999", "9" * 30, "8", "32", "12x9", "5x0"),
    *(
        "max",
        "auto",
        "agx",
        "1e308",
        "1e-320",
        "inf",
        "nan",
        "white",
        "#e0e8ff",
        "transparent",
        "depth,ids",
    ),
    *(
        "box",
        "mitchell",
        "1,2",
        "2,9,red",
        "off",
        "11,8",
        "12,9",
        "",
        "é",
        "\udcff",
        "a\nError: b",
        "\x1b[2J",
        "٣",
    ),
]
VALUES_OF_LOOKS = [
    *("whitted", "path", "filmic", "srgb", "64", "65", "0.5", "2,1:0", "2,1:3", "0,0,1", "1,0,0,2"),
]
FILES = [
    *("scene.json", "old.png", "new.png", "new.tif", "a.jpg", "a.webp", "a.exr", "a.npz", "bare"),
    *("folder", "folder/a.png", "missing/a.png", "loop", "pipe", "/dev/zero", "/dev/full", "-"),
    *("/dev/null", "/dev/stdin", "/dev/stdout", "a.gif", "x" * 300, "\0", ".png", "."),
]


def attempt(random: Random, folder: Path) -> None:
    """Run the command with arguments that may make sense."""
    document = scene([sphere((0, 0, 5), 1)], [light(5, -5, 0)], size=[6, 4], resolution=[1, 1])
    options, values = OPTIONS, VALUES + FILES
    if looks.SHARE and random.random() < looks.SHARE:
        document["objects"][0]["material"] = random.choice(["mirror", "glass", "plastic"])
        options, values = OPTIONS + 3 * OF_LOOKS, VALUES + FILES + 6 * VALUES_OF_LOOKS
    (folder / "scene.json").write_text(json.dumps(document))
    (folder / "folder").mkdir()
    (folder / "loop").symlink_to("loop")
    os.mkfifo(folder / "pipe")
    arguments = [random.choice(FILES[:1] * 9 + FILES), random.choice(FILES[:9] * 3 + FILES)]
    for _ in range(random.choice([0, 1, 1, 2, 3, 5])):
        place = random.randrange(len(arguments) + 1)
        arguments[place:place] = [random.choice(options), random.choice(values)]
    if arguments[-1:] == ["pipe"]:
        arguments.pop()  # to write to a pipe is to wait for its reader
    (folder / "arguments.json").write_text(json.dumps(arguments))
    os.chdir(folder)
    run_quietly(
        ["old.png" if word == "pipe" and place else word for place, word in enumerate(arguments)]
    )
