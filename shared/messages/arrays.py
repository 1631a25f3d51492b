"""Numpy arrays inside messages: `{dtype, shape, data}` on the wire, checked before numpy sees a byte."""

import math
from dataclasses import dataclass
from typing import Any

import numpy as np
import numpy.typing as npt
from pydantic import GetCoreSchemaHandler, GetJsonSchemaHandler
from pydantic_core import core_schema

Array = npt.NDArray[Any]


@dataclass(frozen=True)
class ArraySpec:
    """Allowed dtypes and shape of an array field, used as `Annotated[Array, ArraySpec(...)]`.

    Attributes:
        dtypes: names numpy knows, for example ("float32",).
        shape: one entry per axis; None means any length up to `max_length`.
        max_length: largest length of an open axis.
    """

    dtypes: tuple[str, ...]
    shape: tuple[int | None, ...]
    max_length: int = 20_000

    def check(self, value: object) -> Array:
        """Return `value` as an array, or raise ValueError naming what was expected and what came."""
        array = value if isinstance(value, np.ndarray) else self._from_wire(value)
        self._check_layout(array.dtype.name, array.shape)
        if array.dtype.kind == "f" and not np.isfinite(array).all():
            raise ValueError("array holds NaN or infinity, expected finite numbers")
        return array

    def _from_wire(self, value: object) -> Array:
        if not isinstance(value, dict) or not {"dtype", "shape", "data"} <= value.keys():
            raise ValueError(f"array must be a map of dtype, shape and data, got {type(value).__name__}")
        dtype, shape, data = value["dtype"], value["shape"], value["data"]
        if not isinstance(dtype, str) or not isinstance(data, bytes) or not isinstance(shape, list | tuple):
            raise ValueError("array needs a text dtype, a list shape and binary data")
        if not all(type(length) is int and length >= 0 for length in shape):
            raise ValueError(f"array shape must hold non-negative integers, got {list(shape)[:8]}")
        self._check_layout(dtype, tuple(shape))
        expected = math.prod(shape) * np.dtype(dtype).itemsize
        if len(data) != expected:
            raise ValueError(f"array of shape {tuple(shape)} needs {expected} bytes, got {len(data)}")
        return np.frombuffer(data, dtype=dtype).reshape(shape)

    def _check_layout(self, dtype: str, shape: tuple[int, ...]) -> None:
        if dtype not in self.dtypes:
            raise ValueError(f"array dtype must be one of {list(self.dtypes)}, got {dtype!r}")
        fits = len(shape) == len(self.shape) and all(
            length <= self.max_length if wanted is None else length == wanted
            for length, wanted in zip(shape, self.shape, strict=True)
        )
        if not fits:
            raise ValueError(
                f"array shape must be {self.shape} (open axes <= {self.max_length}), got {shape}"
            )

    def __get_pydantic_core_schema__(
        self, _source: Any, _handler: GetCoreSchemaHandler
    ) -> core_schema.CoreSchema:
        return core_schema.no_info_plain_validator_function(
            self.check, serialization=core_schema.plain_serializer_function_ser_schema(_to_wire)
        )

    def __get_pydantic_json_schema__(
        self, _schema: core_schema.CoreSchema, _handler: GetJsonSchemaHandler
    ) -> dict[str, Any]:
        axes: list[dict[str, Any]] = [
            {"type": "integer", "minimum": 0, "maximum": self.max_length} if n is None else {"const": n}
            for n in self.shape
        ]
        return {
            "type": "object",
            "description": "little-endian, C order; data is msgpack bin",
            "properties": {
                "dtype": {"enum": list(self.dtypes)},
                "shape": {"type": "array", "prefixItems": axes, "minItems": len(axes), "maxItems": len(axes)},
                "data": {"type": "string", "format": "binary"},
            },
            "required": ["dtype", "shape", "data"],
        }


def _to_wire(array: Array) -> dict[str, Any]:
    return {"dtype": array.dtype.name, "shape": list(array.shape), "data": array.tobytes()}
