"""Messages, one file per link. The bus contract; JSON Schemas are generated into deploy/contracts."""

import pkgutil
from importlib import import_module

from shared.messages.base import Message


def all_messages() -> tuple[type[Message], ...]:
    """Every kind of message that the modules of this folder define, by schema."""
    for module in pkgutil.iter_modules(__path__, f"{__name__}."):
        import_module(module.name)
    return tuple(sorted(Message.__subclasses__(), key=lambda kind: kind.SCHEMA))
