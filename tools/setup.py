"""Set up .venv: `python3 tools/setup.py runtime|dev|docs`. The Makefile calls it; it runs on a bare system Python.

`runtime` installs what is missing of the system (Debian and its kin, where root or passwordless sudo allows), makes
.venv and installs aolab editable into it; `dev` and `docs` add pyproject.toml's dependency groups.
"""

from __future__ import annotations  # an older Python must get as far as the sentence that refuses it

import ctypes
import os
import runpy
import shutil
import subprocess
import sys
from pathlib import Path

ROOT = Path(__file__).resolve().parent.parent
VENV = ROOT / ".venv"
VENV_PYTHON = VENV / ("Scripts/python.exe" if os.name == "nt" else "bin/python")
OLDEST_PYTHON = (3, 11)

REMEDIES = runpy.run_path(str(ROOT / "aolab/shell/remedies.py"))  # the same as those of `aolab doctor`
WITHOUT_ROOT = (
    "\n      ".join(
        (
            "  without root: take Python and Mesa's software renderer from conda-forge (conda or micromamba)",
            *REMEDIES["CONDA"],
        )
    )
    + "\n  and give the same make command again."
)


def missing_packages() -> list[str]:
    """Debian's names of what is missing; tried in a process of its own, since a broken driver may crash it."""
    command = [sys.executable, ROOT / "tools/system_packages.py"]
    probe = subprocess.run(command, stdout=subprocess.PIPE, text=True, env=os.environ | {"EGL_LOG_LEVEL": "fatal"})
    return probe.stdout.split() if probe.returncode == 0 else ["libegl1", "libgl1", "libgl1-mesa-dri"]


def become_root() -> list[str] | None:
    """The command prefix that runs a command as root, or None where that needs a password."""
    if os.name != "posix":
        return None
    if os.geteuid() == 0:
        return []
    sudo = ["sudo", "-n"]
    if shutil.which("sudo") and subprocess.run([*sudo, "true"], stderr=subprocess.DEVNULL).returncode == 0:
        return sudo
    return None


def apt_install(packages: list[str], as_root: list[str]) -> None:
    apt = [*as_root, "env", "DEBIAN_FRONTEND=noninteractive", "apt-get", "-qq"]
    apt += ["-o", "DPkg::Lock::Timeout=120", "-o", "Dpkg::Use-Pty=0"]
    print("installing system packages:", *packages, flush=True)
    subprocess.run([*apt, "update"])  # one dead source must not stop the rest
    subprocess.run([*apt, "install", "-y", "--no-install-recommends", *packages], stdout=subprocess.DEVNULL)


def explain(packages: list[str]) -> str:
    if shutil.which("apt-get"):
        as_root = "apt-get install " + " ".join(packages)
    else:
        known = [command for manager, command in REMEDIES["MESA"].items() if shutil.which(manager)]
        as_root = (
            known[0] if known else "install the packages that hold libEGL, libGL, Mesa's drivers, and Python's venv"
        )
    return f"aolab needs what this system lacks: {' '.join(packages)}\n  as root:      {as_root}\n{WITHOUT_ROOT}"


def require_system() -> None:
    packages = missing_packages()
    as_root = become_root()
    if packages and as_root is not None and shutil.which("apt-get"):
        apt_install(packages, as_root)
        packages = missing_packages()
    if packages:
        sys.exit(explain(packages))


def offer_libatomic() -> None:
    """Mitsuba's wheel needs it and does not bring it; without it the tests of the second opinion are skipped."""
    as_root = become_root()
    if sys.platform != "linux" or as_root is None or not shutil.which("apt-get"):
        return
    try:
        ctypes.CDLL("libatomic.so.1")
    except OSError:
        apt_install(["libatomic1"], as_root)


def make_venv() -> None:
    works = VENV_PYTHON.exists() and subprocess.run([VENV_PYTHON, "-c", "import pip"], stderr=subprocess.DEVNULL)
    if not works or works.returncode:  # none, half made, or left over from a Python that is gone
        print("making .venv", flush=True)
        subprocess.run([sys.executable, "-m", "venv", "--clear", VENV], check=True)


def pip_install(*what: str) -> None:
    # a user-wide `pip --user` setting has no meaning, and fails, inside an environment
    environment = os.environ | {"PIP_USER": "0", "PIP_DISABLE_PIP_VERSION_CHECK": "1"}
    subprocess.run([VENV_PYTHON, "-m", "pip", "install", "--quiet", *what], cwd=ROOT, env=environment, check=True)


def main(stage: str) -> None:
    if sys.version_info < OLDEST_PYTHON:
        found = ".".join(map(str, sys.version_info[:3]))
        sys.exit(
            f"aolab needs Python 3.11 or newer; {sys.executable} is {found}. Choose another: make PYTHON=python3.12"
        )
    if stage == "runtime":
        require_system()
        make_venv()
        print("installing aolab and its libraries into .venv", flush=True)
        pip_install("--editable", ".")
    else:
        print(f"installing the {stage} tools into .venv", flush=True)
        if stage == "dev":
            offer_libatomic()
        pip_install("pip>=25.1")  # the first version with --group
        every = "[tune,mitsuba,notebook,draco,meshopt,sweep,film,view]"  # the tests try every extra for real
        extras = every if stage == "dev" else ""
        pip_install("--group", stage, "--editable", f".{extras}")


if __name__ == "__main__":
    stages = ("runtime", "dev", "docs")
    if len(sys.argv) != 2 or sys.argv[1] not in stages:
        sys.exit(f"usage: {sys.argv[0]} {'|'.join(stages)}")
    try:
        main(sys.argv[1])
    except subprocess.CalledProcessError as error:
        sys.exit(f"set-up stopped: {' '.join(map(str, error.cmd))} ended with {error.returncode}")
    except KeyboardInterrupt:
        sys.exit("set-up interrupted; the same make command goes on")
