"""What ends a command early, as one line that says what to do."""

from collections.abc import Iterator
from contextlib import contextmanager

import httpx
from pydantic import ValidationError

from shared.queries import QueryError
from shared.wire import WireError


class ExperimentError(ValueError):
    """A run that cannot begin or go on; the text is meant for the person at the shell."""


@contextmanager
def one_line_errors() -> Iterator[None]:
    """Turn what services and HTTP report, and what a message refuses, into an ExperimentError."""
    try:
        yield
    except (QueryError, WireError) as error:
        raise ExperimentError(f"a service did not answer as expected: {error}") from error
    except ValidationError as error:
        faults = (f"{'.'.join(map(str, fault['loc']))}: {fault['msg']}" for fault in error.errors())
        raise ExperimentError("; ".join(faults)) from None
    except httpx.HTTPStatusError as error:
        text = error.response.text[:300]
        raise ExperimentError(f"{error.request.url} answered {error.response.status_code}: {text}") from error
    except httpx.HTTPError as error:
        raise ExperimentError(f"{type(error).__name__} from the gateway: {error}") from error
