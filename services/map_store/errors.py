"""What can go wrong with a map, as types the bus and REST translate."""


class MapError(RuntimeError):
    """Base; the text names the thing, what was expected and what came."""


class MissingError(MapError):
    """A map, node, edge, picture or revision that does not exist."""


class ConflictError(MapError):
    """The thing exists already, or the map is not at the revision the writer read."""


class InvalidError(MapError):
    """A request that can never succeed as it stands."""


class CorruptError(MapError):
    """Stored bytes whose checksum does not match."""


class GivenUpError(CorruptError):
    """Something that was damaged and that a repair gave up."""


class StorageFullError(MapError):
    """No room left on the device; reads go on."""


class UnavailableError(MapError):
    """The database does not answer; the same request may succeed later."""
