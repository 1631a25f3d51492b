"""What all recipes share: frozen settings that a file may replace, value by value."""

import json
from pathlib import Path
from typing import TypeVar

from pydantic import BaseModel, ConfigDict, ValidationError

from services.launcher.client.failure import ExperimentError


class Recipe(BaseModel):
    """Frozen; a wrong name or value is an error."""

    model_config = ConfigDict(frozen=True, extra="forbid", allow_inf_nan=False)


AnyRecipe = TypeVar("AnyRecipe", bound=Recipe)


def recipe_from(kind: type[AnyRecipe], file: Path | None, **chosen: object) -> AnyRecipe:
    """The recipe with what a JSON file and the command line replace; None keeps what the file says.

    Raises:
        ExperimentError: no such file, value or name; the text says which.
    """
    try:
        values = json.loads(file.read_text(encoding="utf-8")) if file is not None else {}
        return kind.model_validate({**values, **{k: v for k, v in chosen.items() if v is not None}})
    except ValidationError as error:
        faults = "; ".join(f"{'.'.join(map(str, e['loc']))}: {e['msg']}" for e in error.errors())
        raise ExperimentError(f"recipe {file or kind.__name__}: {faults}") from error
    except (OSError, ValueError, TypeError) as error:
        raise ExperimentError(f"recipe {file} is no JSON object that can be read: {error}") from error
