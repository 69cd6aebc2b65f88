"""The arrays of a glTF file: accessors over views of buffers, whole or sparse."""

import numpy as np

from ...errors import FileError
from ...input import Budget
from .container import Buffers
from .schema import Gltf

DTYPES = {5120: "<i1", 5121: "<u1", 5122: "<i2", 5123: "<u2", 5125: "<u4", 5126: "<f4"}
SHAPES = {"SCALAR": (1, 1), "VEC2": (1, 2), "VEC3": (1, 3), "VEC4": (1, 4), "MAT2": (2, 2), "MAT3": (3, 3),
          "MAT4": (4, 4)}  # columns, rows: glTF stores matrices column by column  # fmt: skip


class Accessors:
    """A file's accessors as arrays, each read when first asked for."""

    def __init__(self, gltf: Gltf, buffers: Buffers, budget: Budget) -> None:
        self._gltf, self._buffers, self._budget = gltf, buffers, budget
        self._read: dict[int, np.ndarray] = {}

    def floats(self, index: int, *types: str, fractions: bool = False) -> np.ndarray:
        """`accessors[index]` as float32: (n,), (n, components), or (n, rows, columns).

        Normalized integers become fractions: unsigned ones in [0, 1], signed ones in [-1, 1]; with `fractions`, all
        integers do. Raises `FileError` for an accessor of another type than `types`, if any are given, and as `stored`
        does.
        """
        accessor, values = self._gltf.accessors[index], self.stored(index)
        if types and accessor.type not in types:
            raise FileError(f"accessors[{index}].type: {accessor.type} is not {' or '.join(types)} here")
        if values.dtype.kind == "f":
            return values
        if accessor.normalized or fractions:
            return np.maximum(values.astype(np.float32) / np.float32(np.iinfo(values.dtype).max), -1)
        return values.astype(np.float32)

    def stored(self, index: int) -> np.ndarray:
        """`accessors[index]` as stored. Raises `FileError` for one that reaches beyond its bufferView, or whose zeros
        are over the budget."""  # fmt: skip
        if index not in self._read:
            accessor = self._gltf.accessors[index]
            dtype, (columns, rows) = np.dtype(DTYPES[accessor.component_type]), SHAPES[accessor.type]
            where = f"accessors[{index}]"
            if accessor.buffer_view is None:
                self._budget.take(accessor.count * columns * rows * dtype.itemsize, where)
                values = np.zeros((accessor.count, columns, rows), dtype)
            else:
                values = self._elements(
                    where, accessor.buffer_view, accessor.byte_offset, dtype, accessor.count, columns, rows
                )
            if accessor.sparse is not None:
                values = self._with_sparse(where, index, values.copy())
            values = values[:, 0] if columns == 1 else values.swapaxes(1, 2)
            self._read[index] = values[:, 0] if columns == rows == 1 else values
        return self._read[index]

    def view(self, index: int) -> bytes:
        """The bytes of a bufferView. Raises `FileError` where they reach beyond the buffer."""
        return bytes(self._buffers.view(index))

    def _with_sparse(self, where: str, index: int, values: np.ndarray) -> np.ndarray:
        sparse = self._gltf.accessors[index].sparse
        assert sparse is not None
        place = self._elements(
            f"{where}.sparse.indices",
            sparse.indices.buffer_view,
            sparse.indices.byte_offset,
            np.dtype(DTYPES[sparse.indices.component_type]),
            sparse.count,
            1,
            1,
        ).reshape(-1)
        if len(place) and place.max() >= len(values):
            raise FileError(f"{where}.sparse.indices: index {place.max()} of {len(values)} elements")
        values[place] = self._elements(
            f"{where}.sparse.values",
            sparse.values.buffer_view,
            sparse.values.byte_offset,
            values.dtype,
            sparse.count,
            *values.shape[1:],
        )
        return values

    def _elements(
        self, where: str, view: int, offset: int, dtype: np.dtype, count: int, columns: int, rows: int
    ) -> np.ndarray:
        """(count, columns, rows): elements of a bufferView; a matrix's columns begin at multiples of four bytes."""
        data = self._buffers.view(view)
        column = rows * dtype.itemsize if columns == 1 else -(-rows * dtype.itemsize // 4) * 4
        size = (columns - 1) * column + rows * dtype.itemsize
        stride = self._gltf.buffer_views[view].byte_stride or columns * column
        if stride < size:
            raise FileError(f"{where}: its elements have {size} bytes, and bufferViews[{view}].byteStride is {stride}")
        end = offset + (count - 1) * stride + size if count else 0
        if end > len(data):
            raise FileError(
                f"{where}: its {count} elements end at byte {end} of bufferViews[{view}], which has {len(data)}"
            )
        if not count:
            return np.zeros((0, columns, rows), dtype)
        strides = (stride, column, dtype.itemsize)
        return np.ndarray((count, columns, rows), dtype, data, offset, strides)
