"""Hypothesis strategies for every message, derived from the models' own annotations and limits."""

import types
import unicodedata
from collections.abc import Callable
from functools import cache
from typing import Annotated, Any, Literal, Union, get_args, get_origin

import annotated_types as limits
import numpy as np
import numpy.typing as npt
from hypothesis import strategies as st
from pydantic import BaseModel
from pydantic.fields import FieldInfo

from shared.messages.arrays import ArraySpec
from shared.messages.body import Imu
from shared.messages.features import Features, Photo
from shared.messages.inspections import Inspection, InspectionRequest
from shared.messages.maps import Edge
from shared.messages.matching import NodeMatch
from shared.messages.places import (
    DeletePlace,
    DeleteRoute,
    DeleteRule,
    DeleteSign,
    KeepOut,
    OneWay,
    OpeningHours,
    Place,
    Route,
    Sign,
    Slow,
)
from shared.messages.sensors import Frame

Fields = dict[str, Any]

LONG = 3
"""Length of open lists and axes; limits themselves are tested by hand."""
WIDEST = 2**63 - 1


@cache
def messages(kind: type[BaseModel]) -> st.SearchStrategy[Any]:
    """Valid messages of one kind."""
    fields = {
        name: _value(field.annotation, tuple(field.metadata)) for name, field in kind.model_fields.items()
    }
    fit = FITS.get(kind, _as_drawn)
    return st.tuples(st.fixed_dictionaries(fields), st.integers(0, LONG), st.integers(0, 2**32 - 1)).map(
        lambda drawn: kind(**fit(*drawn))
    )


def _value(annotation: Any, metadata: tuple[Any, ...]) -> st.SearchStrategy[Any]:
    if any(isinstance(entry, ArraySpec) for entry in metadata):
        return st.none()  # filled in by FITS, because arrays of one message must fit together
    origin = get_origin(annotation)
    if origin is Annotated:
        inner, *more = get_args(annotation)
        told = [m for entry in more for m in (entry.metadata if isinstance(entry, FieldInfo) else [entry])]
        return _value(inner, (*told, *metadata))
    if origin in (Union, types.UnionType):
        return st.one_of([_value(choice, metadata) for choice in get_args(annotation)])
    if origin is Literal:
        return st.sampled_from(get_args(annotation))
    if origin is tuple and get_args(annotation)[-1] is not Ellipsis:
        return st.tuples(*(_value(each, ()) for each in get_args(annotation)))
    if origin is tuple:
        least = _limit(metadata, limits.MinLen, "min_length", 0)
        return st.lists(_value(get_args(annotation)[0], ()), min_size=least, max_size=max(LONG, least)).map(
            tuple
        )
    if origin is dict:
        plain = st.one_of(st.none(), st.booleans(), st.integers(-WIDEST, WIDEST), st.text(max_size=20))
        values = st.one_of(
            plain, st.floats(allow_nan=False, allow_infinity=False), st.lists(plain, max_size=2)
        )
        return st.dictionaries(st.text(max_size=20), values, max_size=LONG)
    if isinstance(annotation, type) and issubclass(annotation, BaseModel):
        return messages(annotation)
    return _scalar(annotation, metadata)


def _scalar(kind: Any, metadata: tuple[Any, ...]) -> st.SearchStrategy[Any]:
    if kind is bool:
        return st.booleans()
    if kind is int:
        least = _limit(metadata, limits.Ge, "ge", -WIDEST)
        most = min(
            _limit(metadata, limits.Le, "le", WIDEST), _limit(metadata, limits.Lt, "lt", WIDEST + 1) - 1
        )
        return st.integers(least, most)
    if kind is float:
        low, high = _limit(metadata, limits.Ge, "ge", None), _limit(metadata, limits.Le, "le", None)
        above = _limit(metadata, limits.Gt, "gt", None)
        low = above if low is None else low
        return st.floats(low, high, exclude_min=above is not None, allow_nan=False, allow_infinity=False)
    if kind is str:
        pattern = next((p for entry in metadata if (p := getattr(entry, "pattern", None))), None)
        if pattern:
            return st.from_regex(pattern, fullmatch=True)
        least = _limit(metadata, limits.MinLen, "min_length", 0)
        return st.text(min_size=least, max_size=min(20, _limit(metadata, limits.MaxLen, "max_length", 20)))
    if kind is bytes:
        return st.binary(max_size=50)
    assert kind is type(None), f"no strategy for {kind}"
    return st.none()


def _limit(metadata: tuple[Any, ...], kind: type, name: str, otherwise: Any) -> Any:
    return next((getattr(entry, name) for entry in metadata if isinstance(entry, kind)), otherwise)


def _array(spec: ArraySpec, count: int, seed: int) -> npt.NDArray[Any]:
    """Random bits of a random allowed dtype, with the odd value that is not finite replaced."""
    rng = np.random.default_rng(seed)
    dtype = np.dtype(spec.dtypes[seed % len(spec.dtypes)])
    shape = tuple(count if axis is None else axis for axis in spec.shape)
    array = np.frombuffer(rng.bytes(int(np.prod(shape)) * dtype.itemsize), dtype).reshape(shape)
    return np.nan_to_num(array) if dtype.kind == "f" else array


def _spec(kind: type[BaseModel], name: str) -> ArraySpec:
    field = kind.model_fields[name]
    pool = [*field.metadata, *(entry for choice in get_args(field.annotation) for entry in get_args(choice))]
    return next(entry for entry in pool if isinstance(entry, ArraySpec))


def _as_drawn(fields: Fields, _count: int, _seed: int) -> Fields:
    return fields


def _fit_features(fields: Fields, count: int, seed: int) -> Fields:
    names = ("lonlat_rad", "scores", "descriptors")
    return fields | {name: _array(_spec(Features, name), count, seed) for name in names}


def _fit_match(fields: Fields, count: int, seed: int) -> Fields:
    names = ("matches_rad", "inlier_mask", "right", "log_scale")
    if seed % 4 == 0:
        return fields | dict.fromkeys(names)
    return fields | {name: _array(_spec(NodeMatch, name), count, seed) for name in names}


def _fit_frame(fields: Fields, count: int, seed: int) -> Fields:
    height = count + 1
    size = 6 * height * height if fields["encoding"] == "bgr8" else count
    data = np.random.default_rng(seed).bytes(size)
    return _fit_gravity(fields, count, seed) | {"height_px": height, "width_px": 2 * height, "data": data}


def _fit_photo(fields: Fields, count: int, seed: int) -> Fields:
    data = np.random.default_rng(seed).bytes(3 * 64 * (64 + count))
    return fields | {"width_px": 64, "height_px": 64 + count, "data": data}


def _fit_gravity(fields: Fields, _count: int, seed: int) -> Fields:
    if fields["gravity"] is None:
        return fields
    down = np.random.default_rng(seed).standard_normal(3)
    return fields | {"gravity": tuple((down / np.linalg.norm(down)).tolist())}


def _fit_edge(fields: Fields, _count: int, _seed: int) -> Fields:
    ends = fields["a"], fields["b"]
    return fields | {"a": min(ends) // 2, "b": max(ends) // 2 + 1}


def _fit_mark(fields: Fields, _count: int, _seed: int) -> Fields:
    """Names that can be seen, and edges that join two nodes."""
    fitted = {
        "name": _seen(fields.get("name", "")),
        "place": _seen(fields.get("place", "")),
        "areas": tuple(_seen(area) for area in fields.get("areas", ())),
        "edges": tuple((a // 2, b // 2 + WIDEST // 2 + 1) for a, b in fields.get("edges", ())),
    }
    return fields | {name: value for name, value in fitted.items() if name in fields}


def _seen(text: str) -> str:
    kept = "".join(c for c in text if not unicodedata.category(c).startswith("C"))
    return " ".join(unicodedata.normalize("NFC", kept).split())[:60] or "a"


FITS: dict[type[BaseModel], Callable[[Fields, int, int], Fields]] = {
    Features: _fit_features,
    NodeMatch: _fit_match,
    Imu: _fit_gravity,
    Frame: _fit_frame,
    Photo: _fit_photo,
    Edge: _fit_edge,
    **dict.fromkeys(
        (
            Place,
            KeepOut,
            OneWay,
            Slow,
            OpeningHours,
            Route,
            Sign,
            DeletePlace,
            DeleteRule,
            DeleteRoute,
            DeleteSign,
        ),
        _fit_mark,
    ),
    **dict.fromkeys((Inspection, InspectionRequest), _fit_mark),
}
"""What fields of one message owe each other, beyond what each of them must be by itself."""
