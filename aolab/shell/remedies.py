"""Packages that bring OpenGL to a machine, for `aolab doctor` and for tools/setup.py.

tools/setup.py runs this file before anything is installed: standard library only, also of an older Python.
"""

# Mesa's software renderer with EGL, by package manager
MESA = {
    "apt-get": "apt-get install libegl1 libgl1 libgl1-mesa-dri",
    "dnf": "dnf install mesa-libEGL mesa-libGL mesa-dri-drivers",
    "zypper": "zypper install Mesa-libEGL1 Mesa-libGL1 Mesa-dri",
    "pacman": "pacman -S mesa libglvnd",
    "apk": "apk add mesa-egl mesa-gl mesa-dri-gallium",
}
# Without root: Python and Mesa's software renderer from conda-forge
CONDA = (
    "micromamba create -n aolab -c conda-forge python=3.12 mesa-llvmpipe libegl libgl",
    "micromamba activate aolab",
    'export __EGL_VENDOR_LIBRARY_DIRS="$CONDA_PREFIX/share/glvnd/egl_vendor.d"',
)
