"""What can go wrong with a map, as types the bus and REST translate."""


class MapError(RuntimeError):
    """Base; the text names the thing, what was expected and what came, `code` its kind for programs."""

    code = ""


class MissingError(MapError):
    """A map, node, edge, picture or revision that does not exist."""

    code = "missing"


class ConflictError(MapError):
    """The thing exists already, or the map is not at the revision the writer read."""

    code = "conflict"


class InvalidError(MapError):
    """A request that can never succeed as it stands."""

    code = "invalid"


class CorruptError(MapError):
    """Stored bytes whose checksum does not match."""

    code = "corrupt"


class GivenUpError(CorruptError):
    """Something that was damaged and that a repair gave up."""


class StorageFullError(MapError):
    """No room left on the device; reads go on."""

    code = "storage-full"


class UnavailableError(MapError):
    """The database does not answer; the same request may succeed later."""

    code = "unavailable"
