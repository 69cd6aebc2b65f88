"""Views of buffers that meshoptimizer compressed (EXT_ and KHR_meshopt_compression), by the extra `meshopt`."""

from ...errors import FileError
from ...extras import EXTRAS, install_command
from ...input import Budget
from .schema import Meshopt


def decompressed(data: memoryview, meshopt: Meshopt, where: str, budget: Budget) -> memoryview:
    """The bytes of the bufferView `where`, from its compressed `data`.

    Raises `FileError` for data that cannot be decoded, for a missing decoder, and above the budget.
    """
    try:
        import meshopt as library
    except ImportError:
        package = EXTRAS["meshopt"].package
        raise FileError(
            f"{where} is compressed with meshopt, and the decoder is missing: {install_command(package)}"
        ) from None
    budget.take(meshopt.count * meshopt.byte_stride, where)
    filtered = None if meshopt.filter == "NONE" else meshopt.filter
    try:
        rows = library.decode_gltf_buffer(bytes(data), meshopt.count, meshopt.byte_stride, meshopt.mode, filtered)
    except ValueError as error:
        raise FileError(f"{where} is no readable meshopt data") from error
    return memoryview(rows.tobytes())
