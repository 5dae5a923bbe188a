"""An aarch64 machine made of packages: Debian's Python for it, PyPI's wheels, and QEMU.

Nothing is installed on this machine, and no rights are needed: apt keeps its lists in a folder of
its own, the packages are only unpacked, and QEMU runs one program at a time.
"""

import os
import shutil
import subprocess
import sys
import tomllib
import zipfile
from importlib.metadata import version
from pathlib import Path
from typing import NamedTuple

ROOT = Path(__file__).parents[2]
PACKAGES = ["python3-minimal", "libpython3-stdlib", "libstdc++6"]
PLATFORMS = ["manylinux2014_aarch64"] + [f"manylinux_2_{k}_aarch64" for k in (17, 26, 27, 28)]


class Machine(NamedTuple):
    """A machine on which Python runs.

    Attributes
    ----------
    command
        What runs Python there.
    environment
        Where it finds its modules, and keeps its kernels.
    kernels
        The folder of these.
    """

    command: list[str]
    environment: dict[str, str]
    kernels: Path

    def run(self, *arguments: object) -> str:
        """Run Python, show what it prints, and return it."""
        lines = []
        environment = {**os.environ, **self.environment}
        command = [*self.command, *map(str, arguments)]
        with subprocess.Popen(
            command, env=environment, stdout=subprocess.PIPE, text=True
        ) as process:
            for line in process.stdout or ():
                print("   ", line, end="", flush=True)
                lines.append(line)
        if process.returncode:
            sys.exit(f"{command[0]} ended with status {process.returncode}")
        return "".join(lines)


def this_machine(folder: Path) -> Machine:
    """Return this machine, with kernels in a folder."""
    kernels = _fresh(folder / "kernels-here")
    return Machine([sys.executable], {"VTRAY_CACHE_DIR": str(kernels)}, kernels)


def aarch64_machine(folder: Path) -> Machine:
    """Return an aarch64 machine, unpacked in a folder if it is not there yet."""
    for program in ("apt-get", "dpkg-deb", "dpkg"):
        if shutil.which(program) is None:
            sys.exit(f"{program} was not found: this needs Debian, whose packages it unpacks")
    root, wheels = folder / "root", folder / "site"
    wanted = "\n".join([*PACKAGES, *_requirements()])
    ready = folder / "ready"
    if not ready.is_file() or ready.read_text() != wanted:
        ready.unlink(missing_ok=True)
        _unpack_debian(folder, _fresh(root))
        _unpack_wheels(folder, _fresh(wheels), _python_of(root).name.removeprefix("python"))
        ready.write_text(wanted)
    kernels = _fresh(folder / "kernels-there")
    environment = {
        "VTRAY_CACHE_DIR": str(kernels),
        "PYTHONPATH": os.pathsep.join(map(str, [ROOT / "src", wheels])),
    }
    emulator = root / "usr" / "bin" / "qemu-aarch64-static"
    return Machine([*map(str, (emulator, "-L", root, _python_of(root)))], environment, kernels)


def _fresh(folder: Path) -> Path:
    """Return a folder with nothing in it."""
    shutil.rmtree(folder, ignore_errors=True)
    folder.mkdir(parents=True)
    return folder


def _python_of(root: Path) -> Path:
    """Return the Python of an unpacked Debian."""
    (found,) = (root / "usr" / "bin").glob("python3.*[0-9]")
    return found


def _unpack_debian(folder: Path, root: Path) -> None:
    """Unpack Python, all that it needs, and QEMU for this machine."""
    own = _call("dpkg", "--print-architecture")
    state = _fresh(folder / "apt")
    (state / "status").touch()
    for name in ("lists/partial", "archives/partial"):
        (state / name).mkdir(parents=True)
    options = {
        "Dir::State": state,
        "Dir::State::status": state / "status",
        "Dir::Cache": state,
        "APT::Architecture": "arm64",
        "APT::Architectures": f"arm64,{own}",
        "APT::Sandbox::User": "root",
        "APT::Install-Recommends": "false",
        "pkgCacheGen::ForceEssential": "none",
        "Debug::NoLocking": "true",
    }
    command = ["apt-get", "-qq", *(f"-o{name}={value}" for name, value in options.items())]
    print("fetching Debian's packages", flush=True)
    _call(*command, "update")
    wanted = [*(f"{name}:arm64" for name in PACKAGES), f"qemu-user-static:{own}"]
    _call(*command, "--yes", "--download-only", "install", *wanted)
    for package in sorted((state / "archives").glob("*.deb")):
        _call("dpkg-deb", "--extract", package, root)
    shutil.rmtree(state)
    if not (root / "lib").exists():  # a link that a package of its own makes
        (root / "lib").symlink_to("usr/lib")


def _unpack_wheels(folder: Path, site: Path, python: str) -> None:
    """Unpack what vtray needs, in the versions that are installed here."""
    wheels = _fresh(folder / "wheels")
    options = [f"--platform={platform}" for platform in PLATFORMS]
    options += ["--only-binary=:all:", f"--python-version={python}", f"--dest={wheels}"]
    pip = [sys.executable, "-m", "pip", "download", "-qq"]
    print("fetching wheels", flush=True)
    _call(*pip, *options, *_requirements())
    for wheel in sorted(wheels.glob("*.whl")):
        zipfile.ZipFile(wheel).extractall(site)
    shutil.rmtree(wheels)


def _call(*command: object) -> str:
    """Run a program to its end, and return what it prints."""
    done = subprocess.run([*map(str, command)], stdout=subprocess.PIPE, text=True, check=False)
    if done.returncode:
        sys.exit(f"{command[0]} ended with status {done.returncode}")
    return done.stdout.strip()


def _requirements() -> list[str]:
    """Return what vtray needs, in the versions that are installed here."""
    project = tomllib.loads((ROOT / "pyproject.toml").read_text())["project"]
    names = [requirement.split(">")[0] for requirement in project["dependencies"]]
    return [f"{name}=={version(name)}" for name in names]
