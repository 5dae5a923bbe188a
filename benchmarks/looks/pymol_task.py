"""Does a task of the page of eight figures with PyMOL, as its users do.

    python pymol_task.py TASK FILE VIEW OUTPUT

VIEW is an .npz with eye, forward, up, fov (vertical, in radians) and size.
Runs in an environment of its own, without vtray.
"""

import sys
from typing import Any

import numpy as np
import pymol2


def spheres(cmd: Any) -> None:  # noqa: ANN401
    """Show balls."""
    cmd.hide("everything")
    cmd.show("spheres")


def ball_and_stick(cmd: Any) -> None:  # noqa: ANN401
    """Show balls and sticks by PyMOL's own preset."""
    from pymol import preset

    preset.ball_and_stick("all", _self=cmd)


def inhibitor(cmd: Any) -> None:  # noqa: ANN401
    """Show what binds to the protein."""
    cmd.remove("not resn XK2")
    ball_and_stick(cmd)


def flaps(cmd: Any) -> None:  # noqa: ANN401
    """Show two loops in colours, and all else pale."""
    spheres(cmd)
    cmd.color("grey90")
    cmd.color("marine", "chain A and resi 43-58")
    cmd.color("orange", "chain B and resi 43-58")


TASKS = {"c60": ball_and_stick, "protein": spheres, "inhibitor": inhibitor, "flaps": flaps}


def main() -> None:
    """Do what the arguments say."""
    task, file, view, output = sys.argv[1:]
    with np.load(view) as given:
        view = {name: given[name] for name in given.files}
    width, height = (int(side) for side in view["size"])
    with pymol2.PyMOL() as session:
        cmd = session.cmd
        cmd.load(file)
        cmd.bg_color("white")
        TASKS[task](cmd)
        back, up = -view["forward"], view["up"]
        right = np.cross(up, back)
        right /= np.linalg.norm(right)
        up = np.cross(back, right)
        turn = np.stack([right, up, back])
        middle = np.mean(cmd.get_extent(), axis=0)
        place = turn @ (middle - view["eye"])
        cmd.set("field_of_view", float(np.degrees(view["fov"])))
        near, far = -place[2] - 300, -place[2] + 300
        cmd.set_view([*turn.T.ravel(), *place, *middle, max(near, 0.1), far, 0])
        cmd.png(output, width=width, height=height, ray=1)


if __name__ == "__main__":
    main()
