"""The kernels of the pages are forks of one process, which has imported most modules that the pages need.

A page has a kernel of its own; Jupyter would start each as a new Python, whose imports take 1.2 to 1.5 seconds of CPU.
No OpenGL context is made before a fork: each kernel makes its own.
"""

import os
import sys
from importlib.metadata import EntryPoint
from multiprocessing import get_context, parent_process
from multiprocessing.context import ForkServerProcess
from threading import Thread
from typing import Any

from jupyter_client.connect import KernelConnectionInfo
from jupyter_client.provisioning.factory import KernelProvisionerFactory
from jupyter_client.provisioning.local_provisioner import LocalProvisioner
from sphinx.application import Sphinx

IMPORTS = (
    "ipykernel.kernelapp",
    "ipykernel.zmqshell",
    "aolab.measures.pictures",
    "aolab.notebook.glyph",
    "aolab.pipeline.api",
    "matplotlib.pyplot",
    "trimesh",
)


class Child:
    """A fork, with the part of `subprocess.Popen` that Jupyter calls."""

    stdin = stdout = stderr = None

    def __init__(self, process: ForkServerProcess) -> None:
        process.start()
        assert process.pid is not None
        self.process, self.pid = process, process.pid
        self.kill, self.terminate = process.kill, process.terminate

    def poll(self) -> int | None:
        return self.process.exitcode

    def wait(self) -> int | None:
        self.process.join()
        return self.process.exitcode

    def send_signal(self, signum: int) -> None:
        os.kill(self.pid, signum)


class ForkProvisioner(LocalProvisioner):
    """Forks a kernel in place of starting a Python."""

    async def launch_kernel(self, cmd: list[str], **kwargs: Any) -> KernelConnectionInfo:
        context = get_context("forkserver")
        context.set_forkserver_preload(list(IMPORTS))
        options = cmd[cmd.index("-f") :]  # the connection file
        self.process = Child(context.Process(target=run, args=(options, str(kwargs["cwd"]))))
        self.pid = self.pgid = self.process.pid
        return self.connection_info


def run(options: list[str], folder: str) -> None:
    """Be a kernel in a folder, until Jupyter shuts it down, or Sphinx ends."""
    from ipykernel.kernelapp import IPKernelApp

    os.setsid()  # Ctrl-C is for Sphinx
    os.chdir(folder)
    Thread(target=_end_with_sphinx, daemon=True).start()
    # any process as parent: without one, each kernel prints how to connect to it
    IPKernelApp.launch_instance([*options, f"--IPKernelApp.parent_handle={os.getppid()}"])


def _end_with_sphinx() -> None:
    sphinx = parent_process()
    assert sphinx is not None
    sphinx.join()
    os._exit(1)


def setup(app: Sphinx) -> dict[str, bool]:
    """Make forks the default; only Linux forks safely after these imports."""
    if sys.platform == "linux":
        os.environ.setdefault("MPLBACKEND", "module://matplotlib_inline.backend_inline")  # a kernel sets it too late
        factory = KernelProvisionerFactory.instance()
        factory.provisioners["fork"] = EntryPoint("fork", f"{__name__}:{ForkProvisioner.__name__}", factory.GROUP_NAME)
        factory.default_provisioner_name = "fork"
    return {"parallel_read_safe": False, "parallel_write_safe": True}
